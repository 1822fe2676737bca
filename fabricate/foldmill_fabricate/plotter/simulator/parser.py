"""HP-GL, taken from a buffer unit by unit: what a machine can begin to do at once.

A unit is one coordinate pair of PU, PD, PA or PR, or one whole other instruction. So a machine
begins a long PD before its end has come, and its buffer empties pair by pair.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

NO_ERROR, UNKNOWN, WRONG_COUNT, OUT_OF_RANGE = 0, 1, 2, 3
"""HP-GL errors, as OE answers them."""

ENDS = frozenset(b";, \r\n\x03" + bytes(range(65, 91)) + bytes(range(97, 123)))
"""Bytes behind which a unit may be complete or something can be skipped."""

MOVES = frozenset({"PU", "PD", "PA", "PR"})

_LARGEST = 1e9
_NUMBER = rb"\s*([+-]?\d+(?:\.\d*)?)\s*"
_SEPARATORS = re.compile(rb"[\s;]*")
_MNEMONIC = re.compile(rb"([A-Za-z])\s*([A-Za-z])")
_END = re.compile(rb"\s*(;|(?=[A-Za-z]))")
_PAIR = re.compile(rb",?" + _NUMBER + rb"," + _NUMBER + rb"(?=[,;A-Za-z])")
_REST = re.compile(rb"[^;A-Za-z]*(;|(?=[A-Za-z]))")
_NUMBERS = re.compile(_NUMBER + rb"(?:," + _NUMBER + rb")*")


@dataclass(frozen=True)
class Unit:
    """Something to do: a mnemonic, its numbers (a pair, or all of them), or a syntax error."""

    name: str
    numbers: tuple[float, ...] = ()
    error: int = NO_ERROR


class Parser:
    """Takes units from the front of a buffer. What is incomplete stays there."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget an instruction under way, as after ESC.K."""
        self._open = ""
        """The move whose pairs are coming, or LB, or nothing."""
        self._begun = False
        """Whether the open move has had a pair."""

    def take(self, buffer: bytearray) -> Unit | None:
        """Remove and return the next unit; None where none is complete."""
        while buffer:
            if self._open == "LB":
                if not self._skip_label(buffer):
                    return None
            elif self._open:
                done, unit = self._next_pair(buffer)
                if unit or not done:
                    return unit
            else:
                done, unit = self._begin(buffer)
                if unit or not done:
                    return unit
        return None

    def _skip_label(self, buffer: bytearray) -> bool:
        end = buffer.find(b"\x03")
        del buffer[: end + 1 if end >= 0 else len(buffer)]
        if end >= 0:
            self._open = ""
        return end >= 0

    def _begin(self, buffer: bytearray) -> tuple[bool, Unit | None]:
        """Return whether anything went on, and the unit if one is complete."""
        del buffer[: _end(_SEPARATORS.match(buffer))]
        found = _MNEMONIC.match(buffer)
        if not found:
            return self._rubbish(buffer)
        name = (found[1] + found[2]).decode().upper()
        if name == "LB":
            self._open = name
            del buffer[: found.end()]
            return True, Unit(name)
        if name in MOVES:
            return self._begin_move(buffer, name, found.end())
        rest = _REST.match(buffer, found.end())
        if not rest:
            return False, None
        body = bytes(buffer[found.end() : rest.end()]).rstrip(b";").strip()
        del buffer[: rest.end()]
        return True, _whole(name, body)

    def _begin_move(self, buffer: bytearray, name: str, start: int) -> tuple[bool, Unit | None]:
        bare = _END.match(buffer, start)
        if bare:
            del buffer[: bare.end()]
            return True, Unit(name)
        first = _PAIR.match(buffer, start)
        if not first and not _REST.match(buffer, start):
            return False, None  # the mnemonic waits in the buffer for its first pair
        del buffer[:start]
        self._open, self._begun = name, False
        return self._next_pair(buffer)

    def _next_pair(self, buffer: bytearray) -> tuple[bool, Unit | None]:
        end = _END.match(buffer)
        if end:
            del buffer[: end.end()]
            self._open = ""
            return True, None
        found = _PAIR.match(buffer)
        if found and (found[0][:1] == b",") == self._begun:
            unit, self._begun = Unit(self._open, (_number(found[1]), _number(found[2]))), True
            del buffer[: found.end()]  # only now: a match looks into the buffer itself
            return True, unit
        rest = _REST.match(buffer)
        if not rest:
            return False, None
        name, self._open = self._open, ""
        del buffer[: rest.end()]
        return True, Unit(name, error=WRONG_COUNT)

    def _rubbish(self, buffer: bytearray) -> tuple[bool, Unit | None]:
        """What begins with no mnemonic is one error up to the next end."""
        if not buffer or (len(buffer) < 2 and buffer[:1].isalpha()):
            return False, None
        if buffer[:1].isalpha() and not buffer[1:].strip():
            return False, None
        skip = 1 if buffer[:1].isalpha() else 0
        rest = _REST.match(buffer, skip)
        if not rest:
            return False, None
        del buffer[: rest.end()]
        return True, Unit("", error=UNKNOWN)


def _whole(name: str, body: bytes) -> Unit:
    if not body:
        return Unit(name)
    if not _NUMBERS.fullmatch(body):
        return Unit(name, error=WRONG_COUNT)
    return Unit(name, tuple(map(_number, body.split(b","))))


def _number(text: bytes) -> float:
    """Return a number, which no line of digits makes infinite."""
    return max(-_LARGEST, min(_LARGEST, float(text)))


def _end(found: re.Match[bytes] | None) -> int:
    return found.end() if found else 0
