"""How the part is cut free: inner cuts, then the outline with ties that hold it in the sheet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill.finding import Finding
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.materials import Cut, ScoreAndSnap, ThroughCut
from foldmill_fabricate.passes import Stroke, Tie
from foldmill_fabricate.plan import ties
from foldmill_fabricate.toolpath import order, trails

Floats = NDArray[np.float64]

STRAIGHT_DEG = 0.001
"""deg. An outline that bends by less is one straight edge."""
CREASES = (Assignment.M, Assignment.V, Assignment.U)
"""What may be scored: no tie goes where one ends, if it can be helped."""


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
    return order.sorted_strokes(strokes, repeats, start, nested=True)


def outer_cut(
    pattern: CreasePattern, spots: Floats, cut: Cut
) -> tuple[tuple[Stroke, ...], tuple[Tie, ...], tuple[Finding, ...]]:
    """Return the outline as strokes between ties, the ties, and what is unusual about them.

    spots : (V, 2) on the sheet. Ties lie on straight edges, away from corners and from the mouths
    of inner cuts, about ``tie_pitch`` apart, three at least; ``ties`` says where else they may.
    What does not go through needs none: the outline is one closed stroke. Raises CannotPlan where
    the outline can carry no three ties.
    """
    rim = _rim(pattern, spots)
    if not isinstance(cut, ThroughCut):
        return (_stroke([*rim.points, rim.points[0]]),), (), ()
    places = ties.places(rim, cut)
    strokes = []
    whole = float(rim.reached[-1])
    for here, after in zip(places, [*places[1:], places[0] + whole], strict=True):
        strokes.append(_between(rim, here + cut.tie_width / 2, after - cut.tie_width / 2))
    spans = [Tie(x=float(x), y=float(y), width=cut.tie_width) for x, y in map(rim.at, places)]
    return tuple(strokes), tuple(spans), tuple(ties.findings(rim, places, cut))


def _rim(pattern: CreasePattern, spots: Floats) -> ties.Rim:
    """Drop the vertices at which the outline goes straight on: a tie may lie across them.

    Those where an inner cut ends are corners.
    """
    loops = pattern.outline()
    if not loops:
        raise CannotPlan("The pattern has no closed outline, so nothing can be cut free.")
    loop, edges = spots[loops[0]], pattern.edges
    one, two = loop - np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0) - loop
    bend = np.degrees(np.arctan2(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], (one * two).sum(1)))
    mouths = np.isin(loops[0], edges[pattern.assignments == Assignment.C])
    ends = np.isin(loops[0], edges[np.isin(pattern.assignments, CREASES)])
    kept = (np.abs(bend) > STRAIGHT_DEG) | mouths
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*two.T))])
    along = (reached[:-1] - reached[:-1][kept][:1]) % reached[-1]
    bends = np.where(mouths, 180.0, np.abs(bend))
    return ties.Rim(loop[kept], bends[kept], along[ends])


def _between(rim: ties.Rim, low: float, high: float) -> Stroke:
    reached = np.concatenate([rim.reached[:-1], rim.reached[:-1] + rim.reached[-1]])
    corners = np.flatnonzero((low < reached) & (reached < high)) % len(rim.points)
    return _stroke([rim.at(low), *rim.points[corners], rim.at(high)])


def _stroke(path: list[Floats]) -> Stroke:
    return Stroke(points=tuple((float(x), float(y)) for x, y in path))
