"""Where a machine stands after its host has gone: its place, and whether its tool is down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.link import clock_of
from foldmill_fabricate.plotter.program import XY
from foldmill_fabricate.plotter.session import PATIENCE, Session
from foldmill_fabricate.plotter.witness import position


@dataclass(frozen=True)
class Stand:
    """What a machine says of its tool."""

    at: XY
    """steps"""
    is_down: bool | None
    """None where it does not say."""


def stand(port: Any, machine: Machine, clock: Clock | None = None) -> Stand | None:
    """Have a machine drop what it holds, and say where its tool stands.

    None where it cannot drop a half-sent instruction, or does not answer: then nothing is sent.
    """
    if machine.serial.handshake != "esc-b" or not machine.serial.answers:
        return None
    session = Session(port, machine, clock or clock_of(port))
    session.open()
    session.write(b"OA;")
    answer = session.place(session.clock.now() + PATIENCE)
    at = position(answer) if answer else None
    if at is None or answer is None:
        return None
    pen = answer.split(",")[2:3]
    return Stand(at, {"0": False, "1": True}.get(pen[0].strip()) if pen else None)
