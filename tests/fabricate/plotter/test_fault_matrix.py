"""Whatever fails, with whatever handshake: what is certain is cut, and what is in doubt short."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from math import hypot

from fabricate.plotter import fault_matrix
from fabricate.plotter.fault_matrix import EXPECTED, LINE, STRAYS, WINDOW, Cell, Outcome
from soaking import Soak

from foldmill_fabricate.plotter.handshakes.feed import IN_FLIGHT
from foldmill_fabricate.plotter.simulator.drawing import Drawn, Step

SEED = 20261123
ROUNDING = 0.05
"""s: of the model."""


def holds(drawn: Sequence[Drawn], path: Sequence[Step]) -> bool:
    """Whether a stroke was drawn whole, alone or at the head of a longer one."""
    return any(tuple(one.points[: len(path)]) == tuple(path) for one in drawn)


def strays(drawn: Sequence[Drawn], planned: Sequence[Drawn]) -> list[Drawn]:
    """Return what was drawn and is no planned stroke, nor the head of one; each counts once."""
    left, found = [one.points for one in planned], []
    for one in drawn:
        *head, last = one.points
        begun = (k for k, path in enumerate(left) if _is_head(head, last, path))
        place = next(begun, None)
        if place is None:
            found.append(one)
        else:
            left.pop(place)
    return found


def _is_head(head: list[Step], last: Step, path: Sequence[Step]) -> bool:
    """Whether a stroke is drawn along a path and ends on it; within a line it may be cut short."""
    count = len(head)
    if count >= len(path) or tuple(head) != tuple(path[:count]):
        return False
    if not count:
        return True
    (x, y), (u, v), (a, b) = head[-1], path[count], last
    off = abs((u - x) * (b - y) - (v - y) * (a - x)) / max(1.0, hypot(u - x, v - y))
    return off <= 1 and min(x, u) - 1 <= a <= max(x, u) + 1 and min(y, v) - 1 <= b <= max(y, v) + 1


def assert_cell(cell: Cell, found: Outcome) -> None:
    where = f"{cell}: {found.words}"
    assert found.end == fault_matrix.expected(cell), where
    assert found.words, where
    assert found.split == 0 or cell.fault in LINE, where
    assert found.overruns == 0, where
    if cell.fault not in LINE | STRAYS:
        assert not strays(found.drawn, found.planned), where
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


def test_a_line_from_elsewhere_a_second_stroke_and_a_longer_one_are_strays() -> None:
    planned = fault_matrix.planned("esc-b")
    first = planned[0]
    x, y = first.points[0]
    elsewhere = replace(first, points=((0, 0), *first.points[1:]))
    beyond = replace(first, points=(*first.points, (x, y)))
    aside = replace(first, points=((x, y), (x + 100, y + 100)))
    assert not strays(planned, planned)
    assert strays([elsewhere, *planned], planned) == [elsewhere]
    assert strays([*planned, first], planned) == [first]
    assert strays([beyond], planned) == [beyond]
    assert strays([aside], planned) == [aside]
    assert not strays([replace(first, points=((x, y), (x, y + 100)))], planned)


def test_every_fault_at_every_handshake_ends_as_its_cell_says(soak: Soak) -> None:
    cells = fault_matrix.cells()
    random.Random(SEED).shuffle(cells)
    count = soak.size(14, len(cells))
    with soak.part("fault-matrix", SEED, count, "cells") as progress:
        for number, cell in enumerate(cells[progress.before : count], progress.before + 1):
            assert_cell(cell, fault_matrix.run(cell))
            progress.reached(number)
