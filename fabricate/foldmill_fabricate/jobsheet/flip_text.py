"""How the sheet is turned over, drawn with characters for a terminal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Plan, Role
from foldmill_fabricate.sheet import flipped, strokes

Floats = NDArray[np.float64]

WIDE, HIGH = 25, 11
"""Characters that the longer side of a sheet takes across, and down."""
BETWEEN = {"left-right": "  turn over ==>  ", "end-over-end": "  top edge down  "}


def flip_text(plan: Plan, sheet: str = "") -> str:
    """Return the sheet before and after the flip, side by side: holes, witness mark and id.

    ``o`` is a hole, ``F`` the witness mark on top, ``(F)`` the same underneath.
    """
    before, after = _face(plan, sheet, after=False), _face(plan, sheet, after=True)
    middle = len(before) // 2
    gap = BETWEEN[plan.flip.kind]
    heads = ["FRONT up".center(len(before[0])), "REVERSE up".center(len(before[0]))]
    lines = [heads[0] + " " * len(gap) + heads[1]]
    for k, (one, other) in enumerate(zip(before, after, strict=True)):
        lines.append(one + (gap if k == middle else " " * len(gap)) + other)
    return "\n".join(line.rstrip() for line in lines)


def _face(plan: Plan, sheet: str, *, after: bool) -> list[str]:
    """Return one face in a frame, as it lies on the machine."""
    span = max(plan.sheet.width, plan.sheet.height)
    wide = max(13, round(WIDE * plan.sheet.width / span))
    high = max(7, round(HIGH * plan.sheet.height / span))
    rows = [[" "] * wide for _ in range(high)]
    _write(rows, high // 2, wide // 2, sheet)
    spots = np.array([(hole.x, hole.y) for hole in plan.holes], float).reshape(-1, 2)
    for spot in spots:
        _write(rows, *_cell(plan, spot, wide, high, after=after), "o")
    marks = strokes(plan, Role.WITNESS)
    if marks:
        every = np.vstack(marks)
        middle = (every.min(axis=0) + every.max(axis=0)) / 2
        row, column = _cell(plan, middle, wide, high, after=after)
        row += 1 if row < high // 2 and rows[row][column] == "o" else 0
        _write(rows, row, column, "(F)" if after else "F")
    edge = "+" + "-" * wide + "+"
    return [edge, *("|" + "".join(row) + "|" for row in rows), edge]


def _cell(plan: Plan, spot: Floats, wide: int, high: int, *, after: bool) -> tuple[int, int]:
    """Return row and column of a place on the sheet (2,), mm; the first row is at the top."""
    x, y = flipped([spot], plan.flip)[0] if after else spot
    column = min(wide - 1, max(0, int(wide * x / plan.sheet.width)))
    row = min(high - 1, max(0, int(high * (1 - y / plan.sheet.height))))
    return row, column


def _write(rows: list[list[str]], row: int, column: int, words: str) -> None:
    """Write words about a place, within the frame."""
    first = min(max(0, column - (len(words) - 1) // 2), len(rows[row]) - len(words))
    for k, letter in enumerate(words):
        rows[row][first + k] = letter
