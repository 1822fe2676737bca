"""Led about by hand a machine keeps its tool up, stays within its limits, and goes in hops."""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import hypot
from pathlib import Path

import numpy as np
import pytest
from fabricate.bench import Bench, small_job, small_plan
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill_fabricate import jogging, shelf
from foldmill_fabricate.errors import CannotSend, DoesNotFit
from foldmill_fabricate.jogging import HOP, Jogger
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter import link
from foldmill_fabricate.verify.interpreter import interpret
from foldmill_fabricate.verify.pen_up import prove_pen_up
from foldmill_fabricate.verify.virtual_sheet import on_carrier

MACHINE = shelf.machine("generic-hpgl-600")


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench(small_plan())
    yield made
    made.leave()


def visited(bench: Bench) -> np.ndarray:
    """Every place it was sent to, mm, read by the interpreter that verification uses."""
    text = bytes(bench.simulator.device.traffic.program)
    places = re.findall(rb"P[UD](\d+),(\d+)", text)
    assert b"PD" not in text
    return on_carrier(np.array(places, float), MACHINE.axes)


def test_the_box_is_traced_with_the_tool_up_and_nothing_is_cut(
    bench: Bench, tmp_path: Path
) -> None:
    job = small_job(tmp_path)
    for face in Face:
        corners = jogging.box(job.plan, None, [face])
        assert job.proof is not None
        drawn = np.vstack([line.points for line in job.proof.lines if line.face is face])
        size = corners[2] - corners[0]
        assert np.allclose(size, np.ptp(drawn, axis=0), atol=0.05)
    with link.open_port(bench.url, MACHINE) as port:
        jogging.frame(Jogger(port, MACHINE), corners)
    places = visited(bench)
    for corner in corners:
        assert np.hypot(*(places - corner).T).min() < 0.03
    assert not bench.simulator.sheet.seen(Face.FRONT)
    assert np.hypot(*np.diff(places, axis=0).T).max() <= HOP + 0.05


@settings(max_examples=25)
@given(st.floats(-700, 700), st.floats(-3300, 3300))
def test_no_step_leads_beyond_the_limits(dx: float, dy: float) -> None:
    bench = Bench(small_plan())
    with link.open_port(bench.url, MACHINE) as port:
        jogger = Jogger(port, MACHINE)
        jogger.go((300.0, 400.0))
        sent = len(bench.simulator.device.traffic.program)
        inside = 10 <= 300 + dx <= 590 and 10 <= 400 + dy <= 2990
        in_range = (400 + dy) * 40 <= MACHINE.axes.highest
        try:
            jogger.by(dx, dy)
        except (CannotSend, DoesNotFit):
            assert not (inside and in_range)
            assert len(bench.simulator.device.traffic.program) == sent
        else:
            assert inside
            assert in_range
            x, y = jogger.ask()
            assert hypot(x - 300 - dx, y - 400 - dy) < 0.03
    bench.leave()


@pytest.mark.parametrize("step", [("nan", "5"), ("0", "inf"), ("-inf", "nan")])
def test_a_step_that_is_no_length_moves_nothing(bench: Bench, step: tuple[str, str]) -> None:
    with link.open_port(bench.url, MACHINE) as port:
        jogger = Jogger(port, MACHINE)
        jogger.go((300.0, 400.0))
        sent = len(bench.simulator.device.traffic.program)
        with pytest.raises(CannotSend, match="is no place; nothing moved"):
            jogger.by(float(step[0]), float(step[1]))
        assert len(bench.simulator.device.traffic.program) == sent


def test_a_machine_that_cannot_say_where_it_stands_is_not_jogged() -> None:
    plan = small_plan()
    serial = MACHINE.serial.model_copy(update={"answers": False, "handshake": "none"})
    blind = MACHINE.model_copy(update={"serial": serial})
    bench = Bench(plan.model_copy(update={"machine": blind}))
    with link.open_port(bench.url, blind) as port, pytest.raises(CannotSend, match="its own keys"):
        Jogger(port, blind).by(1.0, 1.0)
    assert not bench.simulator.device.traffic.received
    bench.leave()


@pytest.mark.parametrize("swap", [False, True])
def test_steps_and_millimetres_are_each_others_inverse(swap: bool) -> None:
    axes = MACHINE.axes.model_copy(
        update={"swap": swap, "scale_x": 1.003, "scale_y": 0.998, "skew": 0.4}
    )
    machine = MACHINE.model_copy(update={"axes": axes})
    data = jogging.move((123.0, 234.0), machine)
    (spot,) = interpret(data, selects=False).visited
    assert np.allclose(jogging.carrier((spot[0], spot[1]), machine), (123.0, 234.0), atol=0.02)
    assert np.allclose(on_carrier([spot], axes)[0], (123.0, 234.0), atol=0.02)


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"IN;DF;PA;\nPU400,400;PD800,400;PU;\n", "pen-down"),
        (b"IN;DF;PA;\nPU100,400;\n", "outside-bed"),
        (b"PA;\nPU-10,400;\n", "outside-range"),
        (b"IN;DF;PA;\nPU400,400;OA;\n", "unknown-instruction"),
    ],
)
def test_a_move_that_does_more_than_move_does_not_pass(data: bytes, code: str) -> None:
    assert code in {finding.code for finding in prove_pen_up(data, MACHINE)}
    assert not prove_pen_up(b"IN;DF;PA;\nPU400,400;\n", MACHINE)


def test_grbl_is_led_about_with_its_knife_up_and_says_where_it_stands() -> None:
    bench = Bench(small_plan("grbl-drag-knife"))
    knife = shelf.machine("grbl-drag-knife")
    with link.open_port(bench.url, knife) as port:
        jogger = Jogger(port, knife)
        jogger.go((100.0, 120.0))
        jogger.by(35.0, -10.0)
        assert np.allclose(jogger.ask(), (135.0, 110.0), atol=0.02)
        with pytest.raises(CannotSend, match="beyond what"):
            jogger.by(900.0, 0.0)
    assert b"?" in bench.simulator.device.traffic.received
    places = re.findall(rb"G0X([\d.]+)Y([\d.]+)", bytes(bench.simulator.device.traffic.program))
    way = np.array([(100.0, 120.0), *np.array(places, float)])
    assert np.hypot(*np.diff(way[-2:], axis=0).T).max() <= HOP + 0.05
    assert not bench.simulator.sheet.seen(Face.FRONT)
    bench.leave()


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"G21G90G94\nG0Z5\nG0X100Y100\nG1Z-1F300\nG1X120F600\nG0Z5\n", "pen-down"),
        (b"G21G90G94\nG0X100Y100\n", "low-travel"),
        (b"G21G90G94\nG0Z5\nG0X5000Y100\n", "outside-bed"),
    ],
)
def test_a_move_in_g_code_that_does_more_than_move_does_not_pass(data: bytes, code: str) -> None:
    knife = shelf.machine("grbl-drag-knife")
    assert code in {finding.code for finding in prove_pen_up(data, knife)}
    assert not prove_pen_up(jogging.move((100.0, 100.0), knife), knife)


def test_a_machine_of_a_language_without_places_is_not_led_about() -> None:
    silhouette = shelf.machine("silhouette-like")
    with pytest.raises(CannotSend, match="does not say where it stands"):
        jogging.move((100.0, 100.0), silhouette)
