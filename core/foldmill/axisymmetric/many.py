"""Many configurations of a strip family at once: what its ``batch`` is made of.

A family says how rows of its parameters become strips (``Task``). The kernels judge them, and rows
so near a border between outcomes that rounding may decide are generated and checked one by one, so
that every row gets the answer that generate and check would give.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.rows import Rows, alike, in_bounds
from foldmill.batch import NOWHERE, Column, Outcome, Outcomes
from foldmill.configurations import P, one_by_one, require_known
from foldmill.design import Design
from foldmill.kernels import CODES, Limits, Strips, judge
from foldmill.tolerances import SLIVER_SURE

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.intp]
FIGURES = ("width_x_mm", "width_y_mm", "height_mm", "sheet_x_mm", "sheet_y_mm")


@dataclass(frozen=True, eq=False)
class Task:
    """n rows of a family, whose single parameters are all within their bounds."""

    strips: Strips
    refused: Flags
    """(n,) rows that the design refuses for how their parameters go together."""
    unsure: Flags
    """(n,) rows to be generated and checked one by one, whatever the kernels would say."""
    sheet: Floats
    """(n, 2) or (1, 2) sides of the pattern, mm."""
    first: int
    """The number i of the strip's first point."""
    shape: Floats | None = None
    """(n, k) numbers that alone decide about the form, where that leaves many rows alike."""
    limits: Limits | None = None
    """The kernels' tolerances where they are not those of every strip."""
    lost: Indices | None = None
    """(n,) number i of a point without a place that the family finds before any is solved, else
    NOWHERE; None where it finds none."""


Prepare = Callable[[Rows], Task | None]
"""What a family must say: from rows to a task, or None for rows that it leaves to one by one."""


def batch_of(design: Design[P], prepare: Prepare) -> Callable[[P, Mapping[str, Column]], Outcomes]:
    """Return the ``batch`` of a design whose rows become strips by ``prepare``."""
    return partial(_batch, design, prepare)


def _batch(design: Design[P], prepare: Prepare, base: P, columns: Mapping[str, Column]) -> Outcomes:
    require_known(base, columns)
    given = {name: np.asarray(column, np.float64) for name, column in columns.items()}
    legal = in_bounds(base, given)
    if legal is None:
        return one_by_one(design, base, given)
    out, rows = _refusals(len(legal)), np.flatnonzero(legal)
    if not len(rows):
        return out
    task = prepare(Rows(base, _picked(given, rows)))
    left = rows if task is None else rows[_judged(task, rows, out)]
    if len(left):
        _merge(out, left, one_by_one(design, base, _picked(given, left)))
    return replace(out, alone=len(left))


def _picked(columns: Mapping[str, Column], rows: Indices) -> dict[str, Column]:
    return {name: column[rows] for name, column in columns.items()}


def _refusals(count: int) -> Outcomes:
    codes, at = np.full(count, Outcome.REFUSED, np.uint8), np.full(count, NOWHERE, np.int32)
    return Outcomes(codes, at, {name: np.full(count, np.nan) for name in FIGURES})


def _judged(task: Task, rows: Indices, out: Outcomes) -> Indices:
    """Fill in what the kernels say of the task's rows; return those they leave open."""
    is_left = _solvable(task, rows, out)
    sure = np.flatnonzero(is_left & ~task.unsure)
    chosen, kind = sure, np.arange(len(sure))
    if task.shape is not None:
        first, kind = alike(task.shape[sure])
        chosen = sure[first]
    found = judge(task.strips.take(chosen), task.limits, among=len(out))
    codes, at = found.codes[kind], found.at[kind]
    is_open = codes >= CODES.TURNS_FREELY
    out.codes[rows[sure]] = np.where(is_open, Outcome.REFUSED, codes)
    out.at[rows[sure]] = np.where(at >= 0, at + task.first, NOWHERE)
    extents = found.extents[kind]
    sheet = task.sheet[sure] if len(task.sheet) > 1 else task.sheet
    sheet = np.where(np.isnan(extents[:, :1]), np.nan, sheet)
    for name, column in zip(FIGURES, np.hstack([extents, sheet]).T, strict=True):
        out.figures[name][rows[sure]] = column
    unsure = np.flatnonzero(task.unsure & is_left)
    left: Indices = np.sort(np.concatenate([unsure, sure[is_open]]))
    return left


def _solvable(task: Task, rows: Indices, out: Outcomes) -> Flags:
    """Fill in the points that the family itself finds lost; tell which rows of the task go on."""
    if task.lost is None:
        return ~task.refused
    lost = np.flatnonzero(~task.refused & (task.lost != NOWHERE))
    out.codes[rows[lost]], out.at[rows[lost]] = Outcome.NO_CANDIDATE, task.lost[lost]
    goes_on: Flags = ~task.refused & (task.lost == NOWHERE)
    return goes_on


def _merge(out: Outcomes, rows: Indices, part: Outcomes) -> None:
    out.codes[rows], out.at[rows] = part.codes, part.at
    for name in FIGURES:
        out.figures[name][rows] = part.figures.get(name, np.nan)


def has_slivers(paper: Floats, farthest: Floats) -> Flags:
    """Tell which papers (m, s, 4) have a triangle too low for its angles to be surely exact.

    farthest : (n,) the largest coordinate of pattern and form, mm; m is n or 1, or n is 1.
    """
    d, c, h = paper[..., 0], paper[..., 1], paper[..., 2]
    longest = np.maximum(np.abs(d), np.maximum(np.hypot(c, h), np.hypot(d - c, h)))
    lowest = (np.abs(d) * h / longest).min(axis=1)
    flags: Flags = lowest <= SLIVER_SURE * farthest
    return flags
