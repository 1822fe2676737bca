"""How long a machine waits for its serial line.

An instruction is executed when all of it has arrived and the one before has ended; it is sent when
the one before is on its way and there is room for it. Room is what the buffer has beyond its
reserve, and an instruction leaves it when its execution begins. So a machine that draws long lines
never waits, and one that draws small arcs goes as fast as its line.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.sheet import in_steps

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BITS = 10
"""Per byte on the line: a start bit, eight of data, a stop bit."""
LEAST_RESERVE = 128
"""Bytes of the buffer that are never filled, or a quarter of it."""
QUESTION = 3
"""Bytes of what is asked between strokes."""
ASKED_EVERY = 0.5
"""s of motion between two such questions, at least."""
OPENING = 110
"""Bytes that go to and fro before and after a program: what the machine is asked, and answers."""


def waiting(paths: Sequence[Floats], times: Floats, machine: Machine) -> float:
    """Return for how long a machine stands still in a program because its line is slow, s.

    paths : ways of the tool (n, 2) mm; times : (paths, 2) s, of the way to the start of each and
    along each.
    """
    byte_time = BITS / machine.serial.baud
    sizes, seconds = _instructions(paths, times, machine)
    buffer = machine.serial.buffer
    room = buffer - min(LEAST_RESERVE, buffer // 4)
    ended = _fed((sizes * byte_time).tolist(), seconds.tolist(), room * byte_time)
    return ended - float(seconds.sum()) + OPENING * byte_time


def _fed(line: list[float], seconds: list[float], room: float) -> float:
    """Return when the last instruction ends, s from the first byte; all three in s."""
    begun: list[float] = []
    arrived = ended = within = 0.0
    first = 0
    for on_line, lasts in zip(line, seconds, strict=True):
        sent = arrived
        within += on_line
        while within > room and first < len(begun):
            within -= line[first]
            sent = max(sent, begun[first])
            first += 1
        arrived = sent + on_line
        begun.append(max(ended, arrived))
        ended = begun[-1] + lasts
    return ended


def _asked(seconds: list[float]) -> Floats:
    """Return the bytes (n,) of what is asked before each path, by the time that went by."""
    asked, since = np.zeros(len(seconds)), 0.0
    for k, lasts in enumerate(seconds):
        if k and (since >= ASKED_EVERY or since + lasts > 3 * ASKED_EVERY):
            asked[k], since = QUESTION, 0.0
        since += lasts
    return asked


def _instructions(
    paths: Sequence[Floats], times: Floats, machine: Machine
) -> tuple[Floats, Floats]:
    """Return size in bytes and duration in s of every PU and PD, in order."""
    steps = np.round(in_steps(np.vstack([np.zeros((0, 2)), *paths]), machine.axes))
    digits: Floats = np.floor(np.log10(np.maximum(np.abs(steps), 1.0))) + 1 + (steps < 0)
    owner = np.repeat(np.arange(len(paths)), [len(path) for path in paths])
    first = np.append(True, owner[1:] != owner[:-1]) if len(owner) else np.zeros(0, bool)
    gone = np.hypot(*np.diff(steps, axis=0, prepend=steps[:1]).T)
    gone[first] = 0.0
    size = digits.sum(axis=1) + 2
    size[first] += 2 + (_asked(times.sum(axis=1).tolist()) if machine.serial.answers else 0.0)
    # PU and a semicolon; a PD's own are counted with each part
    size[~first & (gone == 0)] = 0.0  # a step that is no step is not told
    down = np.where(first, 0.0, size)
    reached = np.cumsum(down) - np.cumsum(down)[first][np.cumsum(first) - 1]
    limit = machine.dialect.max_instruction - len(machine.dialect.line_end) - 3
    part = np.where(first, -1, (np.maximum(reached - 1, 0) // limit)).astype(np.intp)
    new = np.append(True, (owner[1:] != owner[:-1]) | (part[1:] != part[:-1]))[: len(owner)]
    number = np.cumsum(new) - 1
    heads = np.where(part[new] >= 0, 2.0, 0.0) + len(machine.dialect.line_end)
    sizes = np.bincount(number, size) + heads
    lengths = np.bincount(number, gone)
    whole = np.bincount(owner, gone, minlength=len(paths))
    share = lengths / np.maximum(whole, 1e-12)[owner[new]]
    seconds = np.where(part[new] < 0, times[owner[new], 0], share * times[owner[new], 1])
    return sizes, seconds
