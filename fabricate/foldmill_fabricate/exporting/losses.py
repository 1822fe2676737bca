"""What a program cannot hold of a pattern, in sentences: how much, where first, what it becomes."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from foldmill import Assignment, Fold
from foldmill.exchange.marking import warning
from foldmill.pattern import Flags
from foldmill.slits import sewn
from foldmill.tolerances import FLAT_DEG

Loss = Callable[[Fold, str], Iterator[str]]
"""Takes a fold and the program's name; yields sentences."""

_CLOSED = 180.0


def angles(fold: Fold, program: str) -> Iterator[str]:
    """Tell of creases that are not folded flat, for programs that know no other folds."""
    pattern = fold.pattern
    creases = (pattern.assignments == Assignment.M) | (pattern.assignments == Assignment.V)
    open_ = creases & (np.abs(np.abs(pattern.fold_angles) - _CLOSED) > FLAT_DEG)
    if open_.any():
        first = int(np.flatnonzero(open_)[0])
        yield (
            f"{program} folds every crease by 180 degrees, and {_count(open_)} of "
            f"{np.count_nonzero(creases)} creases here fold otherwise, edge {first} by "
            f"{pattern.fold_angles[first]:.1f}."
        )


def unassigned(fold: Fold, program: str) -> Iterator[str]:
    """Tell of creases without mountain or valley, for programs that know none."""
    yield from _of(fold, Assignment.U, f"{program} knows no unassigned crease", "a line that stays")


def cuts(fold: Fold, program: str) -> Iterator[str]:
    """Tell of inner cuts, for programs whose only cut is the outline."""
    pattern = sewn(fold.pattern).pattern
    where = np.flatnonzero(pattern.assignments == Assignment.C)
    if len(where):
        a, b = pattern.vertices[pattern.edges[where[0]]].round(2).tolist()
        yield (
            f"{program} knows no inner cut, and there are {len(where)} here, the first from "
            f"{a[0]:g},{a[1]:g} to {b[0]:g},{b[1]:g} mm: it becomes a part of the outline."
        )


def mark(fold: Fold, program: str) -> Iterator[str]:  # noqa: ARG001 - every loss is given both
    """Tell of a form that was written although it does not fold, for files without words."""
    if warning(fold):
        yield f"The file cannot say what this pattern says of itself: {warning(fold)}."


def near(least: float) -> Loss:
    """Return a loss that tells of points nearer to each other than ``least`` mm."""

    def told(fold: Fold, program: str) -> Iterator[str]:
        lengths = fold.pattern.edge_lengths[~np.asarray(fold.pattern.added, bool)]
        short = lengths < least
        if short.any():
            edge = int(lengths.argmin())
            yield (
                f"{program} takes points within {least:g} mm of each other for one, and "
                f"{_count(short)} edges are shorter, edge {edge} with "
                f"{lengths[edge]:.3g} mm. A larger pattern would do."
            )

    return told


def _of(fold: Fold, kind: Assignment, knows: str, becomes: str) -> Iterator[str]:
    where = fold.pattern.assignments == kind
    if where.any():
        first = int(np.flatnonzero(where)[0])
        yield f"{knows}, and {_count(where)} here are, edge {first} first: each becomes {becomes}."


def _count(flags: Flags) -> int:
    return int(np.count_nonzero(flags))
