"""A simulated machine that is off, as real ones are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command import Run

from foldmill.errors import InvalidInput
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.drawing import Imperfection
from foldmill_fabricate.plotter.simulator.machine import Simulator

PROGRAM = b"IN;DF;PA;SP1;PU4000,8000;PD20000,8000;PU4000,8000;PD4000,16000;PU;SP0;"


def drawn(machine: Machine, off: Imperfection, face: Face) -> list[np.ndarray]:
    simulator = Simulator(machine, imperfection=off)
    if face is Face.REVERSE:
        simulator.flip()
    simulator.write(PROGRAM)
    simulator.rest()
    return [line.millimetres(machine.axes) for line in simulator.sheet.strokes[face]]


def test_a_machine_that_draws_too_long_does_so_from_its_corner(
    machine: Callable[..., Machine],
) -> None:
    level, upright = drawn(machine(), Imperfection(scale_x=1.003, scale_y=0.99), Face.FRONT)
    assert level == pytest.approx(np.array([[100.3, 198.0], [501.5, 198.0]]))
    assert upright == pytest.approx(np.array([[100.3, 198.0], [100.3, 396.0]]))


def test_a_line_along_y_leans_to_the_right(machine: Callable[..., Machine]) -> None:
    _, upright = drawn(machine(), Imperfection(skew=0.1), Face.FRONT)
    lean = np.degrees(np.arctan2(*(upright[1] - upright[0])))
    assert lean == pytest.approx(0.1)


def test_a_flipped_sheet_that_lies_to_the_right_gets_its_lines_to_the_left(
    machine: Callable[..., Machine],
) -> None:
    off = Imperfection(flip_dx=0.35, flip_dy=-0.2)
    front, reverse = (drawn(machine(), off, face)[0] for face in Face)
    assert front == pytest.approx(np.array([[100, 200], [500, 200]]))
    assert reverse == pytest.approx(np.array([[99.65, 200.2], [499.65, 200.2]]))


def test_what_is_off_is_named_in_the_address() -> None:
    options = {"scale_x": "1.003", "flip_dx": "0.35"}
    simulator = devices.made("generic-hpgl-600", options)
    assert simulator.imperfection == Imperfection(scale_x=1.003, flip_dx=0.35)
    simulator.new_sheet()
    assert simulator.sheet.imperfection == simulator.imperfection
    for wrong in ({"scale_x": "3"}, {"flip_dx": "far"}, {"skew": "nan"}):
        with pytest.raises(InvalidInput, match="write a number from"):
            devices.made("generic-hpgl-600", wrong)


def test_the_command_refuses_what_no_machine_is(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    foldmill = Run(capsys, monkeypatch)
    link = str(tmp_path / "plotter")
    told = foldmill("simulate", "--pty", link, "--imperfect", "scale_x=1.003,lean=2")
    assert told.code == 2
    assert "no option 'lean'" in told.err
