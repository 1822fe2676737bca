"""How near grooves come to each other, on one face and across the sheet.

Across the sheet (the vertex rule): grooves of both faces that share a vertex must stop short of it
by at least half the thickness, with their ends at least one web apart. At the outline and beside an
inner cut scores run out into the cut, and may meet there. Anywhere else they must not cross, nor
run closer than the thickness; closer than twice the thickness is a warning.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plan.scores import surrounded

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class _Grooves:
    edges: Indices
    faces: list[Face]
    lines: Floats
    """(n, 2, 2) mm on the sheet, setbacks taken off."""


def findings(
    pattern: CreasePattern,
    spots: Floats,
    by_face: dict[Face, Indices],
    stops: set[int],
    material: Material,
) -> Iterator[Finding]:
    """Yield a finding for every pair of grooves that come too near; spots : (V, 2) mm."""
    import shapely

    grooves = _grooves(pattern, spots, by_face, stops, material.score.setback)
    if not len(grooves.edges):
        return
    lines = shapely.linestrings(grooves.lines)
    rim = set(np.setdiff1d(pattern.edges, surrounded(pattern)).tolist())
    reach = max(2 * material.thickness, material.score.min_spacing)
    first, second = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=reach)
    for i, j in zip(first[first < second], second[first < second], strict=True):
        gap = float(shapely.distance(lines[i], lines[j]))
        shared = set(pattern.edges[grooves.edges[i]]) & set(pattern.edges[grooves.edges[j]])
        across = grooves.faces[i] is not grooves.faces[j]
        if shared & rim:
            continue
        judged = _judge(across, bool(shared), gap, material)
        if judged is not None:
            yield _finding(judged, grooves, int(i), int(j), gap)


def _grooves(
    pattern: CreasePattern,
    spots: Floats,
    by_face: dict[Face, Indices],
    stops: set[int],
    setback: float,
) -> _Grooves:
    edges = np.concatenate(list(by_face.values()))
    faces = [face for face, own in by_face.items() for _ in own]
    lines = spots[pattern.edges[edges]].copy()
    step = lines[:, 1] - lines[:, 0]
    unit = step / np.hypot(*step.T)[:, None] if len(step) else step
    held = np.isin(pattern.edges[edges], list(stops))
    lines[:, 0] += setback * held[:, :1] * unit
    lines[:, 1] -= setback * held[:, 1:] * unit
    return _Grooves(edges, faces, lines)


def _judge(
    across: bool, shared: bool, gap: float, material: Material
) -> tuple[str, Severity, str] | None:
    """Return code, severity and the least distance wanted, or None where all is well."""
    score, thickness = material.score, material.thickness
    if not across:
        wanted = score.web_min if shared else score.min_spacing
        if shared and gap == 0.0:
            return None  # one groove that runs through the vertex
        near = ("scores-too-near", Severity.WARNING, f"{wanted:g} mm")
        return near if gap < wanted else None
    if shared:
        if score.setback < thickness / 2 or gap < score.web_min:
            return "vertex-rule", Severity.ERROR, f"{score.web_min:g} mm between groove ends"
        return None
    if gap == 0.0:
        return "scores-cross", Severity.ERROR, f"{2 * thickness:g} mm"
    severity = Severity.ERROR if gap < thickness else Severity.WARNING
    return ("faces-too-near", severity, f"{2 * thickness:g} mm") if gap < 2 * thickness else None


def _finding(
    judged: tuple[str, Severity, str], grooves: _Grooves, i: int, j: int, gap: float
) -> Finding:
    code, severity, wanted = judged
    x, y = grooves.lines[[i, j]].mean(axis=(0, 1))
    a, b = grooves.edges[[i, j]]
    return Finding(
        code,
        severity,
        f"creases {a} ({grooves.faces[i]}) and {b} ({grooves.faces[j]}) at ({x:.1f}, {y:.1f}) mm",
        f"Their grooves come within {gap:.3f} mm of each other; {wanted} are wanted.",
        "Move the vertices apart, enlarge the design, or take a thinner material.",
    )
