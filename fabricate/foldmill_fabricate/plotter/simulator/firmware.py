"""What the frame of a machine asks of its firmware, whichever language that speaks."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

OVERLAP, FRAMING, OVERFLOW = 10, 15, 16
"""What went wrong on the line, by the numbers that HP's machines answer to ESC.E."""


class Plain(NamedTuple):
    """What a machine now takes off the line without anything else happening."""

    bytes: frozenset[int] = frozenset()
    most: int = 0
    """How many of them."""


class Careful:
    """Of firmware that looks at each byte by itself."""

    plain = Plain()

    def hear_plain(self, data: bytes) -> None:
        """There are none."""


class Firmware(Protocol):
    """Takes bytes off the line and says what the motors do next."""

    def start(self, now: float) -> None:
        """Begin as after switching on."""

    def hear(self, byte: int, now: float) -> None:
        """Take a byte off the line."""

    @property
    def plain(self) -> Plain:
        """What only lengthens the buffer, and nothing else, as long as nothing else happens."""

    def hear_plain(self, data: bytes) -> None:
        """Take such bytes off the line."""

    def begin(self, now: float) -> float | None:
        """Begin the next thing and return how long it takes, s; None where there is nothing."""

    def ended(self, now: float) -> None:
        """Learn that the thing begun last has ended."""

    def settle(self, now: float) -> None:
        """Say what is due now that room was made in the buffer, or the machine stands."""

    def fault(self, error: int) -> None:
        """Note an I/O error of the line."""

    @property
    def ready(self) -> bool:
        """Level of the ready line: True for "send"."""

    @property
    def holds(self) -> bool:
        """Whether it has said "wait" by a character, and nothing since."""

    def wait(self, stuck: bool, now: float) -> None:
        """Say "wait", and nothing else until it is no longer stuck."""

    def scanner(self) -> Callable[[int], bool]:
        """Return a function that tells byte for byte whether it belongs to the program."""
