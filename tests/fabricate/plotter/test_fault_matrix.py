"""Whatever fails, with whatever handshake: what is certain is cut, and what is in doubt short."""

from __future__ import annotations

import random
from collections.abc import Sequence

from fabricate.plotter import fault_matrix
from fabricate.plotter.fault_matrix import EXPECTED, LINE, WINDOW, Cell, Outcome
from soaking import Soak

from foldmill_fabricate.plotter.handshakes.feed import IN_FLIGHT
from foldmill_fabricate.plotter.simulator.drawing import Drawn, Step

SEED = 20261123
ROUNDING = 0.05
"""s: of the model."""


def holds(drawn: Sequence[Drawn], path: Sequence[Step]) -> bool:
    """Whether a stroke was drawn whole, alone or at the head of a longer one."""
    return any(tuple(one.points[: len(path)]) == tuple(path) for one in drawn)


def assert_cell(cell: Cell, found: Outcome) -> None:
    where = f"{cell}: {found.words}"
    assert found.end == fault_matrix.expected(cell), where
    assert found.words, where
    assert found.split == 0 or cell.fault in LINE, where
    assert found.overruns == 0, where
    if found.end != "B":
        return
    assert all(holds(found.drawn, each.points) for each in found.planned[: found.acked]), where
    assert len(found.drawn) <= found.sent, where
    stroke = found.longest + ROUNDING
    assert found.after <= IN_FLIGHT + stroke, where
    if cell.handshake in WINDOW:
        assert found.doubt <= WINDOW[cell.handshake] + stroke, where


def test_the_matrix_has_at_least_three_hundred_cells_and_an_end_for_each() -> None:
    cells = fault_matrix.cells()
    assert len(cells) >= 300
    assert {*EXPECTED} == {*fault_matrix.FAULTS}
    assert {fault_matrix.expected(cell) for cell in cells} == {"A", "B", "C", "D"}


def test_every_fault_at_every_handshake_ends_as_its_cell_says(soak: Soak) -> None:
    cells = fault_matrix.cells()
    random.Random(SEED).shuffle(cells)
    count = soak.size(14, len(cells))
    with soak.part("fault-matrix", SEED, count, "cells") as progress:
        for number, cell in enumerate(cells[progress.before : count], progress.before + 1):
            assert_cell(cell, fault_matrix.run(cell))
            progress.reached(number)
