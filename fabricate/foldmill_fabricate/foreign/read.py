"""Read HP-GL from elsewhere into strokes of each pen; only what is on a list is let through.

Known are IN DF SP PU PD PA PR AA AR CI IP SC; VS FS and a bare LT are taken as remarks. Everything
else is refused with the byte it stands at. Coordinates are steps of 0.025 mm (HP 7475A manual,
chapter 1) unless IP and SC say otherwise.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import chain
from math import hypot, isfinite

from foldmill.errors import UnreadableFile
from foldmill_fabricate.foreign import limits
from foldmill_fabricate.foreign.arcs import arc, chords, circle
from foldmill_fabricate.foreign.scaling import Scale, Unscalable
from foldmill_fabricate.foreign.words import Word, words

XY = tuple[float, float]
Path = tuple[XY, ...]

STEPS_PER_MM = 40.0
"""The unit of HP-GL: 0.025 mm."""


@dataclass(frozen=True)
class Drawing:
    """A foreign drawing: what each pen draws."""

    name: str
    sha256: str
    pens: Mapping[int, tuple[Path, ...]]
    """Strokes by the pen's number, (n, 2) mm each, as the file counts from its origin."""
    remarks: tuple[str, ...]
    """What was read and not followed, a sentence each."""


class _Refused(ValueError):
    """An instruction that is not followed; its text goes on after the name."""


def read(data: bytes, name: str) -> Drawing:
    """Read a file; raises UnreadableFile, naming each refused instruction and where it stands."""
    if len(data) > limits.BYTES:
        raise UnreadableFile(
            f"{name} has {len(data):,} bytes; {limits.BYTES:,} at the most are read. Divide it."
        )
    pen, refused = _Pen(), list[str]()
    last = Word("", len(data))
    for count, word in enumerate(chain(words(data), [last]), 1):
        if count > limits.INSTRUCTIONS:
            raise UnreadableFile(_too_much(name, f"{limits.INSTRUCTIONS:,} instructions", word))
        try:
            pen.follow(word) if word is not last else pen.lift()
        except _Refused as why:
            refused.append(f"byte {word.byte}: {word.name or 'there is'} {why}")
        except _TooMuch:
            raise UnreadableFile(_too_much(name, f"{limits.POINTS:,} corners", word)) from None
    if refused:
        raise UnreadableFile(_told(name, refused))
    drawn = {number: tuple(own) for number, own in sorted(pen.done.items())}
    if not drawn:
        raise UnreadableFile(f"{name} draws nothing: no pen goes down and moves in it.")
    return Drawing(name, hashlib.sha256(data).hexdigest(), drawn, pen.remarks())


def _too_much(name: str, what: str, word: Word) -> str:
    return f"{name} has more than {what} by byte {word.byte}. Divide the drawing."


def _told(name: str, refused: list[str]) -> str:
    more = len(refused) - limits.TOLD
    tail = f"; and {more} more" if more > 0 else ""
    return (
        f"{name} is refused: {'; '.join(refused[: limits.TOLD])}{tail}. Export it again as plain "
        "lines: IN SP PU PD PA PR and arcs, words and dashes turned into lines."
    )


class _TooMuch(ValueError):
    """More corners than are read."""


@dataclass
class _Pen:
    """Follows a drawing. Places are plotter units; user units only where SC holds."""

    at: XY = (0.0, 0.0)
    number: int = 1
    is_down: bool = False
    relative: bool = False
    scale: Scale = field(default_factory=Scale)
    points: int = 0
    done: dict[int, list[Path]] = field(default_factory=dict)
    way: list[XY] = field(default_factory=list)
    heard: dict[str, int] = field(default_factory=dict)

    def follow(self, word: Word) -> None:
        if not word.name:
            raise _Refused(word.fault)
        action = _KNOWN.get(word.name)
        if action is None:
            raise _Refused(_WHY.get(word.name, "is not on the list of what is followed"))
        if word.fault:
            raise _Refused(f"holds {word.fault}")
        action(self, list(word.values))

    def remarks(self) -> tuple[str, ...]:
        told = {
            "VS": "speeds (VS) are the material's and the machine's, not the file's",
            "FS": "forces (FS) are the material's and the machine's, not the file's",
            "dot": "places where a pen goes down without moving are left out",
        }
        return tuple(f"{n} times: {told[what]}." for what, n in sorted(self.heard.items()))

    def hear(self, what: str) -> None:
        self.heard[what] = self.heard.get(what, 0) + 1

    def lift(self) -> None:
        way, self.way, self.is_down = self.way, [], False
        if len(way) == 1:
            self.hear("dot")
        if len(way) < 2:
            return
        if not self.number:
            raise _Refused("ends a line that was drawn without a pen (SP0)")
        mm = tuple((x / STEPS_PER_MM, y / STEPS_PER_MM) for x, y in way)
        self.done.setdefault(self.number, []).append(mm)

    def lower(self) -> None:
        if not self.is_down:
            self.way, self.is_down = [self.at], True

    def go(self, place: XY) -> None:
        far = limits.REACH_MM * STEPS_PER_MM
        if not (isfinite(place[0]) and isfinite(place[1])) or max(map(abs, place)) > far:
            raise _Refused(f"leads farther than {limits.REACH_MM:,.0f} mm away")
        if self.is_down and place != self.way[-1]:
            self.way.append(place)
        self.at = place
        self.points += 1
        if self.points > limits.POINTS:
            raise _TooMuch

    # what each instruction does

    def initialise(self, values: list[float]) -> None:
        if values:
            raise _Refused("takes no numbers")
        self.lift()
        self.relative, self.scale = False, Scale()

    def defaults(self, values: list[float]) -> None:
        """The pen stays where and as it is, and so do the points of IP."""
        if values:
            raise _Refused("takes no numbers")
        self.relative, self.scale = False, Scale(self.scale.corners)

    def select(self, values: list[float]) -> None:
        number = values[0] if values else 0.0
        if len(values) > 1 or not number.is_integer() or not 0 <= number <= 99:
            raise _Refused("chooses no pen from 0 to 99")
        if self.is_down:
            raise _Refused("changes the pen while it is down; put PU before it")
        self.number = int(number)

    def up(self, values: list[float]) -> None:
        self.lift()
        self.move(values)

    def down(self, values: list[float]) -> None:
        self.lower()
        self.move(values)

    def absolute(self, values: list[float]) -> None:
        self.relative = False
        self.move(values)

    def by_differences(self, values: list[float]) -> None:
        self.relative = True
        self.move(values)

    def move(self, values: list[float]) -> None:
        if len(values) % 2:
            raise _Refused(f"has {len(values)} coordinates; they come in pairs")
        for x, y in zip(values[::2], values[1::2], strict=True):
            here = self.scale.user(*self.at) if self.relative else (0.0, 0.0)
            self.go(self.scale.point(here[0] + x, here[1] + y))

    def input_points(self, values: list[float]) -> None:
        self._rescale(self.scale.between, values)

    def user_units(self, values: list[float]) -> None:
        self._rescale(self.scale.scaled, values)

    def _rescale(self, change: Callable[[list[float]], Scale], values: list[float]) -> None:
        try:
            self.scale = change(values)
        except Unscalable as why:
            raise _Refused(str(why)) from None

    def arc_to(self, values: list[float]) -> None:
        self._arc(values, relative=False)

    def arc_by(self, values: list[float]) -> None:
        self._arc(values, relative=True)

    def _arc(self, values: list[float], *, relative: bool) -> None:
        x, y, sweep = self._curve(values, 3)
        here = self.scale.user(*self.at)
        centre = (here[0] + x, here[1] + y) if relative else (x, y)
        if abs(sweep) > 360:
            raise _Refused(f"turns by {sweep:g} degrees, more than once round")
        radius = hypot(here[0] - centre[0], here[1] - centre[1])
        begun = self.at
        for place in arc(centre, here, sweep, self._chords(radius, sweep)):
            self.go(self.scale.point(*place))
        if abs(sweep) == 360 and self.is_down:
            self.way[-1] = self.at = begun

    def circle(self, values: list[float]) -> None:
        """It is drawn whatever the pen does, and the pen is at its centre then as it was."""
        (radius,) = self._curve(values, 1)
        centre, was_down, back = self.scale.user(*self.at), self.is_down, self.at
        if not radius:
            raise _Refused("has no radius")
        rim = [
            self.scale.point(*spot) for spot in circle(centre, radius, self._chords(radius, 360))
        ]
        self.lift()
        self.go(rim[0])
        self.lower()
        for place in rim[1:]:
            self.go(place)
        self.lift()
        self.at = back
        if was_down:
            self.lower()

    def _curve(self, values: list[float], count: int) -> list[float]:
        if len(values) not in (count, count + 1):
            raise _Refused(f"takes {count} numbers, or one more for its chords")
        if len(values) > count and not 0 < abs(values[count]) <= limits.COARSE_DEG:
            raise _Refused(f"asks for chords of {values[count]:g} degrees, which is no curve")
        return values[:count]

    def _chords(self, radius: float, sweep: float) -> int:
        plotter_units = abs(radius) * self.scale.largest
        if not plotter_units <= limits.REACH_MM * STEPS_PER_MM:
            raise _Refused(f"is an arc of more than {limits.REACH_MM:,.0f} mm radius")
        return chords(plotter_units, sweep, limits.TOLERANCE_MM * STEPS_PER_MM)

    def speed(self, values: list[float]) -> None:  # noqa: ARG002 - the material's is taken
        self.hear("VS")

    def force(self, values: list[float]) -> None:  # noqa: ARG002 - the material's is taken
        self.hear("FS")

    def solid(self, values: list[float]) -> None:
        if values:
            raise _Refused("draws dashes; turn them into lines of their own")


_KNOWN: dict[str, Callable[[_Pen, list[float]], None]] = {
    "IN": _Pen.initialise,
    "DF": _Pen.defaults,
    "SP": _Pen.select,
    "PU": _Pen.up,
    "PD": _Pen.down,
    "PA": _Pen.absolute,
    "PR": _Pen.by_differences,
    "AA": _Pen.arc_to,
    "AR": _Pen.arc_by,
    "CI": _Pen.circle,
    "IP": _Pen.input_points,
    "SC": _Pen.user_units,
    "VS": _Pen.speed,
    "FS": _Pen.force,
    "LT": _Pen.solid,
}
"""What is followed, and how."""
_WHY = {
    "LB": "writes words; turn them into lines",
    "PE": "holds encoded lines; export plain PD and PU",
    "RO": "turns the sheet; turn the drawing before it is exported",
    "IW": "cuts the drawing off at a window",
} | dict.fromkeys(("OA", "OE", "OI", "OS", "OP", "OC", "OF", "OH"), "asks the machine something")
"""Why some others are not."""
