"""Creases too short for their setbacks: how many, by how much, and the ways out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plan import processes

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
ByFace = Mapping[Face, Indices]

SHORT_CREASE = 2.0
"""mm of score that must remain between two setbacks: less does not guide a fold."""
LEAST = 0.01
"""mm. Less of a score is nothing, at any scale."""


@dataclass(frozen=True, eq=False)
class _Creases:
    """The scored creases, and what setbacks take of each."""

    edges: Indices
    lengths: Floats
    """(n,) mm"""
    stops: Floats
    """(n, 2) mm that scores stop short of either end"""

    @property
    def taken(self) -> Floats:
        """(n,) mm"""
        return np.asarray(self.stops.sum(axis=1))


def refuse_swallowed(
    pattern: CreasePattern,
    spots: Floats,
    by_face: ByFace,
    stops: Mapping[int, float],
    material: Material,
    machine: Machine,
) -> None:
    """Raise CannotPlan where setbacks would swallow creases whole: how many, and the ways out.

    spots : (V, 2) mm on the sheet; stops : mm that scores stop short, by vertex.
    """
    creases = _creases(pattern, by_face, stops)
    left = creases.lengths - creases.taken
    swallowed = np.flatnonzero(left < LEAST)
    if not len(swallowed):
        return
    worst = int(np.argmin(left))
    edge = creases.edges[worst]
    x, y = spots[pattern.edges[edge]].mean(axis=0)
    one, two = creases.stops[worst]
    raise CannotPlan(
        f"{len(swallowed)} of {len(left)} creases are too short for {material.slug}. The worst, "
        f"crease {edge} at ({x:.1f}, {y:.1f}) mm, is {creases.lengths[worst]:.2f} mm long, and "
        f"scores stop {one:g} and {two:g} mm short of the vertices at its ends: nothing is left to "
        f"score. {_ways_out(pattern, creases, material, machine)}"
    )


def findings(
    pattern: CreasePattern,
    spots: Floats,
    by_face: ByFace,
    stops: Mapping[int, float],
    material: Material,
) -> Iterator[Finding]:
    """Yield one finding for all creases of which so little is scored that it hardly guides a fold.

    Arguments as for ``refuse_swallowed``.
    """
    creases = _creases(pattern, by_face, stops)
    wanted = np.maximum(creases.taken + SHORT_CREASE, material.min_feature)
    few = np.flatnonzero(creases.lengths < wanted)
    if not len(few):
        return
    worst = int(np.argmin(creases.lengths - wanted))
    x, y = spots[pattern.edges[creases.edges[worst]]].mean(axis=0)
    length, scored = creases.lengths[worst], creases.lengths[worst] - creases.taken[worst]
    grown = float((wanted / creases.lengths).max())
    more = f" So are {len(few) - 1} more creases." if len(few) > 1 else ""
    yield Finding(
        "short-crease",
        Severity.WARNING,
        f"crease {creases.edges[worst]} at ({x:.1f}, {y:.1f}) mm",
        f"It is {length:.2f} mm long, of which {scored:.2f} mm are scored; {SHORT_CREASE:g} mm "
        f"guide a fold.{more}",
        f"Fold them by hand along a ruler, or make the part {_size(pattern, grown)} mm long rather "
        f"than {_size(pattern)} mm.",
        (float(x), float(y)),
    )


def _creases(pattern: CreasePattern, by_face: ByFace, stops: Mapping[int, float]) -> _Creases:
    edges = np.concatenate(list(by_face.values()))
    short = np.zeros(len(pattern.vertices))
    short[list(stops)] = list(stops.values())
    return _Creases(edges, pattern.edge_lengths[edges], short[pattern.edges[edges]])


def _ways_out(
    pattern: CreasePattern, creases: _Creases, material: Material, machine: Machine
) -> str:
    grown = float(((creases.taken + LEAST) / creases.lengths).max())
    ways = [
        f"make the part at least {_size(pattern, grown)} mm long rather than {_size(pattern)} mm",
        "split it over several sheets at that size (waterbomb: --pieces)",
    ]
    setback = float(creases.stops.max())
    other = [
        f"--score {score.kind} ({score.setback:g} mm)"
        for score in material.other_scores
        if score.setback < setback and not processes.lacking(score, machine)
    ]
    if other:
        ways.append(f"score by what needs less, {' or '.join(other)}")
    if creases.stops.max() > material.score.setback:
        ways.append("plan with --relief needed or none: its holes are wider than setbacks")
    ways.append("take a thinner material, or a preset of your own with a smaller setback")
    return f"{'; '.join(ways)[:1].upper()}{'; '.join(ways)[1:]}."


def _size(pattern: CreasePattern, grown: float = 1.0) -> int | float:
    """Return the longer side of the part, mm, after it has grown by a factor; rounded up."""
    longer = float(np.ptp(pattern.vertices, axis=0).max())
    return int(np.ceil(longer * grown)) if grown > 1.0 else round(longer, 1)
