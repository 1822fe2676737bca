"""Device control: the sequences ESC . letter, taken out of the bytes before the buffer.

Source: HP 7470A Interfacing and Programming Manual, chapter 10; HP 7475A the same set.
Parameters stand between ``;``, end with ``:`` and belong to some letters only.
"""

from __future__ import annotations

from dataclasses import dataclass, field

ESC = 0x1B
HP_7475 = "@BEHIJKLMNOR(Y)Z"
"""Letters of the HP 7470A and 7475A, and of Roland's plotters."""
HP_7550 = HP_7475 + "APQSTU"
"""Letters of the HP 7550A."""
_WITH_PARAMETERS = frozenset(b"@HIMN")
_WITH_PARAMETERS_7550 = _WITH_PARAMETERS | frozenset(b"PST")
_DIGITS = frozenset(b"0123456789")
_MOST_PARAMETERS = 12
_HIGHEST = 32767
_LONGEST = 9
"""Digits that are kept of a number."""

BAD_LETTER, BAD_PARAMETER, PARAMETER_RANGE, TOO_MANY = 11, 12, 13, 14
"""I/O errors, as ESC.E answers them."""


@dataclass(frozen=True)
class Command:
    """A device-control sequence; ``error`` is an I/O error number, or 0."""

    letter: str
    parameters: tuple[int, ...] = ()
    error: int = 0


@dataclass
class ControlChannel:
    """Splits a stream of bytes into device control and HP-GL, byte by byte."""

    letters: str = HP_7475
    """Those that the machine knows; parameters are looked for behind some of them."""
    _seen: str = ""
    """"", "esc", "dot", or the letter whose parameters are coming in."""
    _fields: list[str] = field(default_factory=list)

    @property
    def under_way(self) -> bool:
        """Whether a sequence has begun and not ended."""
        return bool(self._seen)

    def feed(self, byte: int) -> int | Command | None:
        """Take a byte: it comes back as HP-GL, ends a sequence, or is swallowed (None)."""
        if byte == ESC:  # whatever was begun is given up
            self._seen = "esc"
            return None
        if not self._seen:
            return byte
        if self._seen == "esc":
            return self._dot(byte)
        if self._seen == "dot":
            return self._letter(byte)
        return self._parameter(byte)

    def _dot(self, byte: int) -> Command | None:
        self._seen = "dot" if byte == ord(".") else ""
        return None if self._seen else Command(chr(byte), error=BAD_LETTER)

    def _letter(self, byte: int) -> Command | None:
        with_parameters = _WITH_PARAMETERS_7550 if "P" in self.letters else _WITH_PARAMETERS
        if byte in with_parameters:
            self._seen, self._fields = chr(byte), [""]
            return None
        self._seen = ""
        known = chr(byte) in self.letters
        return Command(chr(byte), error=0 if known else BAD_LETTER)

    def _parameter(self, byte: int) -> Command | None:
        if byte in _DIGITS:
            self._fields[-1] = (self._fields[-1] + chr(byte))[:_LONGEST]
        elif byte == ord(";"):
            self._fields = [*self._fields, ""][: _MOST_PARAMETERS + 1]
        else:
            return self._finished(0 if byte == ord(":") else BAD_PARAMETER)
        return None

    def _finished(self, error: int) -> Command:
        letter, self._seen = self._seen, ""
        values = tuple(int(text or 0) for text in self._fields)
        if not error and len(values) > _MOST_PARAMETERS:
            error = TOO_MANY
        if not error and max(values) > _HIGHEST:
            error = PARAMETER_RANGE
        return Command(letter, values, error)
