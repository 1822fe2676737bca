"""What the job sheet and the prompts say about keeping the faces in register."""

from __future__ import annotations

import pytest
from fabricate.verify.test_register import made

from foldmill_fabricate.gates import Request
from foldmill_fabricate.instructions import instruction
from foldmill_fabricate.jobsheet import register
from foldmill_fabricate.passes import Face, Gate, Plan


def setup_of(plan: Plan, face: Face) -> str:
    """What the operator is told when the sheet is laid with this face up."""
    work = next(each for each in plan.passes if each.face is face)
    gate = Gate.LOAD if face is Face.FRONT else Gate.FLIP
    return instruction(Request(gate, face, work.setups[0], plan, "K7QF"))


def test_stops_are_named_for_both_passes_in_one_row_each() -> None:
    plan = made("edge")
    head, *rows = register.table(plan)
    assert len(head) == 4
    assert [row[1] for row in rows] == ["bottom", "bottom", "left, then right"]
    sheet = plan.sheet
    assert rows[2][2] == f"{sheet.dx:.1f}, {sheet.dy + sheet.height / 2:.1f}"
    assert rows[2][3] == f"{sheet.dx + sheet.width:.1f}, {sheet.dy + sheet.height / 2:.1f}"
    assert "left edge goes to the right" in register.sentences(plan)[0]
    assert "bottom edge goes to the top" in register.sentences(made("edge", "end-over-end"))[0]


def test_pins_stand_where_the_turned_sheets_holes_are() -> None:
    plan = made("pins")
    rows = register.table(plan)[1:]
    assert {row[2] for row in rows} == {f"{x:.2f}, {y:.2f}" for x, y in plan.registration.pins}
    assert "160 mm apart" in register.heading(plan)


def test_a_sensors_marks_are_told_with_the_distances_it_asks_for() -> None:
    plan = made("three")
    names = [row[0] for row in register.table(plan)[1:]]
    assert sorted(names) == ["1 L", "2 square", "3 L"]
    xs, ys = zip(*((mark.x, mark.y) for mark in plan.registration.marks), strict=True)
    said = register.sentences(plan)[0]
    assert f"{max(xs) - min(xs):g} mm apart across" in said
    assert f"{max(ys) - min(ys):g} mm along" in said
    assert "dark tape" in said


@pytest.mark.parametrize(
    ("kind", "front", "reverse"),
    [
        ("edge", "left (", "right ("),
        ("pins", "", "Press it down over the pins"),
        ("l-marks", "", "let the machine search"),
        ("holes", "", ""),
    ],
)
def test_the_prompt_says_what_to_lay_the_sheet_against(kind: str, front: str, reverse: str) -> None:
    plan = made(kind)
    assert front in setup_of(plan, Face.FRONT)
    assert reverse in setup_of(plan, Face.REVERSE)
    assert "pins" not in setup_of(plan, Face.FRONT)


def test_the_budgets_row_holds_every_share_and_both_sums() -> None:
    plan = made("holes")
    assert plan.budget is not None
    names, errors = register.budget_table(plan.budget)
    assert len(names) == len(errors) == len(plan.budget.shares) + 3
    assert errors[-3] == f"± {plan.budget.likely:.2f}"
    assert "4 holes are measured to 0.2 mm each" in register.budget_words(plan.budget)
