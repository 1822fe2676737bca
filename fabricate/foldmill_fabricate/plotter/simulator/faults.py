"""Faults on demand: what goes wrong with the simulated machine, where, how much and how long.

``NAME@PLACE[xAMOUNT][:DURATION]``, several with commas between them, such as ``silence@5000``,
``power@2.5strokes:30s`` or ``garbage@800x4,slow@12sx5``. The place is a number of bytes received
(``5000`` or ``5000bytes``), of those of the program (``5000program``: without device control, and
with what a sender asks in the program's own language), of strokes executed (``2strokes``;
``2.5strokes`` is half through the first line of the third) or a time of the simulator's clock
(``12s``). Without a duration a fault lasts for ever. The same faults do the same to the same bytes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from math import inf

from foldmill.errors import InvalidInput


class Trouble(StrEnum):
    """What can go wrong; each name is what ``--fault`` takes."""

    SILENCE = "silence"
    """The controller hangs: it takes no byte, begins nothing and says nothing. The line that is
    being drawn ends; the handshake lines stay as they are."""
    MUTE = "mute"
    """The wire from the machine is broken: it obeys, but nothing it says arrives."""
    STALL = "stall"
    """The carriage jams in the middle of a line. The controller answers and its buffer fills; once
    free, the line goes on from where it stands."""
    HOLD = "xoff"
    """The machine says "wait" and nothing else any more: XOFF, ready line low, no ACK. It executes
    what it has."""
    GARBAGE = "garbage"
    """AMOUNT bytes of noise (4) reach the host, which nobody sent."""
    NOISE = "noise"
    """AMOUNT bytes (4) reach the machine with a flipped bit, unnoticed: 8N1 has no parity."""
    FRAMING = "framing"
    """AMOUNT bytes (4) reach the machine with a broken stop bit: lost, I/O error 15."""
    OVERFLOW = "overflow"
    """The buffer drops the next AMOUNT bytes (4) although it said there is room: I/O error 16."""
    DISCONNECT = "disconnect"
    """The cable is pulled: bytes on the way are lost, the port vanishes. The machine executes what
    it has. After the duration the port is there again, for whoever opens it anew."""
    LEVER = "lever"
    """The lever of the pinch wheels is up: the line that is being drawn ends, then it waits.
    ESC.O says 32, OE 8; a GP-GL machine says that nothing is loaded."""
    POWER = "power"
    """The mains fail in the middle of a line: motion ends there, the buffer is empty, the line is
    dead, the tool lifts. After the duration it starts anew at the origin with its defaults."""
    SLOW = "slow"
    """The buffer drains slowly: every motion takes AMOUNT times (10) as long."""


class Unit(StrEnum):
    """What a place is counted in."""

    BYTES = "bytes"
    PROGRAM = "program"
    STROKES = "strokes"
    SECONDS = "s"


LASTING = frozenset(Trouble) - {
    Trouble.GARBAGE,
    Trouble.NOISE,
    Trouble.FRAMING,
    Trouble.OVERFLOW,
}
"""Troubles that are a state, and may have a duration; the others happen to a number of bytes."""
_AMOUNTS = {Trouble.SLOW: 10.0} | dict.fromkeys(set(Trouble) - LASTING, 4.0)
_NUMBER = r"\d+(?:\.\d+)?"
_FORM = re.compile(
    rf"(?P<name>[a-z]+)@(?P<at>{_NUMBER})(?P<unit>bytes|program|strokes|s)?"
    rf"(?:x(?P<amount>{_NUMBER}))?(?::(?P<lasting>{_NUMBER})s?)?"
)


@dataclass(frozen=True)
class Fault:
    """One thing that goes wrong, once."""

    trouble: Trouble
    at: float
    unit: Unit = Unit.BYTES
    amount: float = 0.0
    """bytes, or times as slow; what 0 stands for, says ``Trouble``"""
    lasting: float = inf
    """s"""

    def __str__(self) -> str:
        amount = f"x{self.amount:g}" if self.amount else ""
        lasting = f":{self.lasting:g}s" if self.lasting < inf else ""
        return f"{self.trouble}@{self.at:g}{self.unit}{amount}{lasting}"


def parse(text: str) -> tuple[Fault, ...]:
    """Read faults with commas between them; raises InvalidInput.

    >>> [str(fault) for fault in parse("silence@5000,slow@2.5strokesx5:3s")]
    ['silence@5000bytes', 'slow@2.5strokesx5:3s']
    """
    return tuple(_parsed(each.strip()) for each in text.split(",") if each.strip())


def _parsed(text: str) -> Fault:
    found = _FORM.fullmatch(text)
    if not found or found["name"] not in set(Trouble):
        raise InvalidInput(
            f"{text!r} is no fault. Write NAME@PLACE, such as silence@5000 (bytes received), "
            "stall@3strokes or disconnect@12s:3s (for three seconds); the names are "
            f"{', '.join(Trouble)}."
        )
    trouble = Trouble(found["name"])
    amount, lasting = float(found["amount"] or 0), float(found["lasting"] or inf)
    if amount and trouble not in _AMOUNTS:
        raise InvalidInput(f"{text}: there is no amount of {trouble}; leave x{amount:g} out.")
    if found["lasting"] and trouble not in LASTING:
        raise InvalidInput(f"{text}: {trouble} happens to a number of bytes; write x4, not :4s.")
    return Fault(trouble, float(found["at"]), Unit(found["unit"] or "bytes"), amount, lasting)


class Schedule:
    """Which faults are still to come, which are there, and which end when."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self._waiting: list[Fault] = []
        self.add(faults)
        self._ends: list[tuple[float, Fault]] = []
        self.begun: list[tuple[float, Fault]] = []
        """When each fault began, s."""

    def add(self, faults: Iterable[Fault]) -> None:
        """Let more go wrong."""
        self._waiting += [
            replace(each, amount=each.amount or _AMOUNTS.get(each.trouble, 0.0)) for each in faults
        ]

    @property
    def waiting(self) -> bool:
        """Whether any is still to come."""
        return bool(self._waiting)

    @property
    def next_begin(self) -> float:
        """When the next one that is placed in time begins, s; infinite for never."""
        times = (each.at for each in self._waiting if each.unit is Unit.SECONDS)
        return min(times, default=inf)

    @property
    def next_end(self) -> float:
        """When the next one ends, s; infinite for never."""
        return min((end for end, _ in self._ends), default=inf)

    def due(self, received: int, program: int, strokes: int, now: float) -> list[Fault]:
        """Take and return those that begin now.

        received, program : bytes, and those of them that are the program's.
        """
        reached: dict[Unit, float] = {
            Unit.BYTES: received,
            Unit.PROGRAM: program,
            Unit.STROKES: strokes,
            Unit.SECONDS: now,
        }
        found = [each for each in self._waiting if reached[each.unit] >= each.at]
        self._waiting = [each for each in self._waiting if each not in found]
        self._ends += [(now + each.lasting, each) for each in found if each.lasting < inf]
        self.begun += [(now, each) for each in found]
        return found

    def over(self, now: float) -> list[Fault]:
        """Take and return those that end now."""
        found = [(end, each) for end, each in self._ends if end <= now]
        self._ends = [each for each in self._ends if each not in found]
        return [each for _, each in found]

    def line_begins(self, strokes: int, begins: float, seconds: float) -> None:
        """Place in time what shall happen within the line that is begun now."""
        for number, fault in enumerate(self._waiting):
            whole, share = divmod(fault.at, 1)
            if fault.unit is Unit.STROKES and share and strokes >= whole:
                moment = begins + share * seconds
                self._waiting[number] = replace(fault, at=moment, unit=Unit.SECONDS)
