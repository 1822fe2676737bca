"""A G-code interpreter of our own, as strict as GRBL 1.1 and about the tool's height stricter.

It knows G0 G1 G20 G21 G90 G91 G94 M2 M3 M4 M5 and the words F S T X Y Z, with the comments that
GRBL skips. A tool on a Z axis is in the sheet below Z 0, a beam where it is on with a power. A
motion in the sheet is made by G1 at one depth; a travel over it at the clear height of the
machine's profile.
"""

from __future__ import annotations

import re

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.verify.interpreter import Trace
from foldmill_fabricate.verify.tool import Tool

_COMMENT = re.compile(r"\([^)]*\)|;.*")
_WORD = re.compile(r"([A-Z])([+-]?(?:\d+\.?\d*|\.\d+))")
_CODES = frozenset(["G0", "G1", "G20", "G21", "G90", "G91", "G94", "M2", "M3", "M4", "M5"])
_LONGEST = 80
"""Characters of a line that GRBL takes."""
_HAIR = 1e-6
"""mm; a clear height is written with four decimals."""


def interpret(program: bytes, name: str, machine: Machine) -> Trace:
    """Run a program on paper; what is wrong in it becomes findings with the byte it stands at."""
    frame = _Frame(name, machine)
    byte = 0
    for line in program.decode("latin-1").split("\n"):
        frame.execute(line, byte)
        byte += len(line) + 1
    return frame.tool.ended(byte - 1)


class _Frame:
    """The state of a machine that reads a program."""

    def __init__(self, name: str, machine: Machine) -> None:
        self.tool, self.machine = Tool(name), machine
        self.beam = machine.gcode.lowers == "beam"
        self.motion = ""
        self.inches: bool | None = None
        self.relative = False
        self.ended = False
        self.place = [0.0, 0.0]
        self.z: float | None = None
        self.feed = 0.0
        self.spindle, self.power = "M5", 0.0

    def execute(self, line: str, byte: int) -> None:
        text = "".join(_COMMENT.sub("", line).upper().split())
        if not text:
            return
        if len(text) > _LONGEST:
            self.tool.complain("syntax", byte, f"GRBL takes lines of {_LONGEST} characters.")
        words = _WORD.findall(text)
        if "".join(letter + value for letter, value in words) != text:
            self.tool.complain("syntax", byte, f"{text[:16]!r} is no line of words.")
            return
        if self.ended:
            self.tool.complain("after-end", byte, "There is more behind M2, the program's end.")
        codes = [self._code(letter, value, byte) for letter, value in words if letter in "GM"]
        values = {letter: float(value) for letter, value in words if letter not in "GM"}
        if len(values) + len(codes) < len(words):
            self.tool.complain("syntax", byte, f"{text[:16]!r} says one word twice.")
        for letter in sorted(set(values) - set("FSTXYZ")):
            self.tool.complain("unknown-instruction", byte, f"{letter} is an unknown word.")
        self._modes(codes, byte)
        self._values(values, byte)
        self._switch(codes, byte)
        if set("XYZ") & set(values):
            self._move(values, byte)
        self.ended |= "M2" in codes

    def _code(self, letter: str, value: str, byte: int) -> str:
        code = f"{letter}{float(value):g}"
        if code not in _CODES:
            self.tool.complain("unknown-instruction", byte, f"{code} is an unknown instruction.")
        return code

    def _modes(self, codes: list[str], byte: int) -> None:
        for code in codes:
            if code in ("G0", "G1"):
                self.motion = code
            elif code in ("G20", "G21"):
                self.inches = code == "G20"
            elif code in ("G90", "G91"):
                self.relative = code == "G91"
        groups = [{"G0", "G1"}, {"G20", "G21"}, {"G90", "G91"}, {"M3", "M4", "M5"}]
        if any(len(group & set(codes)) > 1 for group in groups):
            self.tool.complain("syntax", byte, "Two instructions of one kind stand in one line.")

    def _values(self, values: dict[str, float], byte: int) -> None:
        scale = 25.4 if self.inches else 1.0
        self.feed = values.get("F", self.feed / scale) * scale
        self.power = values.get("S", self.power)
        if "T" in values:
            if self.tool.down:
                self.tool.complain("tool-change-down", byte, "The tool is changed in the sheet.")
            self.tool.number = int(values["T"])
            self.tool.choices += 1

    def _switch(self, codes: list[str], byte: int) -> None:
        said = [code for code in codes if code in ("M2", "M3", "M4", "M5")]
        if said:
            self.spindle = "M5" if said[-1] == "M2" else said[-1]
        if self.spindle != "M5" and not self.beam:
            message = f"{self.spindle} turns something on that this machine has not."
            self.tool.complain("unknown-instruction", byte, message)
        if self.beam:
            on = self.spindle != "M5" and self.power > 0
            self.tool.settings = {"beam": float(self.spindle[1:]), "power": self.power}
            self._put(on, byte)

    def _put(self, into: bool, byte: int) -> None:
        if into:
            self.tool.lower(byte)
        else:
            self.tool.lift()

    def _move(self, values: dict[str, float], byte: int) -> None:
        if self.inches is None:
            self.tool.complain("no-units", byte, "It moves before G21 has said that it counts mm.")
        if not self.motion or (self.motion == "G1" and not self.feed):
            self.tool.complain("no-speed", byte, "It moves before G0, or G1 and F, say how.")
        scale = 25.4 if self.inches else 1.0
        if "Z" in values:
            self._raise(values["Z"] * scale, byte)
        if not set("XY") & set(values):
            return
        if "Z" in values:
            self.tool.complain("slanting", byte, "It moves along the sheet and up or down at once.")
        for axis, letter in enumerate("XY"):
            if letter in values:
                from_here = self.place[axis] if self.relative else 0.0
                self.place[axis] = from_here + values[letter] * scale
        self._travels(byte)
        self.tool.speed = None if self.motion == "G0" else self.feed / 60
        units = self.machine.axes.units_per_mm
        x, y = (float(round(each * units)) for each in self.place)
        self.tool.go((x, y), byte)

    def _travels(self, byte: int) -> None:
        """Judge a motion along the sheet: in it by G1, above it at the clear height."""
        if self.tool.down and self.motion == "G0":
            self.tool.complain("fast-in-sheet", byte, "G0 drags the tool through the sheet.")
        elif not self.beam and not self.tool.down:
            clear = self.machine.gcode.clear
            if self.z is None or self.z < clear - _HAIR:
                at = "at an unknown height" if self.z is None else f"at Z {self.z:g} mm"
                message = f"The tool travels {at}; {clear:g} mm are asked for."
                self.tool.complain("low-travel", byte, message)

    def _raise(self, z: float, byte: int) -> None:
        if self.beam:
            self.tool.complain("unknown-instruction", byte, "Z: this machine has no such axis.")
            return
        if self.relative:
            z += self.z or 0.0
        if z < 0 and self.motion == "G0":
            self.tool.complain("fast-in-sheet", byte, "G0 rams the tool into the sheet.")
        self.z = z
        if z < 0:
            self.tool.settings = {"depth": -z}
        self._put(z < 0, byte)
