"""A machine whose operator always lays the flipped sheet a little off, and knows by how much."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import hand_made
import numpy as np
import pytest
from fabricate.verify import square_job
from hypothesis import given
from hypothesis import strategies as st

from foldmill import Fold
from foldmill_fabricate import folder
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine, TwoSides
from foldmill_fabricate.marks import fit_marks
from foldmill_fabricate.operators import SimulatedOperator
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.sending import open_job
from foldmill_fabricate.sheet import NOMINAL, seen_by_machine
from foldmill_fabricate.verify import verify
from foldmill_fabricate.verify.virtual_sheet import on_sheet, to_carrier

OFF = {"dx": 0.35, "dy": -0.2, "angle": 0.05}
BLANK = (200.0, 180.0)
offsets: st.SearchStrategy[dict[str, float]] = st.builds(
    dict, dx=st.floats(-2, 2), dy=st.floats(-2, 2), angle=st.floats(-1, 1)
)
flips = st.sampled_from(["left-right", "end-over-end"])


def with_offset(machine: Machine, **off: object) -> Machine:
    return machine.model_copy(update={"two_sides": TwoSides.model_validate(off)})


@cache
def made(flip: str = "left-right", **off: object) -> Plan:
    machine = with_offset(hand_made.machine(), **off)
    fold: Fold = hand_made.fold()
    return make(fold, hand_made.material(), machine, blank=BLANK, flip=flip)  # type: ignore[arg-type]


@given(offsets, flips, st.sampled_from(list(Face)))
def test_writer_and_proof_find_the_flipped_sheet_at_the_same_place(
    off: dict[str, float], flip: str, face: Face
) -> None:
    plan = square_job.plan(
        with_offset(square_job.machine(square_job.ONE_TOOL), flip=flip, **off), flip
    )
    spots = np.random.default_rng(3).uniform(0, 240, (20, 2))
    there = seen_by_machine(plan, face, spots)
    assert there == pytest.approx(to_carrier(spots, plan, face, None), abs=1e-9)
    assert on_sheet(there, plan, face, None) == pytest.approx(spots, abs=1e-9)


def as_laid(plan: Plan, steps: np.ndarray, off: dict[str, float]) -> np.ndarray:
    """Where on the sheet lines land that this operator's machine draws: in complex numbers.

    The sheet's lower left corner, as it lies face down, is off by (dx, dy) and the sheet turned
    about it.
    """
    z = (steps @ np.array([1, 1j])) / plan.machine.axes.units_per_mm
    z = z - complex(plan.sheet.dx, plan.sheet.dy) - complex(off["dx"], off["dy"])
    z = z * np.exp(-1j * np.radians(off["angle"]))
    return np.stack([BLANK[0] - z.real, z.imag], axis=-1)


def largest_miss(plan: Plan, path: Path, off: dict[str, float]) -> float:
    """How far the reverse lands from the plan, mm, where the sheet is laid off after the flip."""
    folder.write(hand_made.fold(), plan, path, ["hpgl"])
    url = devices.plug(f"laid-off-{path.name}", Simulator(plan.machine))
    try:
        sent = list(send_job(open_job(path), url, SimulatedOperator(url)))
        drawn = devices.behind(url).sheet.strokes[Face.REVERSE]
    finally:
        devices.unplug(url)
    assert [each.delivery.status for each in sent] == ["executed"] * 4
    lands = np.vstack([as_laid(plan, np.array(stroke.points, float), off) for stroke in drawn])
    ends = np.array(
        [
            p
            for s in plan.passes[1].setups
            for o in s.operations
            for k in o.strokes
            for p in k.points
        ]
    )
    return float(np.hypot(*(ends[:, None] - lands[None]).transpose(2, 0, 1)).min(axis=1).max())


def test_with_the_stored_offset_the_reverse_lands_within_a_step(tmp_path: Path) -> None:
    assert largest_miss(made(**OFF), tmp_path / "stored", OFF) < 0.025
    assert largest_miss(made(), tmp_path / "unknown", OFF) > 0.3


def test_the_front_is_drawn_as_ever() -> None:
    plain, stored = made(), made(**OFF)
    before, after = (hpgl.write(plan, hand_made.fold()) for plan in (plain, stored))
    assert plain.passes == stored.passes
    same = {name for name in before if before[name] == after[name]}
    assert same == {name for name in before if "front" in name}


def test_no_offset_leaves_every_byte_as_it_was() -> None:
    fold = hand_made.fold()
    assert hpgl.write(made(dx=0.0, measured="2026-11-22"), fold) == hpgl.write(made(), fold)


def test_a_reverse_written_without_the_stored_offset_is_named() -> None:
    fold, plan = hand_made.fold(), made(**OFF)
    assert verify(plan, fold.pattern, hpgl.write(plan, fold)).ok
    found = verify(plan, fold.pattern, hpgl.write(made(), fold))
    assert {finding.code for finding in found.findings} == {"two-sides"}


def test_an_offset_of_the_other_flip_is_not_made_up_for_and_planning_says_so() -> None:
    fold, plan = hand_made.fold(), made("end-over-end", **OFF)
    assert hpgl.write(plan, fold) == hpgl.write(made("end-over-end"), fold)
    assert verify(plan, fold.pattern, hpgl.write(plan, fold)).ok
    assert "two-sides" in {finding.code for finding in plan.findings}
    assert "two-sides" not in {finding.code for finding in made(**OFF).findings}


def test_where_only_drawings_are_made_planning_says_what_to_shift_by_hand() -> None:
    own = hand_made.machine("silhouette-like").model_copy(update={"language": "dmpl"})
    machine = with_offset(own, **OFF)  # a language that nobody writes
    plan = make(hand_made.fold(), hand_made.material(), machine, blank=BLANK)
    [told] = [str(each) for each in plan.findings if each.code == "two-sides"]
    assert "+0.35, -0.20 mm and +0.050°" in told
    assert "machine's own software" in told


def test_a_sensor_that_finds_the_sheet_needs_no_stored_offset() -> None:
    fold = hand_made.fold()
    plain = hand_made.machine("graphtec-summa-like")
    written = [
        hpgl.write(make(fold, hand_made.material(), machine, blank=BLANK, register="l-marks"), fold)
        for machine in (plain, with_offset(plain, **OFF))
    ]
    assert written[0] == written[1]


@given(offsets)
def test_measured_marks_stand_in_place_of_the_stored_offset(off: dict[str, float]) -> None:
    """The same sheet measured on two machines, of which one knows its offset: the same reverse."""
    plain, stored = (
        made(),
        made().model_copy(update={"machine": with_offset(hand_made.machine(), **OFF)}),
    )
    holes = [(hole.x, hole.y) for hole in plain.holes]
    lies = seen_by_machine(plain, Face.REVERSE, holes, NOMINAL)
    seen = [(float(x) + off["dx"], float(y) + off["dy"]) for x, y in lies]
    fits = [fit_marks(plan, seen).fit for plan in (plain, stored)]
    assert fits[0] == fits[1]
    programs = [hpgl.program(plan, (3,), fits[0]) for plan in (plain, stored)]
    assert programs[0] == programs[1]
