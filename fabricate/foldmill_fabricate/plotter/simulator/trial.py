"""Trials: stream a program to a simulated machine and measure how the sender did."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.languages import made_ready, reserve
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import Delivery, as_sent, send
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.buffer import Traffic
from foldmill_fabricate.plotter.simulator.gauge import Use
from foldmill_fabricate.plotter.simulator.machine import Simulator

_PAIRS = 20
"""Coordinate pairs in one PD."""
_LIFT_EVERY = 10
"""PD instructions in one stroke."""
_LEFT, _RIGHT, _LOW = 2000, 18000, 2000
"""Steps between which the lines run, and where they begin."""


@dataclass(frozen=True)
class Trial:
    """What a delivery did, as the machine saw it."""

    delivery: Delivery
    traffic: Traffic
    use: Use
    expected: bytes
    """the program in the instructions that the machine can hold"""
    moving: float
    """s in which the machine moved"""

    @property
    def identical(self) -> bool:
        """Whether the machine got these bytes, and besides only the sender's questions."""
        return without_questions(bytes(self.traffic.program)) == self.expected


def without_questions(program: bytes) -> bytes:
    """Return a program without what the sender asks between strokes and at the end."""
    return program.replace(b"OA;OE;", b"")


def fine_lines(size: int, step: int, speed: int = 80) -> bytes:
    """Return a program of at least ``size`` bytes: saw-toothed lines of ``step`` steps a tooth.

    speed : VS, cm/s. Short teeth keep the line busy, long ones the motors.
    """
    lines = ["IN;DF;PA;", "SP1;", f"VS{speed};"]
    x, y, forward, written = _LEFT, _LOW, step, sum(map(len, lines))
    while written < size:
        lines.append(f"PU{x},{y};")
        for _ in range(_LIFT_EVERY):
            pairs = []
            for tooth in range(_PAIRS):
                forward = -forward if not _LEFT <= x + forward <= _RIGHT else forward
                x, y = x + forward, y + (step if tooth % 2 else -step)
                pairs.append(f"{x},{y}")
            lines.append(f"PD{','.join(pairs)};")
        y += 1
        written += sum(len(line) + 1 for line in lines[-_LIFT_EVERY - 1 :])
    return "".join(line + "\n" for line in [*lines, "PU;", "SP0;"]).encode()


def stream(
    program: bytes,
    machine: Machine,
    *,
    clock: Clock | None = None,
    speed_up: float = 1.0,
    sender: Callable[[bytes, Any, Machine], Delivery] = send,
) -> Trial:
    """Deliver a program over ``sim://`` and measure; raises what the sender raises."""
    url = devices.plug("trial", Simulator(machine, clock=clock, speed_up=speed_up))
    try:
        with open_port(url, machine) as port:
            expected, parts = as_sent(program, machine), made_ready(program, machine).parts
            simulator: Simulator = port.simulator
            motion = [(part.seconds, part.stroke) for part in parts]
            kept = reserve(machine.serial.buffer)
            gauge = simulator.watch([part.data for part in parts], kept, motion)
            delivery = sender(program, port, machine)
        device = simulator.device
        moving = device.carriage.tally.moving / speed_up
        return Trial(delivery, device.traffic, gauge.use, expected, moving)
    finally:
        devices.unplug(url)


def clocked(programs: Iterable[bytes], machine: Machine) -> tuple[float, float]:
    """Return seconds on the clock and seconds of motion for programs sent one after the other."""
    simulator = Simulator(machine)
    url = devices.plug("clocked", simulator)
    try:
        for program in programs:
            with open_port(url, machine) as port:
                send(program, port, machine)
                simulator.rest()
    finally:
        devices.unplug(url)
    return simulator.clock.now(), simulator.device.carriage.tally.moving
