"""A GP-GL interpreter of our own, strict where a machine would guess.

It knows J ! FX FC M O D E H. Whatever else stands in a program is a finding, not skipped. Grammar
(Graphtec's GP-GL as its drivers quote it): a name, numbers between commas, ended by ETX (3). D and
E draw, M and O go with the tool up, O and E by differences; H lifts the tool and goes home.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.verify.interpreter import Trace
from foldmill_fabricate.verify.tool import Tool

_COMMAND = re.compile(r"(FX|FC|[JMODEH!])([^A-Z!]*)")
_NUMBER = re.compile(r"[+-]?\d+")
_LEAST = {"J": 1, "!": 1, "FX": 1, "FC": 0}


def interpret(program: bytes, name: str, machine: Machine) -> Trace:
    """Run a program on paper; what is wrong in it becomes findings with the byte it stands at."""
    cutter = _Cutter(name, machine)
    *commands, rest = program.decode("latin-1").split("\x03")
    byte = 0
    for command in commands:
        cutter.execute(command.strip("\r\n"), byte)
        byte += len(command) + 1
    if rest.strip():
        cutter.tool.complain("syntax", byte, f"{rest.strip()[:12]!r} has no ETX behind it.")
    return cutter.tool.ended(byte)


class _Cutter:
    """The state of a machine that reads a program."""

    def __init__(self, name: str, machine: Machine) -> None:
        self.tool, self.machine = Tool(name), machine

    def execute(self, command: str, byte: int) -> None:
        match = _COMMAND.fullmatch(command)
        if match is None:
            shown = command[:12]
            self.tool.complain("unknown-instruction", byte, f"{shown!r} is an unknown command.")
            return
        values = self._numbers(match[1], match[2], byte)
        if values is None:
            return
        if match[1] == "H":
            self._home(values, byte)
        elif match[1] in "MODE":
            self._trace(match[1], values, byte)
        else:
            self._set(match[1], values, byte)

    def _numbers(self, name: str, text: str, byte: int) -> list[int] | None:
        words = text.split(",") if text else []
        wrong = [word for word in words if not _NUMBER.fullmatch(word)]
        if wrong:
            code = "not-whole" if re.fullmatch(r"[+-]?\d*\.\d*", wrong[0]) else "syntax"
            self.tool.complain(code, byte, f"{name} has {wrong[0]!r} where a number belongs.")
            return None
        return [int(word) for word in words]

    def _home(self, values: list[int], byte: int) -> None:
        if values:
            self.tool.complain("syntax", byte, "H takes no numbers.")
        self.tool.lift()
        self.tool.at = None

    def _set(self, name: str, values: list[int], byte: int) -> None:
        if len(values) != 1 or values[0] < _LEAST[name]:
            said = ",".join(str(value) for value in values)
            self.tool.complain("syntax", byte, f"{name}{said}: one number belongs there.")
            return
        _SETTERS[name](self, values[0], byte)

    def select(self, number: int, byte: int) -> None:
        if self.tool.down:
            self.tool.complain("tool-change-down", byte, "The tool is changed in the sheet.")
            self.tool.lift()
        self.tool.number = number
        self.tool.choices += 1

    def set_speed(self, units: int, _: int) -> None:
        self.tool.speed = units * self.machine.tools.speed_unit

    def set_force(self, units: int, _: int) -> None:
        self.tool.force = units * self.machine.tools.force_unit

    def set_offset(self, steps: int, _: int) -> None:
        self.tool.settings["blade offset"] = float(steps)

    def _trace(self, name: str, values: list[int], byte: int) -> None:
        tool = self.tool
        if not values or len(values) % 2:
            message = f"{name} has {len(values)} coordinates; they come in pairs."
            tool.complain("odd-coordinates", byte, message)
        if self.machine.tools.selects and tool.number is None:
            tool.complain("no-tool", byte, "The tool is moved before J has chosen one.")
        if name in "DE":
            tool.lower(byte)
        else:
            tool.lift()
        for x, y in zip(values[::2], values[1::2], strict=False):
            tool.go(self._target(name, x, y, byte), byte)

    def _target(self, name: str, x: int, y: int, byte: int) -> tuple[float, float]:
        if name in "MD":
            return float(x), float(y)
        if self.tool.at is None:
            self.tool.complain("no-position", byte, "A relative motion from nobody knows where.")
        start = self.tool.at or (0.0, 0.0)
        return start[0] + x, start[1] + y


_SETTERS: dict[str, Callable[[_Cutter, int, int], None]] = {
    "J": _Cutter.select,
    "!": _Cutter.set_speed,
    "FX": _Cutter.set_force,
    "FC": _Cutter.set_offset,
}
