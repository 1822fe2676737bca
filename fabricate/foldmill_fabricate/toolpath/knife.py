"""Where the holder of a drag knife goes, so that its tip goes where it should.

The tip trails the holder's axis at a fixed distance, the offset, and points along the way that it
has come. So along a straight line the holder runs an offset ahead; at a corner it swings about the
resting tip, on an arc of that radius, until the blade points along the next line. With the pen up
the blade keeps its direction. All this needs the direction at the start: a lead-in in the waste
gives it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.toolpath.snapping import Grid, Guide

Floats = NDArray[np.float64]

SAGITTA_MM = 0.002
"""mm. How far the chords of a swivel may leave its arc: a twelfth of a plotter step."""
SETTLED = 8.0
"""Offsets of straight travel after which a blade has settled: a right angle is 0.04 degrees then.
The encoder of a widespread drawing program uses as many."""
FACETTED = 3.0
"""Offsets. A circle of a smaller radius would be steered all the way round; it is cut in facets."""
FACET = 2.0
"""Offsets. Facets are no shorter, so that the blade settles on each."""
LEAST_FACETS = 6
SHARP_DEG = 30.0
"""deg. A blade that is to be turned by more is lifted out for it, where the material says so."""


def holder_ways(
    ways: Sequence[ArrayLike], offset: float, heading: float, grid: Grid | None = None
) -> list[Floats]:
    """Return the holder's way (m, 2) for each way of the tip (n, 2), mm, in order of work.

    offset : mm from holder's axis to tip; heading : rad, from tip to holder before the first way;
    grid : the places the machine can go to, chosen so that the tip strays least. Without one the
    ways are exact.
    """
    found = []
    for way in ways:
        holder, heading = _led(_along(np.asarray(way, float), offset, heading), offset, grid)
        found.append(holder)
    return found


def lifted_ways(
    ways: Sequence[ArrayLike], offset: float, heading: float, grid: Grid | None = None
) -> list[tuple[Floats, bool]]:
    """Return the holder's ways (m, 2), mm, broken at sharp corners, each with whether it is light.

    On a light way the tip rests on the sheet and is turned; then the blade goes in again. Takes
    what ``holder_ways`` takes.
    """
    return list(chain.from_iterable(lifted_parts(ways, offset, heading, grid)))


def lifted_parts(
    ways: Sequence[ArrayLike], offset: float, heading: float, grid: Grid | None = None
) -> Iterator[list[tuple[Floats, bool]]]:
    """Yield of each way of the tip the holder's ways that it is broken into."""
    for way in ways:
        parts = []
        for gentle in _between_corners(_moving(np.asarray(way, float))):
            course = float(_courses(gentle)[0])
            if abs(_turn(heading, course)) > np.radians(SHARP_DEG):
                turned, heading = _led(_about(gentle[0], offset, heading, course), offset, grid)
                parts.append((turned, True))
            holder, heading = _led(_along(gentle, offset, heading), offset, grid)
            parts.append((holder, False))
        yield parts


def last_heading(way: ArrayLike, heading: float = 0.0) -> float:
    """Return the blade's direction after a way (n, 2), rad; as before where it leads nowhere."""
    courses = _courses(_moving(np.asarray(way, float)))
    return float(courses[-1]) if len(courses) else heading


def lead_in(start: ArrayLike, offset: float, along: float) -> Floats:
    """Return the way (3, 2) of the holder that turns a blade of unknown direction, mm.

    start : (2,) mm; along : rad, direction of the second leg, in which the blade points at the end.
    Two legs at a right angle: a blade that points straight against one stays so, but not against
    the other.
    """
    leg = SETTLED * offset
    first, second = (_unit(along - np.pi / 2), _unit(along))
    corner = np.asarray(start, float) + leg * first
    return np.array([start, corner, corner + leg * second], float)


def is_facetted(radius: float, offset: float) -> bool:
    """Tell whether a circle is too small to steer the blade round it smoothly."""
    return radius < FACETTED * offset


def facets(radius: float, offset: float) -> int:
    """Return how many facets such a circle gets: all of them touch it from outside."""
    return max(LEAST_FACETS, int(np.pi / np.arctan(FACET * offset / (2 * radius))))


def _between_corners(way: Floats) -> list[Floats]:
    """Cut a way at its sharp corners; one that leads nowhere has no part."""
    courses = _courses(way)
    turns = [abs(_turn(one, other)) for one, other in pairwise(courses.tolist())]
    sharp = [k for k, turn in enumerate(turns, start=1) if turn > np.radians(SHARP_DEG)]
    cuts = [0, *sharp, len(way) - 1]
    return [way[a : b + 1] for a, b in pairwise(cuts) if b > a]


class _Course(NamedTuple):
    """Where a holder is to go, and how the blade points before and after it, rad."""

    guide: Guide
    before: float
    after: float


def _led(course: _Course, offset: float, grid: Grid | None) -> tuple[Floats, float]:
    """Return the holder's way and how the blade points after it."""
    if grid is None:
        return course.guide.holder, course.after
    return grid.snapped(course.guide, offset, course.before)


def _along(way: Floats, offset: float, heading: float) -> _Course:
    """Lead the tip along a way."""
    way, before = _moving(way), heading
    legs = [np.array([way[0], way[0]]), *(way[k : k + 2] for k in range(len(way) - 1))]
    pieces = [_set_down(way[0], offset, heading)]
    for last, leg, course in zip(legs[:-1], legs[1:], _courses(way).tolist(), strict=True):
        pieces.append(_swung(leg[0], offset, heading, course, np.stack([last, leg])))
        end = leg[1:] + offset * _unit(course)
        pieces.append(Guide(end, leg[1:], np.stack([leg, leg])[None]))
        heading = course
    return _Course(_joined(pieces), before, heading)


def _about(spot: Floats, offset: float, heading: float, course: float) -> _Course:
    """Turn the blade about its resting tip."""
    rest = np.broadcast_to(spot, (2, 2, 2))
    pieces = [_set_down(spot, offset, heading), _swung(spot, offset, heading, course, rest)]
    return _Course(_joined(pieces), heading, course)


def _set_down(spot: Floats, offset: float, heading: float) -> Guide:
    rest = np.broadcast_to(spot, (1, 2, 2, 2))
    return Guide((spot + offset * _unit(heading))[None], spot[None], rest)


def _swung(spot: Floats, offset: float, before: float, after: float, lines: Floats) -> Guide:
    """Swing the holder about the tip; it may be near the lines (2, 2, 2) meanwhile."""
    holder = _swivel(spot, offset, before, after)
    near = np.broadcast_to(lines, (len(holder), 2, 2, 2))
    return Guide(holder, np.full(holder.shape, np.nan), near)


def _joined(pieces: Sequence[Guide]) -> Guide:
    return Guide(*(np.concatenate(parts) for parts in zip(*pieces, strict=True)))


def _swivel(tip: Floats, offset: float, before: float, after: float) -> Floats:
    """Return the chords (n, 2) on which the holder swings about the tip, without where it is."""
    turn = _turn(before, after)
    widest = 2 * np.arccos(max(1.0 - SAGITTA_MM / offset, 0.0))
    count = int(np.ceil(abs(turn) / widest))
    angles = before + turn * np.arange(1, count + 1) / max(count, 1)
    return tip + offset * np.column_stack([np.cos(angles), np.sin(angles)])


def _turn(before: float, after: float) -> float:
    """Return by how much to turn, rad, the shorter way round."""
    return (after - before + np.pi) % (2 * np.pi) - np.pi


def _moving(way: Floats) -> Floats:
    """Drop points that repeat the one before."""
    stays = [bool((a == b).all()) for a, b in pairwise(way)]
    kept: Floats = way[[True, *(not stay for stay in stays)]]
    return kept


def _courses(way: Floats) -> Floats:
    step = np.diff(way, axis=0)
    return np.arctan2(step[:, 1], step[:, 0])


def _unit(angle: float) -> Floats:
    return np.array([np.cos(angle), np.sin(angle)])
