"""A run of consecutive rows: the piece of a sweep that is computed in one place at one time.

How a sweep is cut depends on nothing but its family and its rows, so a chunk's number says which
rows it holds, whoever computes it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import Design, Params
from foldmill.batch import NOWHERE, Column, Outcomes
from foldmill.configurations import outcomes
from foldmill.errors import BrokenBatch, InvalidInput, one_line
from foldmill_fabricate.explore.grid import Grid

FAULT = 255
"""In the codes of a sweep, beside those of Outcome: the family broke down at this row."""
BATCH_ROWS = 262_144
"""A compiled batch does some 3 million rows a second, an uncompiled one less: 80 ms and more."""
ROWS, MOST_ROWS = 16, 256
"""Generating and checking takes some 10 ms a row: a chunk is 0.2 to 3 s, many chunks large ones."""
WANTED_CHUNKS = 1000
SHORT_CHUNKS = 8
"""Of a batch: about a second's work, and processes take more than that to start."""
SAMPLE = 16
"""Rows at which a batch shows whether it computes together what it is asked for."""


@dataclass(frozen=True, eq=False)
class Chunk:
    """What became of some consecutive rows."""

    number: int
    codes: NDArray[np.uint8]
    """(n,) values of Outcome, or FAULT."""
    at: NDArray[np.int32]
    """(n,) number of the point without candidate, or NOWHERE."""
    figures: Mapping[str, Column]
    """(n,) each, by names with a unit."""
    faults: Mapping[int, str] = field(default_factory=dict)
    """What went wrong, by row of the sweep."""


@dataclass(frozen=True)
class Task:
    """All that is needed to compute any chunk of a sweep; it travels to other processes."""

    design: Design[Any]
    base: Params
    grid: Grid

    @cached_property
    def chunk_rows(self) -> int:
        """How many rows a chunk has: about as many are generated and checked in each, or fewer."""
        rows = min(max(-(-len(self.grid) // WANTED_CHUNKS), ROWS), MOST_ROWS)
        return min(int(rows / self._share_alone), BATCH_ROWS) if self._share_alone else BATCH_ROWS

    @cached_property
    def _share_alone(self) -> float:
        """The share of the rows that are generated and checked one by one, in a seeded sample.

        A batch may leave rows to that, of some parameters all.
        """
        if self.design.batch is None or len(self.grid) <= SAMPLE:
            return 1.0
        rows = np.random.default_rng(0).integers(0, len(self.grid), SAMPLE)
        try:
            found = outcomes(self.design, self.base, self.grid.columns(rows))
        except Exception:
            return 1.0  # where it breaks down is found when all rows are computed
        return found.alone / SAMPLE

    @property
    def chunks(self) -> int:
        """How many chunks there are."""
        return -(-len(self.grid) // self.chunk_rows)

    @property
    def is_short(self) -> bool:
        """Whether it is done before other processes would have started."""
        return self.chunks == 1 or (not self._share_alone and self.chunks <= SHORT_CHUNKS)

    def rows(self, number: int) -> NDArray[np.intp]:
        """Return the rows of a chunk."""
        first = number * self.chunk_rows
        return np.arange(first, min(first + self.chunk_rows, len(self.grid)), dtype=np.intp)


def compute(task: Task, number: int) -> Chunk:
    """Return what becomes of the rows of a chunk; a row that breaks the family is told, not raised.

    Raises InvalidInput or BrokenBatch where no row can be computed: a parameter that the family
    does not know, a batch whose answers mean nothing.
    """
    rows = task.rows(number)
    faults: dict[int, str] = {}
    parts = _computed(task, rows, faults)
    figures = joined_figures(parts)
    codes = np.concatenate([part.codes for part in parts])
    codes[np.isin(rows, list(faults))] = FAULT
    return Chunk(number, codes, np.concatenate([part.at for part in parts]), figures, faults)


def joined_figures(parts: Sequence[Outcomes | Chunk]) -> dict[str, Column]:
    """Return the figures of all parts one after another, by name; NaN where a part has none."""
    names = sorted({name for part in parts for name in part.figures})
    return {
        name: np.concatenate(
            [part.figures.get(name, np.full(len(part.codes), np.nan)) for part in parts]
        )
        for name in names
    }


def _computed(task: Task, rows: NDArray[np.intp], faults: dict[int, str]) -> list[Outcomes]:
    """Compute rows together; where that breaks, halve them until the rows at fault are found."""
    try:
        return [outcomes(task.design, task.base, task.grid.columns(rows))]
    except (InvalidInput, BrokenBatch):
        raise
    except Exception as error:
        if len(rows) == 1:
            faults[int(rows[0])] = one_line(error)
            return [Outcomes(np.zeros(1, np.uint8), np.full(1, NOWHERE, np.int32))]
        half = len(rows) // 2
        return _computed(task, rows[:half], faults) + _computed(task, rows[half:], faults)
