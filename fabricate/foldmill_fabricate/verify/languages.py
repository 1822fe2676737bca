"""Which interpreter replays which language of programs. A dialect to come adds one entry."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from foldmill import UnknownName
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.verify.interpreter import Trace, interpret

Interpreter = Callable[[bytes, str, Machine], Trace]
"""Takes a program, its name for findings, and the machine; says what it makes the machine do. What
is wrong in the program becomes findings of the trace; nothing is raised."""


def _hpgl(program: bytes, name: str, machine: Machine) -> Trace:
    return interpret(program, name, selects=machine.tools.selects)


INTERPRETERS: Mapping[str, Interpreter] = MappingProxyType({"hpgl": _hpgl})
"""By the language of the machine's profile."""


def replay(program: bytes, name: str, machine: Machine) -> Trace:
    """Run a program on paper; raises UnknownName for a language that nobody interprets."""
    known = INTERPRETERS.get(machine.language)
    if known is None:
        raise UnknownName.of("language of programs", machine.language, INTERPRETERS)
    return known(program, name, machine)
