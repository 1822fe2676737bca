"""Where a machine stands after its host has gone: its place, and whether its tool is down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.handshakes.grbl import GrblSession
from foldmill_fabricate.plotter.handshakes.hp import HpSession
from foldmill_fabricate.plotter.link import clock_of
from foldmill_fabricate.plotter.program import XY
from foldmill_fabricate.plotter.session import PATIENCE
from foldmill_fabricate.plotter.witness import QUESTION, position


@dataclass(frozen=True)
class Stand:
    """What a machine says of its tool."""

    at: XY
    """steps"""
    is_down: bool | None
    """None where it does not say."""


def stand(port: Any, machine: Machine, clock: Clock | None = None) -> Stand | None:
    """Have a machine drop what it holds, say where its tool stands, and lift it.

    None where it cannot drop a half-sent instruction, or does not answer: then nothing is sent.
    GRBL must be idle, and is not lifted: its programs do that before they travel.
    """
    if machine.serial.handshake == "grbl":
        return _of_grbl(GrblSession(port, machine, clock or clock_of(port)))
    if machine.serial.handshake != "esc-b" or not machine.serial.answers:
        return None
    session = HpSession(port, machine, clock or clock_of(port))
    session.open()
    session.write(QUESTION)
    proof = session.proof(session.line_free + PATIENCE + machine.motion.tool_time)
    answer = proof[0] if proof else ""
    session.write(b"PU;")  # the stop's own may have been dropped
    at = position(answer)
    if at is None:
        return None
    pen = answer.split(",")[2:3]
    return Stand(at, {"0": False, "1": True}.get(pen[0].strip()) if pen else None)


def _of_grbl(session: GrblSession) -> Stand | None:
    """Ask GRBL; raises NoAnswer, and PlotterError where it is not idle."""
    session.open()
    if not session.status() or session.at is None:
        return None
    scale = session.machine.axes.units_per_mm
    return Stand((session.at[0] * scale, session.at[1] * scale), None)
