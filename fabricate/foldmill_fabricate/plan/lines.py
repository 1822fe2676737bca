"""What is drawn of each copy, one copy after the other: scores, relief holes, inner cuts, outline.

Within a role a copy is finished before the next begins, so that the tool stays near and a copy that
went wrong is one copy. The copies are visited row by row, to and fro, from where the tool is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.finding import Finding
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, Perforation
from foldmill_fabricate.passes import Face, Hole, Stroke, Tie
from foldmill_fabricate.plan import outline, relief, scores
from foldmill_fabricate.plan.setups import Lines
from foldmill_fabricate.toolpath import closed

Floats = NDArray[np.float64]
ByFace = dict[Face, NDArray[np.intp]]
Strokes = tuple[Stroke, ...]
Draw = Callable[[int, Floats], Strokes]
"""The strokes of copy k (0, 1, 2 …) in order of work, from where the tool is (2,)."""


def drawn(
    pattern: CreasePattern,
    spots: Sequence[Floats],
    by_face: ByFace,
    stops: Mapping[int, float],
    reliefs: Sequence[tuple[Hole, ...]],
    material: Material,
    machine: Machine,
) -> tuple[Callable[[Face, Floats], Lines], tuple[Tie, ...], tuple[Finding, ...]]:
    """Return what gives the strokes of a face from where the tool is, ties, and what is told.

    spots : of each copy the vertices on the sheet (V, 2), mm; reliefs : of each copy its holes;
    stops : vertices that scores stop short of, and by how many mm.
    """
    outline.refuse_snapped_slots(pattern, material.cut)
    rims = [outline.outer_cut(pattern, own, material.cut) for own in spots]
    tied = tuple(finding for _, _, found in rims for finding in found)
    score, cut = material.score, material.cut
    rows = isinstance(score, Perforation)
    ends = dict.fromkeys(stops, scores.TOUCH) if rows else stops
    offset = machine.tools.host_offset
    middles = np.array([own[pattern.edges].mean(axis=(0, 1)) for own in spots])

    def lines(face: Face, start: Floats) -> Lines:
        def scored(k: int, at: Floats) -> Strokes:
            edges = by_face[face]
            found = scores.strokes(pattern, spots[k], edges, ends, score.repeats, at, machine)
            return scores.dashed(found, score) if isinstance(score, Perforation) else found

        def holes(k: int, at: Floats) -> Strokes:
            return relief.strokes(reliefs[k], cut.repeats, at, offset)

        def inner(k: int, at: Floats) -> Strokes:
            return outline.inner_cuts(pattern, spots[k], cut.repeats, at)

        def outer(k: int, at: Floats) -> Strokes:
            return tuple(closed.begun(rims[k][0], at, cut.repeats % 2 == 0))

        return Lines(
            _each(middles, start, score.repeats, scored),
            _each(middles, start, cut.repeats, holes),
            _each(middles, start, cut.repeats, inner),
            _each(middles, start, cut.repeats, outer),
        )

    return lines, tuple(tie for _, ties, _ in rims for tie in ties), tied


def _each(middles: Floats, start: Floats, repeats: int, draw: Draw) -> Strokes:
    """Draw copy after copy, and say of each stroke which copy it belongs to."""
    if len(middles) == 1:
        return draw(0, start)
    found: list[Stroke] = []
    for k in visited(middles, start):
        own = draw(k, start)
        found += [replace(stroke, piece=k + 1) for stroke in own]
        start = _end(own[-1], repeats) if own else start
    return tuple(found)


def _end(stroke: Stroke, repeats: int) -> Floats:
    """Return where the tool is (2,) after a stroke."""
    return np.array(stroke.points[0 if repeats % 2 == 0 and not stroke.closed else -1])


def visited(middles: Floats, start: Floats) -> list[int]:
    """Return the order of copies: to and fro along rows or columns, from the corner that suits.

    middles : (n, 2) mm, in rows and columns; start : (2,) where the tool is.
    """
    ways = [_to_and_fro(middles, *way) for way in product((0, 1), (1, -1), (1, -1))]
    return min(ways, key=lambda way: round(_length(middles[way], start), 6))


def _to_and_fro(middles: Floats, axis: int, first: int, second: int) -> list[int]:
    """Go along one axis, forward or backward, and back along the next row of the other."""
    across = np.round(middles[:, 1 - axis], 3)
    found: list[int] = []
    for k, row in enumerate(np.unique(across)[::second]):
        own = np.flatnonzero(across == row)
        way = own[np.argsort(middles[own, axis], kind="stable")]
        found += way[:: first if k % 2 == 0 else -first].tolist()
    return found


def _length(points: Floats, start: Floats) -> float:
    return float(np.hypot(*np.diff(np.vstack([start, points]), axis=0).T).sum())
