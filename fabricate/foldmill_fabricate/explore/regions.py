"""Free regions: cells of the grid that are free and hang together.

Terminology: two cells are neighbours where one parameter differs by one step. Between two values of
a count or a choice there is nothing, so such cells are no neighbours. An axis is *joined* where its
range goes once round: its last value is then a neighbour of its first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.explore.grid import Axis, Grid

FULL_TURN = 360.0
_FAR = 1e9
"""A step between cells that are no neighbours, in steps: never the nearest."""


@dataclass(frozen=True)
class Region:
    """Free cells that hang together."""

    number: int
    """1 for the largest."""
    size: int
    """Cells."""
    centre: int
    """The row farthest from all that is not free."""
    depth: float
    """How far, in steps, at most the longest axis; what lies beyond the ranges is not free."""
    ranges: dict[str, tuple[float, float]]
    """First and last value by dotted name; on a joined axis the last may lie beyond the range."""


def closes(axis: Axis) -> bool:
    """Tell whether the values of an angle go once round: 0 to 350 in steps of 10, or 0 to 360."""
    if axis.unit != "deg" or axis.is_whole or len(axis.values) < 3:
        return False
    steps = np.abs(np.diff(axis.values))
    gap = FULL_TURN - abs(axis.values[-1] - axis.values[0])
    return bool(np.ptp(steps) <= 1e-9 * FULL_TURN and -1e-9 <= gap <= steps[0] * (1 + 1e-9))


def regions(
    grid: Grid, is_free: NDArray[np.bool_], joined: Sequence[bool]
) -> tuple[NDArray[np.int32], tuple[Region, ...]]:
    """Return the number of the region of each row (n,), 0 where not free, and the regions.

    is_free : (n,), row by row; joined : per axis. The largest comes first, of equal ones the one
    with the lowest row.
    """
    cells = is_free.reshape(grid.shape)
    labels = _ordered(_joined(_labelled(grid, cells), joined).ravel())
    if not labels.any():
        return labels, ()
    depth = _depths(grid, cells, joined).ravel()
    order = np.argsort(labels, kind="stable")
    starts = np.searchsorted(labels[order], np.arange(1, labels.max() + 2))
    found = [
        _region(grid, number, order[first:end], depth, joined)
        for number, (first, end) in enumerate(pairwise(starts), start=1)
    ]
    return labels, tuple(found)


def _labelled(grid: Grid, cells: NDArray[np.bool_]) -> NDArray[np.int32]:
    from scipy import ndimage

    structure = ndimage.generate_binary_structure(cells.ndim, 1)
    for place, axis in enumerate(grid.axes):
        if axis.is_whole:
            sides = [slice(None)] * cells.ndim
            for side in (0, 2):
                sides[place] = slice(side, side + 1)
                structure[tuple(sides)] = False
    labels: NDArray[np.int32] = ndimage.label(cells, structure)[0].astype(np.int32)
    return labels


def _joined(labels: NDArray[np.int32], joined: Sequence[bool]) -> NDArray[np.int32]:
    """Give one label to what meets across the ends of joined axes."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs = [
        np.stack([labels.take(0, axis).ravel(), labels.take(-1, axis).ravel()])
        for axis in range(labels.ndim)
        if joined[axis]
    ]
    if not pairs:
        return labels
    one, two = np.concatenate(pairs, axis=1)
    meets = (one > 0) & (two > 0)
    count = int(labels.max()) + 1
    graph = coo_array((np.ones(int(meets.sum())), (one[meets], two[meets])), shape=(count, count))
    together = connected_components(graph, directed=False)[1] + 1
    return np.where(labels > 0, together[labels], 0).astype(np.int32)


def _ordered(labels: NDArray[np.int32]) -> NDArray[np.int32]:
    """Number the labels anew, 1 for the largest."""
    known, first, size = np.unique(labels, return_index=True, return_counts=True)
    is_region = known > 0
    known, first, size = known[is_region], first[is_region], size[is_region]
    numbers = np.zeros(int(labels.max(initial=0)) + 1, np.int32)
    numbers[known[np.lexsort((first, -size))]] = np.arange(1, len(known) + 1)
    return numbers[labels]


def _depths(grid: Grid, cells: NDArray[np.bool_], joined: Sequence[bool]) -> NDArray[np.float64]:
    """Return how far each cell is from all that is not free, in steps."""
    from scipy import ndimage

    has_width = [not axis.is_whole and len(axis.values) > 1 for axis in grid.axes]
    margins, padded = [], cells
    for place, length in enumerate(cells.shape):
        margin = (length + 1) // 2 if joined[place] else 1 if has_width[place] else 0
        widths = [(margin, margin) if k == place else (0, 0) for k in range(cells.ndim)]
        padded = np.pad(padded, widths, mode="wrap" if joined[place] else "constant")
        margins.append(slice(margin, margin + length))
    if padded.all():
        return np.full(cells.shape, np.inf)
    steps = [1.0 if wide else _FAR for wide in has_width]
    depths: NDArray[np.float64] = ndimage.distance_transform_edt(padded, sampling=steps)
    return depths[tuple(margins)]


def _region(
    grid: Grid,
    number: int,
    rows: NDArray[np.intp],
    depth: NDArray[np.float64],
    joined: Sequence[bool],
) -> Region:
    deepest = depth[rows].max()
    centres = rows[depth[rows] >= deepest - 1e-9]
    centre = int(centres[len(centres) // 2])
    places = np.unravel_index(rows, grid.shape)
    ranges = {
        axis.name: _range(axis, np.unique(place), goes_round)
        for axis, place, goes_round in zip(grid.axes, places, joined, strict=True)
    }
    return Region(number, len(rows), centre, float(min(deepest, max(grid.shape))), ranges)


def _range(axis: Axis, places: NDArray[np.intp], goes_round: bool) -> tuple[float, float]:
    """Return the first and the last value; on a joined axis, those beside the widest gap."""
    if not goes_round or len(places) == len(axis.values):
        return float(axis.values[places[0]]), float(axis.values[places[-1]])
    gaps = np.diff([*places, places[0] + len(axis.values)])
    widest = int(np.argmax(gaps))
    first, last = axis.values[places[(widest + 1) % len(places)]], axis.values[places[widest]]
    turn = FULL_TURN * np.sign(axis.values[-1] - axis.values[0])
    beyond = widest + 1 < len(places)
    return float(first), float(last + turn if beyond else last)
