"""What of a sweep a flat picture shows, and which forms beside it.

A picture has two directions at most: of a sweep over more parameters it shows the plane through one
row, in which the first two vary and the others stay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.batch import Outcome
from foldmill_fabricate.errors import CannotExplore
from foldmill_fabricate.explore.grid import Axis, Grid
from foldmill_fabricate.explore.regions import regions
from foldmill_fabricate.explore.sweep import WORDS, Sweep

MOST_THUMBNAILS = 12
THUMBNAILS = 8
"""As many as a picture chooses itself."""
CENTRES = 4
"""Of them, at most so many are centres of regions: what one map has at its rim is shown, too."""
LEAST_SHARE = 0.02
"""Of the free cells that a region must have to be shown by its centre."""
APART = 0.12
"""Least distance of two forms it chooses, as a share of the picture's sides."""


@dataclass(frozen=True, eq=False)
class View:
    """The plane, or line, of a sweep that a picture shows."""

    sweep: Sweep[Any]
    grid: Grid
    """The one or two parameters that vary here."""
    rows: NDArray[np.intp]
    """(a,) or (a, b): which row of the sweep each cell is."""
    fixed: str
    """What the others are, in words; empty where none varies."""

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The axes shown: across, and upward where there are two."""
        return self.grid.axes

    @property
    def codes(self) -> NDArray[np.uint8]:
        """Outcome of each cell, in the shape of ``rows``."""
        return self.sweep.outcomes.codes[self.rows]

    @property
    def is_strip(self) -> bool:
        """Whether one parameter varies alone."""
        return len(self.axes) == 1

    def place(self, row: int) -> tuple[float, float]:
        """Return where a row is, in the units of the axes; half-way up in a strip."""
        values = self.sweep.grid.values(row)
        return values[self.axes[0].name], 0.5 if self.is_strip else values[self.axes[1].name]


def view(sweep: Sweep[Any], row: int | None = None) -> View:
    """Return what is shown: the plane through a row, or else through the largest free region."""
    if row is None:
        row = sweep.regions[0].centre if sweep.regions else 0
    sweep.grid.values(row)
    shown = sweep.grid.axes[:2]
    rest = [int(place) for place in np.unravel_index(row, sweep.grid.shape)[2:]]
    numbers = np.arange(len(sweep), dtype=np.intp)
    shape = tuple(len(axis.values) for axis in shown)
    rows = numbers.reshape(*shape, -1)[..., _place(sweep.grid.shape[2:], rest)]
    fixed = [
        axis.shown(float(axis.values[place]))
        for axis, place in zip(sweep.grid.axes[2:], rest, strict=True)
    ]
    return View(sweep, Grid(shown), rows, ", ".join(fixed))


def _place(shape: Sequence[int], places: Sequence[int]) -> int:
    """Return the number of a cell among those of a grid."""
    number = 0
    for length, place in zip(shape, places, strict=True):
        number = number * length + place
    return number


def thumbnails(seen: View, wanted: Sequence[int] = ()) -> list[int]:
    """Return the rows whose forms are shown: those wanted, or else some free ones.

    Raises CannotExplore for too many, for a row outside the picture and for one without a form.
    """
    if not wanted:
        return _chosen(seen)
    if len(wanted) > MOST_THUMBNAILS:
        raise CannotExplore(
            f"{len(wanted)} thumbnails do not fit; a picture takes {MOST_THUMBNAILS}."
        )
    for row in wanted:
        if row not in seen.rows:
            raise CannotExplore(
                f"Row {row} ({seen.sweep.grid.told(row)}) is not in the picture, where "
                f"{seen.fixed}. Make a picture of its own for it."
            )
        word = WORDS[int(seen.sweep.outcomes.codes[row])]
        if word not in {"free", "penetrates", "crosses-axis"}:
            raise CannotExplore(
                f"Row {row} ({seen.sweep.grid.told(row)}) is {word}: it has no form to show."
            )
    return list(dict.fromkeys(wanted))


def _chosen(seen: View) -> list[int]:
    """Return the centres of the largest free regions, then free rows far from those chosen."""
    is_free = seen.codes == Outcome.FREE
    joined = seen.sweep.joined[: len(seen.axes)]
    found = regions(seen.grid, is_free.ravel(), joined)[1]
    centres = [r.centre for r in found if r.size >= LEAST_SHARE * np.count_nonzero(is_free)]
    if not centres:
        return []
    chosen = _apart(centres, is_free.shape)
    for cells in (_inner(is_free), is_free):
        chosen = _spread(cells, chosen)
    return [int(row) for row in seen.rows.ravel()[chosen]]


def _apart(centres: list[int], shape: tuple[int, ...]) -> list[int]:
    """Return the first of the cells and each further one that is far from all before it."""
    spots = np.stack(np.unravel_index(centres, shape)).T / np.array(shape)
    taken: list[int] = []
    for place, spot in enumerate(spots):
        if np.linalg.norm(spots[taken] - spot, axis=1).min(initial=np.inf) >= APART:
            taken.append(place)
    return [centres[place] for place in taken[:CENTRES]]


def _spread(cells: NDArray[np.bool_], chosen: list[int]) -> list[int]:
    """Return the chosen cells and then, one by one, the cell farthest from all before it."""
    sides = np.c_[list(cells.shape)]
    candidates = np.flatnonzero(cells)
    spots = np.stack(np.unravel_index(candidates, cells.shape)) / sides
    nearest = np.full(len(candidates), np.inf)
    for start in (np.stack(np.unravel_index(chosen, cells.shape)) / sides).T:
        nearest = np.minimum(nearest, np.linalg.norm(spots.T - start, axis=1))
    found = list(chosen)
    while len(found) < THUMBNAILS and nearest.max(initial=0) >= APART:
        best = int(np.argmax(nearest))
        found.append(int(candidates[best]))
        nearest = np.minimum(nearest, np.linalg.norm(spots.T - spots[:, best], axis=1))
    return found


def _inner(is_free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the free cells that have free cells about them; all free cells where none has."""
    from scipy import ndimage

    inner: NDArray[np.bool_] = ndimage.binary_erosion(is_free)
    return inner if inner.any() else is_free
