"""What the sender knows of a program's language: its units, their times, strokes and places.

A *unit* is what must never be divided on the line: an HP-GL instruction, a line of G-code, a GP-GL
command with its ETX. Each language divides a program into ``Instruction`` values and can say the
rest of it from a stroke on.
"""

from __future__ import annotations

from typing import Protocol

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.languages.gcode import Gcode
from foldmill_fabricate.plotter.languages.gpgl import GpGl
from foldmill_fabricate.plotter.languages.hpgl import HpGl
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.resume import Start

_SMALL = 4


class Language(Protocol):
    """Reads programs of one language."""

    def as_sent(self, program: bytes, machine: Machine, limit: int) -> bytes:
        """Return the same path in units of at most ``limit`` bytes; raises ProgramRefused."""
        ...

    def ready(self, program: bytes, machine: Machine) -> Job:
        """Divide it and find what each unit takes; raises ProgramRefused."""
        ...

    def rest(self, job: Job, machine: Machine, limit: int, start: Start) -> Job:
        """Return what is left from a place on; raises ProgramRefused."""
        ...

    def lead_in(self, job: Job, stroke: int) -> tuple[int, ...]:
        """Return the stroke that turned the blade for this one."""
        ...


def spoken(machine: Machine) -> Language:
    """Return the language of a machine."""
    if machine.language == "gcode":
        return Gcode()
    return GpGl() if machine.language == "gp-gl" else HpGl()


def reserve(buffer: int) -> int:
    """Return the bytes of a buffer that are never filled: real machines overflow before the end."""
    return min(128, buffer // _SMALL)


def longest(buffer: int, machine: Machine) -> int:
    """Return the longest unit that is sent at once, bytes.

    A third of what may be filled: while one is on the line and one in the buffer, a third can be
    promised, and so the line never waits for an answer. Where a line or an ACK promises a block,
    no more than that block.
    """
    limit = min(machine.dialect.max_instruction, (buffer - reserve(buffer)) // 3)
    if machine.serial.handshake == "grbl":
        return buffer - 1  # a line of GRBL's own 80 characters; ok tells when it has left
    if machine.serial.handshake in ("enq-ack", "dtr"):
        limit = min(limit, block(buffer))
    return limit


def block(buffer: int) -> int:
    """Return the bytes that a ready line, or an ACK, promises: the default block of ESC.H."""
    return min(80, buffer // 4)


def made_ready(program: bytes, machine: Machine, buffer: int | None = None) -> Job:
    """Return a program divided for a buffer, bytes; the profile's where not given."""
    language = spoken(machine)
    limit = longest(buffer or machine.serial.buffer, machine)
    return language.ready(language.as_sent(program, machine, limit), machine)
