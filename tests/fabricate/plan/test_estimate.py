"""A plan's time is that of the simulated machine, on six jobs that differ in every way."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fabricate.verify import knife_job
from slit_forms import form
from stools import ONE_TOOL, PENS, machine, material, stool

from foldmill import Fold, installed
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.simulator.trial import clocked


def preset(family: str, name: str) -> Fold:
    design = installed().design(family)
    return design.run(design.preset(name))


JOBS: dict[str, tuple[str, Callable[[], Fold]]] = {
    "stool on a machine with one tool": (ONE_TOOL, stool),
    "stool on a machine that selects its tools": (PENS, stool),
    "square with four creases": (ONE_TOOL, knife_job.fold),
    "six-crease vase": (ONE_TOOL, lambda: preset("six-crease", "vase")),
    "bowl with a slit": (ONE_TOOL, lambda: form("bowl-n8", slit=True)),
    "waterbomb catenoid": (ONE_TOOL, lambda: preset("waterbomb", "catenoid-8x6")),
}


def simulated(plan: Plan, fold: Fold, used: Machine) -> tuple[float, float]:
    """Return seconds on the clock and seconds of motion for all programs, one after the other."""
    return clocked(hpgl.write(plan, fold).values(), used)


@pytest.mark.parametrize("name", JOBS)
def test_the_estimate_is_within_three_percent_of_the_simulators_clock(name: str) -> None:
    slug, made = JOBS[name]
    used = machine(slug)
    assert used.serial.baud == 9600
    plan = make(made(), material(), used)
    clock, moving = simulated(plan, made(), used)
    assert plan.figures.seconds == pytest.approx(clock, rel=0.02)
    assert plan.figures.seconds > moving


@pytest.mark.parametrize("used", [machine(), knife_job.knife()], ids=lambda each: each.slug)
def test_a_slow_line_is_counted_where_the_machine_waits_for_it(used: Machine) -> None:
    slow = used.model_copy(update={"serial": used.serial.model_copy(update={"baud": 2400})})
    plan = make(knife_job.fold(), material(), slow)
    clock, moving = simulated(plan, knife_job.fold(), slow)
    assert moving < 0.8 * clock
    assert plan.figures.seconds == pytest.approx(clock, rel=0.03)


def test_the_estimate_of_a_drag_knife_counts_its_swivels() -> None:
    used = knife_job.knife(0.9)
    plan, still = (make(knife_job.fold(), material(), each) for each in (used, machine()))
    clock, _ = simulated(plan, knife_job.fold(), used)
    assert plan.figures.seconds == pytest.approx(clock, rel=0.03)
    assert plan.figures.seconds > 1.05 * still.figures.seconds
