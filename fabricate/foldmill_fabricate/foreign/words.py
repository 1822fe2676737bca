"""The instructions of an HP-GL file one by one, with the byte each stands at."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from foldmill_fabricate.foreign import limits

_BLANK = re.compile(rb"[\s;]+")
_NAME = re.compile(rb"[A-Za-z]\s?[A-Za-z]")
_REST = re.compile(rb"[^A-Za-z;\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\xff]*")
_NUMBER = re.compile(rb"[+-]?(?:\d+\.?\d*|\.\d+)")
_BETWEEN = re.compile(rb"\s*,\s*|\s+|(?=[+-])")
_ENDS = {"LB": b"\x03", "PE": b";"}
"""What ends instructions that hold other things than numbers."""


@dataclass(frozen=True)
class Word:
    """One instruction."""

    name: str
    """Two capitals; empty for what is none."""
    byte: int
    values: tuple[float, ...] = ()
    fault: str = ""
    """Why it cannot be read."""


def words(data: bytes) -> Iterator[Word]:
    """Yield the instructions of a file; what is none comes with its fault, and reading goes on."""
    at = 0
    while at < len(data):
        blank = _BLANK.match(data, at)
        if blank:
            at = blank.end()
            continue
        name = _NAME.match(data, at)
        if name is None:
            yield Word("", at, fault=_stranger(data[at]))
            at = _after(data, at, b";")
            continue
        short = bytes(each for each in name[0] if each > 32).decode().upper()
        if short in _ENDS:
            yield Word(short, at)
            at = _after(data, name.end(), _ENDS[short])
            continue
        rest = _REST.match(data, name.end())
        end = rest.end() if rest else name.end()
        yield _read(short, data[name.end() : end], at)
        at = end


def _stranger(byte: int) -> str:
    kind = "an escape sequence for the machine" if byte == 0x1B else f"0x{byte:02X}"
    return f"{kind}, where an instruction belongs"


def _after(data: bytes, at: int, end: bytes) -> int:
    """Return the place behind the next such byte, or the end."""
    found = data.find(end, at)
    return len(data) if found < 0 else found + 1


def _read(name: str, text: bytes, at: int) -> Word:
    pieces = [each for each in _BETWEEN.split(text.strip()) if each]
    wrong = [each for each in pieces if len(each) > limits.NUMBER or not _NUMBER.fullmatch(each)]
    if wrong:
        shown = wrong[0][:12].decode("ascii", "replace")
        return Word(name, at, fault=f"{shown!r}, where a number belongs")
    return Word(name, at, tuple(float(each) for each in pieces))
