"""A thousand sheets, turned over and measured: the reverse lands where the front is, or is refused.

Sheets, holes and marks are made by lot within what planning promises of them; the operator lays the
turned sheet somewhat askew and reads every mark with some error. Where the sheet really lies is
reckoned here in complex numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import hand_made
import numpy as np
import pytest
from fabricate.verify.test_register import made

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.marks import check_witness, fit_marks, targets, witness_middle
from foldmill_fabricate.passes import Face, Flip, Hole, Plan, Register, Role, Sheet, Stroke
from foldmill_fabricate.plan.registration import WITNESS
from foldmill_fabricate.sheet import seen_by_machine

COUNT = 1000
READ = 0.1
"""mm. How far off a mark is read at most."""
HALF_STEP = 0.5 / 40
KINDS = ("holes", "marks")


@dataclass(frozen=True)
class Case:
    """A sheet, how it came to lie, and what was read of it."""

    plan: Plan
    angle: float
    shift: complex
    noise: np.ndarray
    """(n,) complex, mm: error of reading of each mark."""
    shuffle: np.ndarray

    def lies(self, points: np.ndarray, turn: str = "right") -> np.ndarray:
        """Where sheet points (n, 2) really are on the carrier after a turn: complex, mm."""
        size = complex(self.plan.sheet.width, self.plan.sheet.height)
        z = points @ np.array([1, 1j])
        left_right = self.plan.flip.kind == "left-right"
        over = -z.conj() + size.real if left_right else z.conj() + 1j * size.imag
        z = {"right": over, "other": size - over, "not": z, "round": size - z}[turn]
        z = z + complex(self.plan.sheet.dx, self.plan.sheet.dy)
        found: np.ndarray = z * np.exp(1j * np.radians(self.angle)) + self.shift
        return found

    def read(self, turn: str = "right") -> list[tuple[float, float]]:
        """The marks as the operator reads them after a turn, in any order."""
        seen = (self.lies(targets(self.plan), turn) + self.noise)[self.shuffle]
        return [(float(z.real), float(z.imag)) for z in seen]

    def witness(self, turn: str) -> tuple[float, float]:
        middle = witness_middle(self.plan)
        assert middle is not None
        z = self.lies(middle.reshape(1, 2), turn)[0] + self.noise[0]
        return float(z.real), float(z.imag)


BASE = {"holes": made("holes"), "marks": made("l-marks")}


def plans(kind: str, lot: np.random.Generator) -> Plan:
    """A plan whose marks keep what planning promises; everything else of it is left alone."""
    w, h = lot.uniform(300, 560, 2)
    flip = "left-right" if lot.random() < 0.5 else "end-over-end"
    sheet = Sheet(
        width=w, height=h, carrier_width=600, carrier_height=600, dx=(600 - w) / 2, dy=(600 - h) / 2
    )
    turn = Flip(kind=flip, axis=(w if flip == "left-right" else h) / 2)  # type: ignore[arg-type]
    placed: dict[str, object] = {"sheet": sheet, "flip": turn}
    placed |= _holes(lot, w, h, flip) if kind == "holes" else _marks(lot, w, h)
    plan = BASE[kind].model_copy(update=placed)
    return _with_witness(plan, lot.uniform((12, h * 0.7), (w * 0.3, h - 14)))


def _holes(lot: np.random.Generator, w: float, h: float, flip: str) -> dict[str, object]:
    """Two pairs symmetric about the axis; both spacings and both distances from the other centre
    line differ by 20 mm at least.
    """
    across, along = (w, h) if flip == "left-right" else (h, w)
    reach = lot.uniform(90, across / 2 - 30)
    low, high = lot.uniform(80, along / 2 - 30, 2)
    if abs(low - high) < 20:
        high = low + 20
    spots = []
    for side in (-1, 1):
        spots.append((across / 2 + side * reach, along / 2 - low))
        spots.append((across / 2 + side * (reach + 20), along / 2 + high))
    if flip != "left-right":
        spots = [(y, x) for x, y in spots]
    return {"holes": tuple(Hole(x=x, y=y, diameter=5) for x, y in spots)}


def _marks(lot: np.random.Generator, w: float, h: float) -> dict[str, object]:
    """Corners of a rectangle whose opposite insets differ by 20 mm at least."""
    left, low = lot.uniform(10, 40, 2)
    right, high = left + lot.uniform(20, 40), low + lot.uniform(20, 40)
    if lot.random() < 0.5:
        left, right = right, left
    marks = tuple(
        mark.model_copy(
            update={
                "x": left if mark.across > 0 else w - right,
                "y": low if mark.upward > 0 else h - high,
            }
        )
        for mark in BASE["marks"].registration.marks
    )
    return {"registration": Register(kind="l-marks", marks=marks)}


def _with_witness(plan: Plan, at: np.ndarray) -> Plan:
    strokes = tuple(Stroke(points=tuple(map(tuple, line + at))) for line in WITNESS)
    passes = []
    for work in plan.passes:
        setups = tuple(
            setup.model_copy(
                update={
                    "operations": tuple(
                        op.model_copy(update={"strokes": strokes})
                        for op in setup.operations
                        if op.role is Role.WITNESS
                    )
                }
            )
            for setup in work.setups
        )
        passes.append(work.model_copy(update={"setups": setups}))
    return plan.model_copy(update={"passes": tuple(passes)})


def cases(kind: str, count: int = COUNT) -> Iterator[Case]:
    lot = np.random.default_rng(20261122)
    for _ in range(count):
        plan = plans(kind, lot)
        error = READ * np.sqrt(lot.random(4)) * np.exp(2j * np.pi * lot.random(4))
        yield Case(
            plan,
            float(lot.uniform(-0.3, 0.3)),
            complex(*lot.uniform(-3, 3, 2)),
            error,
            lot.permutation(4),
        )


def leverage(marks: np.ndarray, point: np.ndarray) -> np.ndarray:
    """How far errors of reading of at most 1 can move points (n,) that were fitted to marks (4,).

    The shift is the mean of the errors; the angle their moment over the marks' spread.
    """
    arms = np.abs(marks - marks.mean())
    bound: np.ndarray = 1 + np.abs(point - marks.mean()) * arms.sum() / (arms**2).sum()
    return bound


@pytest.mark.parametrize("kind", KINDS)
def test_the_reverse_lands_on_the_front_as_well_as_the_marks_were_read(kind: str) -> None:
    lot = np.random.default_rng(4)
    for case in cases(kind):
        plan, spots = case.plan, targets(case.plan)
        fit = fit_marks(plan, case.read())
        drawn = seen_by_machine(plan, Face.REVERSE, spots, fit.fit)
        drawn = hpgl.steps(drawn, plan.machine.axes, "here") / plan.machine.axes.units_per_mm
        read = case.lies(spots) + case.noise
        beside = np.abs(drawn @ np.array([1, 1j]) - read)
        assert beside.max() <= fit.residual + HALF_STEP * 2**0.5 + 1e-9
        part = lot.uniform((0, 0), (plan.sheet.width, plan.sheet.height), (12, 2))
        there = seen_by_machine(plan, Face.REVERSE, part, fit.fit) @ np.array([1, 1j])
        off = np.abs(there - case.lies(part))
        # a turn of the marks by their errors is small: 1 % covers what is not linear in it
        assert (off <= 1.01 * READ * leverage(spots @ [1, 1j], part @ [1, 1j])).all()
        assert fit.residual <= 2 * READ


WRONG = {
    "not": "not turned over: the front is still up",
    "other": "turned over the wrong way",
    "round": "not turned over but turned round",
}


@pytest.mark.parametrize("turn", WRONG)
@pytest.mark.parametrize("kind", KINDS)
def test_every_wrong_turn_is_told_by_its_name(kind: str, turn: str) -> None:
    """By the marks alone wherever they show it; of holes that look alike, by the witness mark.

    Sheets and marks are large enough that an error of reading is no error of scale.
    """
    for case in cases(kind):
        if kind == "marks":
            with pytest.raises(CannotSend, match=WRONG[turn]):
                fit_marks(case.plan, case.read(turn))
        elif turn != "not":  # then the holes lie where they should
            with pytest.raises(CannotSend, match=r"the wrong way|turned round"):
                fit_marks(case.plan, case.read(turn))
        with pytest.raises(CannotSend, match=WRONG[turn]):
            check_witness(case.plan, case.witness(turn))
        with pytest.raises(CannotSend, match=WRONG[turn]):
            fit_marks(case.plan, case.read(turn), case.witness(turn))


def test_the_witness_mark_of_a_sheet_that_was_turned_well_is_believed() -> None:
    for kind in KINDS:
        for case in cases(kind, 200):
            found = fit_marks(case.plan, case.read(), case.witness("right"))
            assert found == fit_marks(case.plan, case.read())


def test_holes_look_alike_on_a_sheet_that_was_not_turned_over() -> None:
    """Why the witness mark is there at all."""
    for case in cases("holes", 50):
        assert fit_marks(case.plan, case.read("not")).residual <= 2 * READ


def test_the_witness_of_a_planned_sheet_is_elsewhere_after_every_other_turn() -> None:
    for kind in ("holes", "edge", "pins", "l-marks"):
        for flip in ("left-right", "end-over-end"):
            plan = made(kind, flip)
            case = Case(plan, 0.0, 0j, np.zeros(4, complex), np.arange(4))
            seen = [complex(*case.witness(turn)) for turn in ("right", "not", "other", "round")]
            apart = np.abs(np.subtract.outer(seen, seen)) + 1e9 * np.eye(4)
            assert apart.min() > 36
            check_witness(plan, case.witness("right"))


def test_a_witness_mark_where_none_can_be_is_refused() -> None:
    with pytest.raises(CannotSend, match="cannot be at"):
        check_witness(made("holes"), (300.0, 300.0))
    bare = hand_made.plan().model_copy(update={"passes": ()})
    with pytest.raises(CannotSend, match="no witness mark"):
        check_witness(bare, (10.0, 10.0))
