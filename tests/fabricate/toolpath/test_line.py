"""A machine waits for its serial line where its strokes are small, and only there."""

from __future__ import annotations

import numpy as np
import pytest
import stools

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.toolpath.line import OPENING, waiting

Floats = np.ndarray


def machine(baud: int = 9600, buffer: int = 1024) -> Machine:
    base = stools.machine()
    serial = base.serial.model_copy(update={"baud": baud, "buffer": buffer})
    return base.model_copy(update={"serial": serial})


def saw(teeth: int, height: float) -> Floats:
    return np.array([[0.2 * k, height * (k % 2)] for k in range(teeth)]) + 10


def lines(count: int) -> list[Floats]:
    return [np.array([[10.0, 5.0 + k], [210.0, 5.0 + k]]) for k in range(count)]


def test_long_lines_are_told_while_others_are_drawn() -> None:
    times = np.tile([0.5, 2.0], (30, 1))
    first = (len("PU400,200;") + len("PD8400,200;")) * 10 / 9600
    waits = waiting(lines(30), times, machine()) - OPENING * 10 / 9600
    assert 0 < waits <= first


def test_a_machine_that_needs_no_time_itself_takes_as_long_as_its_bytes() -> None:
    path = saw(400, 0.5)
    steps = np.round(path * 40).astype(int).tolist()
    pairs = [f"{x},{y}" for x, y in steps]
    limit = stools.machine().dialect.max_instruction
    text, part = f"PU{pairs[0]};", ""
    for pair in pairs[1:]:
        if part and len(part) + len(pair) + 4 > limit:
            text, part = f"{text}PD{part};", ""
        part = f"{part},{pair}" if part else pair
    text += f"PD{part};"
    waits = waiting([path], np.zeros((1, 2)), machine()) - OPENING * 10 / 9600
    assert waits == pytest.approx(len(text) * 10 / 9600, rel=0.02)


@pytest.mark.parametrize("seed", range(5))
def test_a_slower_line_or_a_smaller_buffer_never_saves_time(seed: int) -> None:
    rng = np.random.default_rng(seed)
    paths = [saw(int(rng.integers(2, 300)), 1.0) + rng.uniform(0, 90, 2) for _ in range(12)]
    times = rng.uniform(0, 3, (12, 2))
    by_rate = [waiting(paths, times, machine(baud)) for baud in (19200, 9600, 4800, 1200)]
    by_room = [waiting(paths, times, machine(buffer=size)) for size in (65536, 4096, 1024, 600)]
    assert by_rate == sorted(by_rate)
    assert by_room == pytest.approx(sorted(by_room))


def test_a_program_without_strokes_waits_only_for_its_opening() -> None:
    assert waiting([], np.zeros((0, 2)), machine()) == pytest.approx(OPENING * 10 / 9600)
