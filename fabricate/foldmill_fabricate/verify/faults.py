"""Where a job is wrong, as lines on the sheet: for pictures. The findings say it in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Face
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.cover import Pieces, Stretches
from foldmill_fabricate.verify.creases import astray as scored_astray
from foldmill_fabricate.verify.cuts import astray as cut_astray
from foldmill_fabricate.verify.drawing import Drawing
from foldmill_fabricate.verify.planned import Planned

Floats = NDArray[np.float64]


class Kind(StrEnum):
    """What is wrong with a line."""

    MISSING = "missing"
    EXTRA = "extra"
    MOVED = "moved"


@dataclass(frozen=True, eq=False)
class Fault:
    """A line that is not as it should be, in sheet coordinates."""

    kind: Kind
    face: Face
    points: Floats
    """(n, 2) mm: where it should be, if it is missing; else where it is."""
    shift: tuple[float, float] = (0.0, 0.0)
    """mm from where a moved line should be."""


def drawn_faults(drawing: Drawing, face: Face) -> Iterator[Fault]:
    """Yield where a program does not draw its strokes."""
    moved = drawing.moved
    for stroke, lines in moved.items():
        for line in lines:
            points = drawing.lines[line].points
            yield Fault(Kind.MOVED, face, points, _shift(drawing.strokes[stroke].points, points))
    taken = {line for lines in moved.values() for line in lines}
    yield from _faults(Kind.MISSING, face, drawing.wanted, drawing.missing, set(moved))
    yield from _faults(Kind.EXTRA, face, drawing.drawn, drawing.extra, taken)


def planned_faults(asked: Asked, strokes: Sequence[Planned]) -> Iterator[Fault]:
    """Yield where the plan does not draw what the pattern asks for."""
    found = [*scored_astray(asked, strokes), *cut_astray(asked, strokes)]
    for face, missing, lines, parts in found:
        yield from _faults(Kind.MISSING if missing else Kind.EXTRA, face, lines, parts, set())


def _faults(
    kind: Kind, face: Face, lines: Pieces, parts: Stretches, without: set[int]
) -> Iterator[Fault]:
    rows = zip(parts.line.tolist(), parts.low.tolist(), parts.high.tolist(), strict=True)
    for line, low, high in rows:
        if line not in without:
            yield Fault(kind, face, _between(lines, line, low, high))


def _between(lines: Pieces, line: int, low: float, high: float) -> Floats:
    """Return a line's points from ``low`` to ``high`` mm along it."""
    mine = lines.line == line
    starts = lines.start[mine]
    corners = lines.ends[mine, 0][(starts > low) & (starts < high)]
    return np.vstack([[lines.at(line, low)], corners, [lines.at(line, high)]])


def _shift(planned: Floats, drawn: Floats) -> tuple[float, float]:
    """Return how far a line was moved: from the middle of its place to its own."""
    one, other = ((p.max(axis=0) + p.min(axis=0)) / 2 for p in (planned, drawn))
    dx, dy = other - one
    return float(dx), float(dy)
