"""Which interpreter replays which language of programs: ours, and those that plugins offer.

A language is added through the hook ``foldmill_interpreters``, beside the format that writes it.
"""

from __future__ import annotations

from foldmill import installed
from foldmill_fabricate.hooks import INTERPRETERS, Interpreter
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.verify.gcode import interpret as gcode
from foldmill_fabricate.verify.gpgl import interpret as gpgl
from foldmill_fabricate.verify.interpreter import Trace, interpret

__all__ = ["gcode", "gpgl", "hpgl", "replay"]


def hpgl(program: bytes, name: str, machine: Machine) -> Trace:
    """Replay HP-GL; takes and returns what every interpreter does."""
    return interpret(program, name, selects=machine.tools.selects)


def replay(program: bytes, name: str, machine: Machine) -> Trace:
    """Run a program on paper; raises UnknownName for a language that nobody interprets."""
    found: Interpreter = installed().get(INTERPRETERS, "language of programs", machine.language)
    return found.replay(program, name, machine)
