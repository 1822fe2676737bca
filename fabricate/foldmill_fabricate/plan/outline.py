"""How the part is cut free: inner cuts, then the outline with ties that hold it in the sheet."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.materials import Cut, ScoreAndSnap, ThroughCut
from foldmill_fabricate.passes import Stroke, Tie
from foldmill_fabricate.toolpath import order, trails

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

STRAIGHT_DEG = 0.001
"""deg. An outline that bends by less is one straight edge."""
LEAST_TIES = 3
"""Fewer let the part swing about the last one."""


def refuse_snapped_slots(pattern: CreasePattern, cut: Cut) -> None:
    """Raise CannotPlan where inner cuts or holes would have to be snapped: only a rim snaps off."""
    count = pattern.count(Assignment.C) + len(pattern.outline()[1:])
    if isinstance(cut, ScoreAndSnap) and count:
        raise CannotPlan(
            f"The pattern has {count} inner cuts, and only an outline can be snapped off. Plan "
            f"with --outline through-cut on a machine that offers it."
        )


def inner_cuts(
    pattern: CreasePattern, spots: Floats, repeats: int, start: Floats
) -> tuple[Stroke, ...]:
    """Return inner cuts and inner loops of the outline, in order; spots : (V, 2) on the sheet."""
    loops = [np.append(loop, loop[0]).tolist() for loop in pattern.outline()[1:]]
    slits = pattern.edges[pattern.assignments == Assignment.C]
    found = loops + trails.straightest(spots, slits)
    strokes = [_stroke([spots[v] for v in trail]) for trail in found]
    return order.sorted_strokes(strokes, repeats, start)


def outer_cut(
    pattern: CreasePattern, spots: Floats, cut: Cut
) -> tuple[tuple[Stroke, ...], tuple[Tie, ...]]:
    """Return the outline as strokes between ties, and the ties; spots : (V, 2) on the sheet.

    Ties lie on straight edges, away from corners and from the mouths of inner cuts, about
    ``tie_pitch`` apart, three at least. What does not go through needs none: the outline is one
    closed stroke. Raises CannotPlan where no edge is long enough to carry a tie.
    """
    loops = pattern.outline()
    if not loops:
        raise CannotPlan("The pattern has no closed outline, so nothing can be cut free.")
    cuts = pattern.edges[pattern.assignments == Assignment.C]
    rim = _corners(spots[loops[0]], np.isin(loops[0], cuts))
    if not isinstance(cut, ThroughCut):
        return (_stroke([*rim, rim[0]]),), ()
    places = _tie_places(rim, cut)
    ties = [_at(rim, place) for place in places]
    strokes = []
    for here, after in zip(places, [*places[1:], places[0] + _reached(rim)[-1]], strict=True):
        strokes.append(_between(rim, here + cut.tie_width / 2, after - cut.tie_width / 2))
    return tuple(strokes), tuple(Tie(x=float(x), y=float(y), width=cut.tie_width) for x, y in ties)


def _corners(rim: Floats, mouths: Flags) -> Floats:
    """Drop the vertices at which the rim goes straight on: a tie may lie across them.

    mouths : (n,) the vertices of the rim (n, 2) where an inner cut ends; they are corners.
    """
    one, two = rim - np.roll(rim, 1, axis=0), np.roll(rim, -1, axis=0) - rim
    bend = np.degrees(np.arctan2(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], (one * two).sum(1)))
    kept: Floats = rim[(np.abs(bend) > STRAIGHT_DEG) | mouths]
    return kept


def _reached(rim: Floats) -> Floats:
    """Return the length (n+1,) of the rim up to each corner, back to the start."""
    steps = np.roll(rim, -1, axis=0) - rim
    return np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])


def _tie_places(rim: Floats, cut: ThroughCut) -> list[float]:
    """Return the middle of each tie as a length along the rim, ascending."""
    reached = _reached(rim)
    room = cut.tie_corner + cut.tie_width / 2
    runs = [(a + room, b - room) for a, b in pairwise(reached) if b - a > 2 * room]
    count = max(LEAST_TIES, round(float(reached[-1]) / cut.tie_pitch))
    if not runs:
        raise CannotPlan(
            f"No edge of the outline is long enough for a tie ({2 * room:g} mm). Enlarge the "
            f"part, or choose a material whose ties are smaller."
        )
    pitch = float(reached[-1]) / count
    wanted = [(k + 0.5) * pitch for k in range(count)]
    places: list[float] = []
    for want in wanted:
        near = min((min(max(want, low), high) for low, high in runs), key=lambda s: abs(s - want))
        if not places or near - places[-1] > 2 * cut.tie_corner:
            places.append(near)
    if len(places) > 1 and places[0] + float(reached[-1]) - places[-1] <= 2 * cut.tie_corner:
        places.pop()  # the last one has come round to the first
    if len(places) < LEAST_TIES:
        raise CannotPlan(
            f"The straight edges of the outline have room for too few ties: {len(places)}, and a "
            f"part needs {LEAST_TIES}. Enlarge the part, or leave small tabs out."
        )
    return places


def _at(rim: Floats, length: float) -> Floats:
    closed, reached = np.vstack([rim, rim[:1]]), _reached(rim)
    length %= reached[-1]
    return np.array([np.interp(length, reached, closed[:, k]) for k in (0, 1)])


def _between(rim: Floats, low: float, high: float) -> Stroke:
    reached = _reached(rim)
    whole = float(reached[-1])
    corners = [
        rim[k % len(rim)]
        for k in range(2 * len(rim))
        if low < reached[k % len(rim)] + whole * (k // len(rim)) < high
    ]
    return _stroke([_at(rim, low), *corners, _at(rim, high)])


def _stroke(path: list[Floats]) -> Stroke:
    return Stroke(points=tuple((float(x), float(y)) for x, y in path))
