"""Path data of SVG as polylines."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.drawing import LARGEST
from foldmill.exchange.svg import curves
from foldmill.exchange.svg.lengths import NUMBER
from foldmill.pattern import Floats

_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_SPACE = re.compile(r"[\s,]*")
_NUMBER = re.compile(NUMBER)
_FLAG = re.compile(r"[01]")
Point = tuple[float, float]


@dataclass
class Traced:
    """What a path draws: polylines (n, 2), and how many of its pieces were curves."""

    lines: list[Floats] = field(default_factory=list)
    bent: int = 0


def trace(data: str, most: int) -> Traced:
    """Return the polylines of path data; raises UnreadableFile where it breaks.

    most : pieces it may have.
    """
    pen = _Pen()
    at, command, pieces = _skip(data, 0), "", 0
    while at < len(data):
        if data[at].upper() in _COUNTS:
            command, at = data[at], _skip(data, at + 1)
        elif not command or command in "Zz":
            raise _broken(data, at)
        values, at = _values(data, at, command.upper())
        pieces += 1
        if pieces > most:
            raise UnreadableFile(f"A path has more than {most:,} pieces, the most that is read.")
        pen.draw(command, values)
        command = {"M": "L", "m": "l"}.get(command, command)
    pen.lift()
    return pen.traced


def _skip(data: str, at: int) -> int:
    found = _SPACE.match(data, at)
    return found.end() if found else at


def _values(data: str, at: int, command: str) -> tuple[list[float], int]:
    values: list[float] = []
    for k in range(_COUNTS[command]):
        pattern = _FLAG if command == "A" and k in {3, 4} else _NUMBER
        found = pattern.match(data, at)
        if not found:
            raise _broken(data, at)
        values.append(float(found[0]))
        if abs(values[-1]) > LARGEST:
            raise UnreadableFile(f"A path goes to {found[0][:40]}, beyond a billion.")
        at = _skip(data, found.end())
    return values, at


def _broken(data: str, at: int) -> UnreadableFile:
    rest = " ".join(data[at : at + 20].split()) or "its end"
    return UnreadableFile(f"The data of a path breaks off at {rest!r}, its character {at + 1}.")


class _Pen:
    """Follow the commands of one path."""

    def __init__(self) -> None:
        self.traced = Traced()
        self.at: Point = (0.0, 0.0)
        self.start: Point = (0.0, 0.0)
        self.handle: tuple[str, Point] = ("", (0.0, 0.0))
        """The kind and place of the last control point, for commands that go on smoothly."""
        self.parts: list[Floats] = []

    def lift(self) -> None:
        if len(self.parts) > 1:
            self.traced.lines.append(np.concatenate(self.parts))
        self.parts = []

    def draw(self, command: str, values: list[float]) -> None:
        kind = command.upper()
        if kind == "Z":
            self._to(self.start)
            self.lift()
            return
        points = self._points(kind, values, relative=command != kind)
        if kind == "M":
            self.lift()
            self.at = self.start = points[0]
        elif kind in "LHV":
            self._to(points[0])
        elif kind == "A":
            large, sweep = values[3] == 1, values[4] == 1
            rx, ry, tilt = values[:3]
            self._along(curves.arc(self.at, points[0], rx, ry, tilt, large, sweep))
        else:
            self._bend(kind, points)
        if kind not in "CSQT":
            self.handle = ("", self.at)

    def _points(self, kind: str, values: list[float], relative: bool) -> list[Point]:
        """Return the absolute points of a command, its end last."""
        x, y = self.at if relative else (0.0, 0.0)
        if kind == "H":
            return [(x + values[0], self.at[1])]
        if kind == "V":
            return [(self.at[0], y + values[0])]
        own = values[-2:] if kind == "A" else values
        return [(x + own[k], y + own[k + 1]) for k in range(0, len(own), 2)]

    def _bend(self, kind: str, points: list[Point]) -> None:
        family = "C" if kind in "CS" else "Q"
        if kind in "ST":
            was, (x, y) = self.handle
            turned = (2 * self.at[0] - x, 2 * self.at[1] - y) if was == family else self.at
            points = [turned, *points]
        control = np.array([self.at, *points])
        self.handle = (family, points[-2])
        self._along(curves.bezier(control))

    def _along(self, chords: Floats) -> None:
        self.traced.bent += 1
        if not self.parts:
            self.parts = [np.array([self.at])]
        self.parts.append(chords)
        self.at = (float(chords[-1][0]), float(chords[-1][1]))

    def _to(self, point: Point) -> None:
        if not self.parts:
            self.parts = [np.array([self.at])]
        if point != self.at:
            self.parts.append(np.array([point]))
        self.at = point
