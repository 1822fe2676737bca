"""Where scores begin and end: trails over the creases of one face, held back from the vertices."""

from __future__ import annotations

from collections.abc import Mapping
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
    spokes: dict[int, list[tuple[Face, float]]] = {}
    for face, edges in by_face.items():
        for a, b in pattern.edges[edges].tolist():
            for tail, head in ((a, b), (b, a)):
                step = pattern.vertices[head] - pattern.vertices[tail]
                angle = float(np.degrees(np.arctan2(step[1], step[0])))
                spokes.setdefault(tail, []).append((face, angle))
    whole = set(surrounded(pattern).tolist())
    return {v for v, own in spokes.items() if v in whole and not _is_one_groove(own)}


def surrounded(pattern: CreasePattern) -> Indices:
    """Return the vertices with paper all round: the interior ones, and the ends of inner cuts."""
    cuts = pattern.edges[pattern.assignments == Assignment.C]
    border = pattern.edges[pattern.assignments == Assignment.B]
    ends, count = np.unique(cuts, return_counts=True)
    return np.union1d(pattern.interior_vertices, np.setdiff1d(ends[count == 1], border))


def _is_one_groove(spokes: list[tuple[Face, float]]) -> bool:
    if len(spokes) == 1:
        return True
    (one, p), (two, q) = spokes[:2]
    bend = abs((p - q) % 360 - 180)
    return len(spokes) == 2 and one is two and bend <= STRAIGHT_DEG


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
    pieces = [piece for trail in found.trails for piece in _divide(trail, spots, held)]
    if len(pieces) == len(found.trails) and repeats % 2:
        return tuple(pieces)
    return order.sorted_strokes(pieces, repeats, start)


def _divide(trail: tuple[int, ...], spots: Floats, stops: Mapping[int, float]) -> list[Stroke]:
    """Cut a trail into strokes where they must stop short of a vertex."""
    cuts = [k for k in range(1, len(trail) - 1) if trail[k] in stops]
    pieces = []
    for low, high in pairwise([0, *cuts, len(trail) - 1]):
        way = spots[list(trail[low : high + 1])]
        bent = [k for k in range(1, len(way) - 1) if _bends(way, k)]
        one = _shortened(way[0], way[1], stops[trail[low]]) if trail[low] in stops else way[0]
        two = _shortened(way[-1], way[-2], stops[trail[high]]) if trail[high] in stops else way[-1]
        points = (one, *way[bent], two)
        pieces.append(Stroke(points=tuple((float(x), float(y)) for x, y in points)))
    return pieces


def _bends(way: Floats, k: int) -> bool:
    one, two = way[k] - way[k - 1], way[k + 1] - way[k]
    bend = np.degrees(np.arctan2(one[0] * two[1] - one[1] * two[0], one @ two))
    return bool(abs(bend) > STRAIGHT_DEG)


def _shortened(end: Floats, towards: Floats, setback: float) -> Floats:
    step = towards - end
    moved: Floats = end + step * (setback / float(np.hypot(*step)))
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
