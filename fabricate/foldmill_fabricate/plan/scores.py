"""Where scores begin and end: trails over the creases of one face, held back from the vertices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Perforation
from foldmill_fabricate.passes import Face, Stroke
from foldmill_fabricate.toolpath import order
from foldmill_fabricate.toolpath.corners import by_time, free_turning
from foldmill_fabricate.toolpath.perforation import Dashes, perforated, shortest
from foldmill_fabricate.toolpath.routing import route

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

STRAIGHT_DEG = 0.001
"""deg. Two creases that bend by less at a vertex are one straight line to a knife."""
TOUCH = 1e-6
"""mm. How far a row of cuts is cut off at a vertex it stops short of: its own land does the rest.
"""


def held_back(pattern: CreasePattern, by_face: dict[Face, Indices]) -> set[int]:
    """Return the vertices with paper all round that all scores stop short of.

    by_face : edges scored on each face. There at least two scored creases meet that are not one
    groove: they bend, or lie on different faces, whose grooves must not touch.
    """
    edges = np.concatenate(list(by_face.values()))
    side = np.repeat(np.arange(len(by_face)), [len(own) for own in by_face.values()])
    tails = np.concatenate(pattern.edges[edges].T)
    heads = np.concatenate(pattern.edges[edges].T[::-1])
    angles = np.degrees(np.arctan2(*(pattern.vertices[heads] - pattern.vertices[tails]).T[::-1]))
    order = np.argsort(tails, kind="stable")
    tails, angles, side = tails[order], angles[order], np.tile(side, 2)[order]
    first = np.flatnonzero(np.append(True, tails[1:] != tails[:-1])) if len(tails) else order
    count = np.diff(np.append(first, len(tails)))
    two = first[count == 2]
    bend = np.abs((angles[two] - angles[two + 1]) % 360 - 180)
    grooves = tails[two[(side[two] == side[two + 1]) & (bend <= STRAIGHT_DEG)]]
    meeting = np.setdiff1d(tails[first[count > 1]], grooves)
    return set(np.intersect1d(meeting, surrounded(pattern)).tolist())


def surrounded(pattern: CreasePattern) -> Indices:
    """Return the vertices with paper all round: the interior ones, and the ends of inner cuts."""
    cuts = pattern.edges[pattern.assignments == Assignment.C]
    border = pattern.edges[pattern.assignments == Assignment.B]
    ends, count = np.unique(cuts, return_counts=True)
    return np.union1d(pattern.interior_vertices, np.setdiff1d(ends[count == 1], border))


def strokes(
    pattern: CreasePattern,
    spots: Floats,
    edges: Indices,
    stops: Mapping[int, float],
    repeats: int,
    start: Floats,
    machine: Machine,
) -> tuple[Stroke, ...]:
    """Return the score strokes of one face in order of work.

    spots : (V, 2) the vertices on the sheet, mm; edges : those scored on this face;
    stops : vertices that scores stop short of, and by how many mm; start : (2,) where the tool is.
    Creases are joined to trails, then divided where scores stop short. The pieces are ordered, not
    the trails: an even number of repeats ends a stroke where it began, so that the next piece of
    its trail is no nearer than others; and where it ends at the other end, ordering the pieces
    finds the hops of the trail among all others.
    """
    corners = by_time(machine.motion) if machine.tools.trails else free_turning()
    found = route(spots, pattern.edges[edges], start, corners)
    held = {vertex: by for vertex, by in stops.items() if by > 0}
    pieces = _divided(found.trails, spots, held)
    if machine.bed.pull:
        return order.by_middles(pieces, start)
    if len(pieces) == len(found.trails) and repeats % 2:
        return tuple(pieces)
    return order.sorted_strokes(pieces, repeats, start)


def _divided(
    trails: Sequence[tuple[int, ...]], spots: Floats, stops: Mapping[int, float]
) -> list[Stroke]:
    """Cut trails into strokes where they must stop short of a vertex."""
    ways = [way for trail in trails for way in _ways(trail, stops)]
    held = np.zeros(len(spots))
    held[list(stops)] = list(stops.values())
    ends = [
        _shortened(spots, np.array([way[::step][:2] for way in ways], np.intp).reshape(-1, 2), held)
        for step in (1, -1)
    ]
    pieces = []
    for way, one, two in zip(ways, ends[0].tolist(), ends[1].tolist(), strict=True):
        bent = _bent(spots[list(way)]) if len(way) > 2 else []
        pieces.append(Stroke(points=tuple((x, y) for x, y in (one, *bent, two))))
    return pieces


def _ways(trail: tuple[int, ...], stops: Mapping[int, float]) -> list[tuple[int, ...]]:
    cuts = [k for k in range(1, len(trail) - 1) if trail[k] in stops]
    return [trail[low : high + 1] for low, high in pairwise([0, *cuts, len(trail) - 1])]


def _bent(way: Floats) -> list[list[float]]:
    """Return the points of a way (n, 2) between its ends at which it bends."""
    bent: list[list[float]] = way[[k for k in range(1, len(way) - 1) if _bends(way, k)]].tolist()
    return bent


def _bends(way: Floats, k: int) -> bool:
    one, two = way[k] - way[k - 1], way[k + 1] - way[k]
    bend = np.degrees(np.arctan2(one[0] * two[1] - one[1] * two[0], one @ two))
    return bool(abs(bend) > STRAIGHT_DEG)


def _shortened(spots: Floats, pairs: Indices, held: Floats) -> Floats:
    """Return the first of each pair of vertices (n, 2), moved to the second as far as is held."""
    ends = spots[pairs[:, 0]]
    step, by = spots[pairs[:, 1]] - ends, held[pairs[:, 0]]
    short = by > 0
    moved: Floats = ends.copy()
    moved[short] += step[short] * (by[short] / np.hypot(*step[short].T))[:, None]
    return moved


def dashed(pieces: tuple[Stroke, ...], score: Perforation) -> tuple[Stroke, ...]:
    """Return the cuts of perforated lines, in the order and direction of the lines.

    The lines run from vertex to vertex: the lands at their ends are the rows' own. Raises
    CannotPlan where lines are too short for any cut.
    """
    dashes = Dashes(score.cut, score.gap, score.setback)
    found, short = [], []
    for piece in pieces:
        for start, end in pairwise(np.array(piece.points)):
            cuts = perforated(start, end, dashes)
            if not len(cuts):
                short.append((float(np.hypot(*(end - start))), *((start + end) / 2).tolist()))
            found += [Stroke(points=((a[0], a[1]), (b[0], b[1]))) for a, b in cuts.tolist()]
    if short:
        raise _too_short(short, dashes)
    return tuple(found)


def _too_short(lines: list[tuple[float, float, float]], dashes: Dashes) -> CannotPlan:
    """Say how many lines are too short; lines : length and middle of each, mm."""
    length, x, y = min(lines)
    least = shortest(dashes)
    more = f" {len(lines)} lines in all are too short." if len(lines) > 1 else ""
    return CannotPlan(
        f"The crease at ({x:.1f}, {y:.1f}) mm is {length:.2f} mm long; a perforation takes "
        f"{least:.2f} mm: its lands and half a cut.{more} Enlarge the design "
        f"{np.ceil(100 * least / length) / 100:.2f} times, score it otherwise, or merge its "
        f"vertices."
    )
