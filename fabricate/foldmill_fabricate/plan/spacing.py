"""How near grooves come to each other, on one face and across the sheet.

Across the sheet (the vertex rule): grooves of both faces that share a vertex must end in a relief
hole there, or stop short of it by at least half the thickness; their ends are at least one web
apart. At the outline and beside an
inner cut scores run out into the cut, and may meet there. Anywhere else they must not cross, nor
run closer than the thickness; closer than twice the thickness is a warning.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
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


Verdict = tuple[str, Severity, str]
"""Code, severity and the least distance wanted."""


@dataclass(frozen=True)
class _Pair:
    """Two grooves that come too near, and the vertices they share."""

    verdict: Verdict
    i: int
    j: int
    gap: float
    vertices: set[int]


@dataclass(frozen=True, eq=False)
class _Grooves:
    edges: Indices
    faces: list[Face]
    lines: Floats
    """(n, 2, 2) mm on the sheet, setbacks taken off."""


def findings(
    pattern: CreasePattern,
    spots: Floats,
    by_face: Mapping[Face, Indices],
    stops: Mapping[int, float],
    material: Material,
    relieved: Collection[int] = (),
) -> Iterator[Finding]:
    """Yield a finding for every pair of grooves that come too near.

    spots : (V, 2) mm; stops : vertices that grooves stop short of, and by how many mm;
    relieved : those with a hole in which grooves end.
    """
    grooves = _grooves(pattern, spots, by_face, stops)
    for pair in _judged(pattern, grooves, material, relieved):
        yield _finding(pair.verdict, grooves, pair.i, pair.j, pair.gap, pair.vertices)


def tight_vertices(
    pattern: CreasePattern,
    spots: Floats,
    by_face: Mapping[Face, Indices],
    stops: Mapping[int, float],
    material: Material,
) -> set[int]:
    """Return the vertices at which the vertex rule is broken; arguments as for ``findings``."""
    grooves = _grooves(pattern, spots, by_face, stops)
    return {
        vertex
        for pair in _judged(pattern, grooves, material, ())
        if pair.verdict[0] == "vertex-rule"
        for vertex in pair.vertices
    }


def _judged(
    pattern: CreasePattern, grooves: _Grooves, material: Material, relieved: Collection[int]
) -> Iterator[_Pair]:
    import shapely

    if not len(grooves.edges):
        return
    lines = shapely.linestrings(grooves.lines)
    reach = max(2 * material.thickness, material.score.min_spacing)
    first, second = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=reach)
    i, j = first[first < second], second[first < second]
    gaps = shapely.distance(lines[i], lines[j])
    one, two = pattern.edges[grooves.edges[i]], pattern.edges[grooves.edges[j]]
    shared = (one[:, :, None] == two[:, None, :]).any(axis=2)
    on_face = np.array([face is Face.FRONT for face in grooves.faces])
    across = on_face[i] != on_face[j]
    touching, holed = shared.any(axis=1), (shared & _of(relieved, pattern)[one]).any(axis=1)
    whole = ~(shared & ~_of(surrounded(pattern), pattern)[one]).any(axis=1)
    for k in np.flatnonzero(whole).tolist():
        judged = _judge(
            bool(across[k]), bool(touching[k]), float(gaps[k]), material, bool(holed[k])
        )
        if judged is not None:
            vertices = set(one[k][shared[k]].tolist())
            yield _Pair(judged, int(i[k]), int(j[k]), float(gaps[k]), vertices)


def _of(vertices: Collection[int] | Indices, pattern: CreasePattern) -> NDArray[np.bool_]:
    """Return which vertices (V,) are among some."""
    found = np.zeros(len(pattern.vertices), bool)
    found[list(vertices)] = True
    return found


def _grooves(
    pattern: CreasePattern,
    spots: Floats,
    by_face: Mapping[Face, Indices],
    stops: Mapping[int, float],
) -> _Grooves:
    edges = np.concatenate(list(by_face.values()))
    faces = [face for face, own in by_face.items() for _ in own]
    lines = spots[pattern.edges[edges]].copy()
    step = lines[:, 1] - lines[:, 0]
    unit = step / np.hypot(*step.T)[:, None] if len(step) else step
    taken = np.zeros(len(pattern.vertices))
    taken[list(stops)] = list(stops.values())
    held = taken[pattern.edges[edges]]
    lines[:, 0] += held[:, :1] * unit
    lines[:, 1] -= held[:, 1:] * unit
    return _Grooves(edges, faces, lines)


def _judge(
    across: bool, shared: bool, gap: float, material: Material, relieved: bool
) -> Verdict | None:
    """Return code, severity and the least distance wanted, or None where all is well."""
    score, thickness = material.score, material.thickness
    if not across:
        wanted = score.web_min if shared else score.min_spacing
        if shared and gap == 0.0:
            return None  # one groove that runs through the vertex
        near = ("scores-too-near", Severity.WARNING, f"{wanted:g} mm")
        return near if gap < wanted else None
    if shared:
        if (score.setback < thickness / 2 and not relieved) or gap < score.web_min:
            return "vertex-rule", Severity.ERROR, f"{score.web_min:g} mm between groove ends"
        return None
    if gap == 0.0:
        return "scores-cross", Severity.ERROR, f"{2 * thickness:g} mm"
    severity = Severity.ERROR if gap < thickness else Severity.WARNING
    return ("faces-too-near", severity, f"{2 * thickness:g} mm") if gap < 2 * thickness else None


def _finding(
    verdict: Verdict, grooves: _Grooves, i: int, j: int, gap: float, shared: set[int]
) -> Finding:
    code, severity, wanted = verdict
    at_vertex = "Plan with --relief needed: a hole takes the vertex away. Or move"
    first = at_vertex if code == "vertex-rule" and shared else "Move"
    x, y = _nearest(grooves.lines[i], grooves.lines[j])
    a, b = grooves.edges[[i, j]]
    return Finding(
        code,
        severity,
        f"creases {a} ({grooves.faces[i]}) and {b} ({grooves.faces[j]}) at ({x:.1f}, {y:.1f}) mm",
        f"Their grooves come within {gap:.3f} mm of each other; {wanted} are wanted.",
        f"{first} the vertices apart, enlarge the design, or take a thinner material.",
        (round(x, 6), round(y, 6)),
    )


def _nearest(one: Floats, two: Floats) -> tuple[float, float]:
    """Return the point half way between two lines where they are nearest, mm."""
    import shapely

    between = shapely.shortest_line(shapely.LineString(one), shapely.LineString(two))
    x, y = np.array(between.coords).mean(axis=0)
    return float(x), float(y)
