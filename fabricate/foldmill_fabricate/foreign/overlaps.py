"""Lines that run along each other: cut as drawn, the knife would go over them twice."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Stroke

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BESIDE_MM = 0.02
"""mm. Lines this near to each other are one line: less than a plotter step."""
ALONG_MM = 0.1
"""mm. Two lines may run along each other for as long as this: where they cross at a small angle."""
MEETINGS = 5_000_000
"""Pairs of lines that may meet; a net of a thousand lines each way has a fifth of that."""
_CHUNK = 64


def refuse(strokes: Sequence[Stroke]) -> None:
    """Raise CannotPlan where two lines, or two parts of one, run along each other.

    Lines are compared a few at a time, so that a drawing made to take long is refused soon.
    """
    lines = np.concatenate([_pieces(stroke) for stroke in strokes])
    _refuse_same(lines)
    met = 0
    for i, j in _meeting(lines):
        met += len(i)
        along = _along(lines[i], lines[j])
        if len(along) and along.max() > ALONG_MM:
            worst = int(np.argmax(along))
            raise CannotPlan(_told(lines[i[worst]], float(along[worst])))
        if met > MEETINGS:
            raise CannotPlan(
                f"The drawing's lines meet more than {MEETINGS:,} times, which is no drawing of "
                "something to be cut. Draw less of it at once."
            )


def _meeting(lines: Floats) -> Iterator[tuple[Indices, Indices]]:
    """Yield the numbers of lines that come near each other, some pairs at a time."""
    import shapely

    shapes = shapely.linestrings(lines)
    tree = shapely.STRtree(shapes)
    for begin in range(0, len(lines), _CHUNK):
        own = shapes[begin : begin + _CHUNK]
        i, j = tree.query(own, predicate="dwithin", distance=BESIDE_MM)
        first = i + begin < j
        yield i[first] + begin, j[first]


def _refuse_same(lines: Floats) -> None:
    """Refuse lines that have both ends in common, which needs no search."""
    ends = np.round(lines, 3)
    backwards = (ends[:, 0, 0] > ends[:, 1, 0]) | (
        (ends[:, 0, 0] == ends[:, 1, 0]) & (ends[:, 0, 1] > ends[:, 1, 1])
    )
    ends[backwards] = ends[backwards, ::-1]
    _, first, counts = np.unique(ends.reshape(-1, 4), axis=0, return_index=True, return_counts=True)
    lengths = np.hypot(*(lines[first, 1] - lines[first, 0]).T)
    twice = np.flatnonzero((counts > 1) & (lengths > ALONG_MM))
    if len(twice):
        raise CannotPlan(_told(lines[first[twice[0]]], float(lengths[twice[0]])))


def _told(line: Floats, along: float) -> str:
    (x, y), (u, v) = line.tolist()
    return (
        f"Two lines run along each other for {along:.2f} mm, from ({x:.2f}, {y:.2f}) to "
        f"({u:.2f}, {v:.2f}) mm of the blank: they would be cut twice. Draw each line once; how "
        "often the knife repeats it comes from the material."
    )


def _pieces(stroke: Stroke) -> Floats:
    """Return the straight pieces (n, 2, 2) of a stroke, mm."""
    points = np.asarray(stroke.points, float)
    return np.stack([points[:-1], points[1:]], axis=1)


def _along(these: Floats, those: Floats) -> Floats:
    """Return for how long (n,) mm pieces run beside others, near and in one direction."""
    course = these[:, 1] - these[:, 0]
    length = np.hypot(*course.T)
    unit = course / np.maximum(length, 1e-12)[:, None]
    arms = those - these[:, :1]
    place = (arms * unit[:, None]).sum(axis=-1)
    beside = np.abs(arms[..., 0] * unit[:, None, 1] - arms[..., 1] * unit[:, None, 0])
    low, high = np.maximum(place.min(axis=1), 0), np.minimum(place.max(axis=1), length)
    across = np.abs(those[:, 1] - those[:, 0]).sum(axis=-1)
    steep = np.ptp(arms[..., 0] * unit[:, None, 1] - arms[..., 1] * unit[:, None, 0], axis=1)
    near = (beside.min(axis=1) <= BESIDE_MM) & (steep <= 0.05 * np.maximum(across, 1e-12))
    shared: Floats = np.where(near, high - low, 0.0)
    return shared
