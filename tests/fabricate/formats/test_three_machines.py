"""Plans for a GP-GL cutter, a GRBL knife and a GRBL laser: proved, and drawn by the machine."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import stools
from fabricate.verify import knife_job
from numpy.typing import NDArray

from foldmill_fabricate import folder
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.formats import gcode, gpgl, hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Fit, Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.sheet import seen_by_machine
from foldmill_fabricate.verify import verify, verify_folder
from foldmill_fabricate.verify.blade import tips
from foldmill_fabricate.writers import writer

SILHOUETTE, KNIFE, LASER = "silhouette-like", "grbl-drag-knife", "grbl-laser"
SLUGS = (SILHOUETTE, KNIFE, LASER)
BLANK = (260.0, 240.0)
Floats = NDArray[np.float64]


def machine(slug: str) -> Machine:
    return stools.machine(slug)


@cache
def planned(slug: str) -> Plan:
    return make(knife_job.fold(), stools.material(), machine(slug), blank=BLANK)


@cache
def programs(slug: str) -> dict[str, bytes]:
    found = writer(machine(slug))
    assert found is not None
    return dict(found.write(planned(slug), knife_job.fold()))


def lines(name: str, slug: str) -> list[bytes]:
    """Cut a program into what a sender sends one by one."""
    end = b"\x03" if slug == SILHOUETTE else b"\n"
    return [each + end for each in programs(slug)[name].split(end) if each]


def run_on(simulator: Simulator, name: str, slug: str) -> None:
    for line in lines(name, slug):
        simulator.write(line)
        simulator.clock.sleep(600)
        simulator.advance()
    simulator.rest()
    said = simulator.read()
    assert b"error" not in said
    assert b"ALARM" not in said


def strokes_of(plan: Plan, numbers: tuple[int, ...]) -> list[Floats]:
    """Return where the tip must go, mm on the carrier: once along each stroke."""
    found = []
    for work in plan.passes:
        for setup in work.setups:
            for operation in setup.operations if setup.number in numbers else ():
                for stroke in operation.strokes:
                    seen = seen_by_machine(plan, work.face, stroke.points)
                    found.append(seen if stroke.closed else seen[:2])
    return found


def gap(points: Floats, way: Floats) -> float:
    """Return how far points are from a way at the most."""
    starts, arms = way[:-1], np.diff(way, axis=0)
    lengths = np.maximum((arms**2).sum(axis=1), 1e-12)
    share = np.einsum("pwk,wk->pw", points[:, None] - starts, arms) / lengths
    feet = starts + np.clip(share, 0, 1)[:, :, None] * arms
    return float(np.hypot(*np.moveaxis(feet - points[:, None], 2, 0)).min(axis=1).max())


@pytest.mark.parametrize("slug", SLUGS)
def test_both_proofs_hold(slug: str) -> None:
    result = verify(planned(slug), knife_job.fold().pattern, programs(slug))
    assert not result.findings
    assert result.figures.strokes


@pytest.mark.parametrize("slug", SLUGS)
def test_the_simulated_machine_draws_the_plan(slug: str) -> None:
    plan, axes = planned(slug), machine(slug).axes
    for part in hpgl.layout(plan):
        simulator = Simulator(machine(slug))
        run_on(simulator, part.name, slug)
        drawn = simulator.sheet.strokes[Face.FRONT]
        ways = [stroke.millimetres(plan.machine.axes) for stroke in drawn]
        offset = plan.machine.tools.host_offset
        if offset:
            ways = tips(ways, offset)[1:]  # a lead-in comes first
        wanted = strokes_of(plan, part.setups)
        assert len(ways) == len(wanted)
        near = 1 / axes.units_per_mm + (0.02 if offset else 0.0)
        for way, stroke in zip(ways, wanted, strict=True):
            assert gap(stroke, way) <= near


@pytest.mark.parametrize("slug", SLUGS)
def test_every_stroke_has_its_repeats_and_its_settings(slug: str) -> None:
    plan = planned(slug)
    setups = {setup.number: setup for work in plan.passes for setup in work.setups}
    for part in hpgl.layout(plan):
        simulator = Simulator(machine(slug))
        run_on(simulator, part.name, slug)
        drawn = iter(simulator.sheet.strokes[Face.FRONT])
        for setup in (setups[number] for number in part.setups):
            if setup.lead_in:
                next(drawn)
            for operation in setup.operations:
                for stroke in operation.strokes:
                    made = next(drawn)
                    is_score = setup.process == "score"
                    if slug == SILHOUETTE:
                        assert made.force == round(min(210, setup.force) / 6.4) * 6.4
                        assert (made.tool, made.speed) == (1, 100.0)
                    elif slug == KNIFE:
                        assert made.setting == ("Z-0.4" if is_score else "Z-0.95")
                    else:
                        assert made.setting == "S1000"
                    if not machine(slug).tools.host_offset:
                        length = np.hypot(*np.diff(stroke.points, axis=0).T).sum()
                        way = np.array(made.points) / machine(slug).axes.units_per_mm
                        repeats = operation.repeats * length + stroke.closed * operation.overcut
                        assert np.hypot(*np.diff(way, axis=0).T).sum() == pytest.approx(
                            repeats, abs=0.1 * operation.repeats * len(stroke.points)
                        )
        assert next(drawn, None) is None


def test_a_silhouette_counts_along_the_feed_first_from_the_upper_edge() -> None:
    """What is lowest on the sheet is farthest along the feed, and nothing is mirrored."""
    (file, *_) = [name for name in programs(SILHOUETTE) if "front-score" in name]
    numbers = re.findall(rb"[MD]([\d,]+)", programs(SILHOUETTE)[file])
    steps = np.array([int(n) for word in numbers for n in word.split(b",")]).reshape(-1, 2)
    plan = planned(SILHOUETTE)
    strokes = np.vstack(strokes_of(plan, (next(p for p in hpgl.layout(plan)).setups)))
    x, y = strokes.T
    height = plan.sheet.carrier_height
    assert steps[:, 1].min() / 20 == pytest.approx(x.min(), abs=0.03)
    assert steps[:, 0].min() / 20 == pytest.approx(height - y.max(), abs=0.03)
    assert steps[:, 0].max() / 20 == pytest.approx(height - y.min(), abs=0.03)


def test_a_carrier_of_another_height_is_counted_from_its_own_upper_edge() -> None:
    plan = make(
        knife_job.fold(), stools.material(), machine(SILHOUETTE), blank=BLANK, carrier=(300, 280)
    )
    assert plan.machine.axes.top == 280
    assert verify(plan, knife_job.fold().pattern, gpgl.write(plan, knife_job.fold())).ok


def test_a_knife_is_up_before_every_travel_and_a_beam_off() -> None:
    for slug, off in ((KNIFE, "G0Z5"), (LASER, "M5")):
        for program in programs(slug).values():
            said = program.decode().splitlines()
            travels = [k for k, line in enumerate(said) if line.startswith("G0X")]
            assert travels
            assert all(said[k - 1] == off or said[k - 1].startswith("T") for k in travels)
            assert said[-2:] == [off, "M2"]
            assert max(len(line) for line in said) <= 80


def test_a_laser_scores_with_m4_and_cuts_through_with_m3() -> None:
    text = b"".join(programs(LASER).values()).decode()
    assert text.index("M4S1000") < text.index("M3S1000")
    assert text.rindex("M4S1000") < text.index("M3S1000")


@pytest.mark.parametrize("slug", SLUGS)
def test_a_reverse_is_fitted_to_its_marks(slug: str) -> None:
    plan, fit = planned(slug).model_copy(update={"programs": ()}), Fit(angle=0.1, dx=0.4, dy=-0.3)
    offered = writer(plan.machine)
    assert offered is not None
    assert offered.program is not None
    again = {part.name: offered.program(plan, part.setups, fit) for part in hpgl.layout(plan)}
    assert verify(plan, knife_job.fold().pattern, again, fit).ok
    assert not verify(plan, knife_job.fold().pattern, again).ok


@pytest.mark.parametrize("slug", SLUGS)
def test_a_job_folder_holds_its_programs_and_verifies(slug: str, tmp_path: Path) -> None:
    plan = folder.write(knife_job.fold(), planned(slug), tmp_path, [machine(slug).language])
    assert [each.name for each in plan.programs] == list(programs(slug))
    assert verify_folder(tmp_path).ok
    first = tmp_path / plan.programs[0].name
    first.write_bytes(first.read_bytes().replace(b"5", b"6", 1))
    assert not verify_folder(tmp_path).ok


def test_a_program_for_another_machine_is_refused() -> None:
    with pytest.raises(CannotPlan, match="speaks gcode"):
        gpgl.write(planned(KNIFE), knife_job.fold())
    with pytest.raises(CannotPlan, match="speaks gp-gl"):
        gcode.write(planned(SILHOUETTE), knife_job.fold())


def test_what_the_firmware_does_not_take_is_refused_with_the_missing_mm() -> None:
    plan = planned(KNIFE)
    axes = plan.machine.axes.model_copy(update={"highest": 8000})
    small = plan.model_copy(update={"machine": plan.machine.model_copy(update={"axes": axes})})
    with pytest.raises(DoesNotFit, match="mm out of the range"):
        gcode.write(small, knife_job.fold())


@pytest.mark.parametrize(
    ("value", "decimals", "said"),
    [
        (0.0, 4, "0"),
        (-0.00001, 4, "0"),
        (12.5, 4, "12.5"),
        (100.0, 3, "100"),
        (1.0125, 4, "1.0125"),
    ],
)
def test_coordinates_are_written_as_short_as_they_can_be(
    value: float, decimals: int, said: str
) -> None:
    assert gcode.number(value, decimals) == said
