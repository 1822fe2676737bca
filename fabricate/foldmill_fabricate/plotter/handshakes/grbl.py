"""A conversation with GRBL: lines answered by ``ok``, a status at any time, hold and reset."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable

from foldmill_fabricate.plotter.errors import NoAnswer, PlotterError
from foldmill_fabricate.plotter.session import SILENCE, Session

_RESET, _HOLD, _STATUS = b"\x18", b"!", b"?"
_WELCOME = 2.0
"""s that it may take to start."""
_OPTIONS = re.compile(r"\[OPT:[^,]*,\d+,(\d+)")
_PLACE = re.compile(r"([MW])Pos:(-?[\d.]+),(-?[\d.]+)")
_OFFSET = re.compile(r"WCO:(-?[\d.]+),(-?[\d.]+)")
_SMALLEST, _LARGEST = 64, 1 << 16


class GrblSession(Session):
    """What GRBL says, sorted."""

    ends = b"\n"
    oks = 0
    """Lines answered ok so far."""
    marks: deque[int]
    """How many had been when each ``$G`` was answered."""
    state = ""
    """The last status: Idle, Run, Hold …; "" for none."""
    statuses = 0
    """How many statuses came."""
    at: tuple[float, float] | None = None
    """Where the last status has the tool, mm, in the program's coordinates."""
    trouble = ""
    """The first error or alarm, or that it started anew."""
    _offset = (0.0, 0.0)
    _options = ""

    def open(self) -> None:
        """Find it idle, have it drop half a line, and learn its buffer."""
        self.marks = deque()
        super().open()
        if not self.status(_WELCOME):
            raise NoAnswer(
                f"No GRBL answers at {self.machine.serial.baud} baud. Is it on, and does its own "
                "setting agree with the baud rate?"
            )
        if not self.state.startswith("Idle"):
            raise PlotterError(
                f"The machine is not idle but says {self.state}. Wait until it is done; out of an "
                "alarm home it or unlock it first."
            )
        self._reset()
        self.oks, self.trouble = 0, ""
        self.write(b"$I\n")
        self._until(lambda: self.oks > 0, self.line_free + SILENCE)
        found = _OPTIONS.search(self._options)
        if found and _SMALLEST <= int(found[1]) <= _LARGEST:
            self.buffer = int(found[1])
        self.oks = 0

    def ask(self) -> None:
        """Ask for a status; ``statuses`` counts the answers."""
        self.send(_STATUS)

    def status(self, patience: float = SILENCE) -> str:
        """Ask for a status and wait; "" for silence."""
        before = self.statuses
        self.ask()
        came = self._until(lambda: self.statuses > before, self.line_free + patience)
        return self.state if came else ""

    def take(self, line: bytes) -> None:
        """Sort an answer."""
        text = line.decode("ascii", "replace").strip()
        if text == "ok":
            self.oks += 1
        elif text.startswith("[GC:"):
            self.marks.append(self.oks)
        elif text.startswith("<"):
            self._read(text)
        elif text.startswith("[OPT"):
            self._options = text
        elif text.startswith("error:"):
            self.trouble = self.trouble or f"The machine refuses a line: {text}."
        elif text.startswith("ALARM:"):
            self.trouble = self.trouble or f"The machine is in alarm: {text}."
        elif text.startswith("Grbl"):
            self.trouble = self.trouble or "The machine has started anew: its power, or its reset."
        elif text and not text.startswith(("[", "$")):
            self.trouble = self.trouble or (
                f"The machine answered {text!r}, which GRBL does not say. Something disturbs the "
                "line."
            )

    def abort(self, unsent: int | None) -> str:  # noqa: ARG002
        """Hold, so that the place is not lost; drop all; lift the tool."""
        self.port.write(_HOLD)
        began, said = self.clock.now(), self.statuses
        while self.clock.now() < began + _WELCOME:
            if self._state_again().startswith(("Hold:0", "Idle", "Alarm")):
                break
            if self.statuses == said and self.clock.now() > began + SILENCE / 2:
                break  # it is dead, or cannot be heard
        self._reset(_WELCOME if self.statuses > said else SILENCE / 2)
        if b"Z" in self.lift:
            self.port.write(self.lift)
        return "The machine was told to hold, and to drop what it has."

    def _state_again(self) -> str:
        before = self.statuses
        self.port.write(_STATUS)
        limit = self.clock.now() + SILENCE / 4
        while self.statuses == before and self.clock.now() < limit:
            self._more()
        return self.state

    def _reset(self, patience: float = _WELCOME) -> None:
        """Reset, and wait until it is back."""
        self.trouble = ""
        self.port.write(_RESET)
        limit = self.clock.now() + patience
        while not self.trouble and self.clock.now() < limit:
            self._more()

    def _more(self) -> None:
        came = self.port.read(1)
        self._heard += came + self.port.read(self.port.in_waiting)
        self._sort()

    def _until(self, over: Callable[[], bool], limit: float) -> bool:
        self.listen()
        while not over():
            if self.clock.now() >= limit:
                return False
            self.wait_a_byte()
        return True

    def _read(self, text: str) -> None:
        self.state, self.statuses = text[1:].split("|")[0].rstrip(">"), self.statuses + 1
        offset, place = _OFFSET.search(text), _PLACE.search(text)
        if offset:
            self._offset = float(offset[1]), float(offset[2])
        if place:
            dx, dy = self._offset if place[1] == "M" else (0.0, 0.0)
            self.at = float(place[2]) - dx, float(place[3]) - dy
