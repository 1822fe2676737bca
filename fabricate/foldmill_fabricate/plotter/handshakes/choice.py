"""Which conversation and which feed a profile asks for."""

from __future__ import annotations

from typing import Any

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.plotter.handshakes import counted
from foldmill_fabricate.plotter.handshakes.asked import Asked
from foldmill_fabricate.plotter.handshakes.blocks import Enquired, Wired
from foldmill_fabricate.plotter.handshakes.counted import Counted
from foldmill_fabricate.plotter.handshakes.feed import Feed
from foldmill_fabricate.plotter.handshakes.gpgl import GpglSession, Stated
from foldmill_fabricate.plotter.handshakes.grbl import GrblSession
from foldmill_fabricate.plotter.handshakes.hp import HpSession
from foldmill_fabricate.plotter.handshakes.modelled import Modelled
from foldmill_fabricate.plotter.handshakes.paced import Paced
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import Session
from foldmill_fabricate.plotter.wish import Wish
from foldmill_fabricate.plotter.witness import watched

_MODELLED: dict[str, type[Modelled]] = {
    "none": Modelled,
    "paced": Paced,
    "xon-xoff": Modelled,
    "rts-cts": Modelled,
    "dtr": Wired,
    "enq-ack": Enquired,
}
_OWN = {"grbl": "gcode", "gp-gl": "gp-gl"}
"""Handshakes that are part of a language."""


def session(port: Any, machine: Machine, clock: Clock, wish: Wish | None = None) -> Session:
    """Return the conversation; raises ProgramRefused for a profile that contradicts itself."""
    handshake = machine.serial.handshake
    if handshake == "esc-b" and not machine.serial.answers:
        raise ProgramRefused(
            f"{machine.slug} is to be asked for its free bytes (handshake esc-b), but does not "
            'answer (answers = false). Use the handshake "xon-xoff" or "none".'
        )
    asked = handshake in ("esc-b", "enq-ack")
    if _OWN.get(handshake, machine.language) != machine.language or (
        asked and machine.language != "hpgl"
    ):
        raise ProgramRefused(
            f"{machine.slug} speaks {machine.language}, which has no handshake {handshake}."
        )
    if handshake == "grbl":
        return GrblSession(port, machine, clock, wish)
    if handshake == "gp-gl":
        return GpglSession(port, machine, clock, wish)
    return HpSession(port, silent(machine), clock, wish)


def prepared(job: Job, machine: Machine) -> Job:
    """Return the job with questions between strokes, where the machine answers them in order."""
    if machine.serial.handshake == "grbl":
        return watched(job, *counted.QUESTIONS)
    if machine.language == "hpgl" and machine.serial.answers:
        return watched(job)
    return job


def feed(talk: Session, job: Job) -> Feed:
    """Return the feed of a conversation."""
    if isinstance(talk, GrblSession):
        return Counted(talk, job)
    if isinstance(talk, GpglSession):
        return Stated(talk, job)
    assert isinstance(talk, HpSession)
    kind = talk.machine.serial.handshake
    return Asked(talk, job) if kind == "esc-b" else _MODELLED[kind](talk, job)


def silent(machine: Machine) -> Machine:
    """Return the machine as one that is asked nothing in its program, for it knows no HP-GL."""
    if machine.language == "hpgl" or not machine.serial.answers:
        return machine
    serial = machine.serial.model_copy(update={"answers": False})
    return machine.model_copy(update={"serial": serial})
