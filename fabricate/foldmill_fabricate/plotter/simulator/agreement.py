"""What host and machine have agreed on: who waits for whom, and how answers look.

ESC.@ H I M N P R change it. Source: HP 7470A Interfacing and Programming Manual, chapter 10; ESC.P
as on the HP 7550A.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from foldmill_fabricate.machines import Machine

XON, XOFF, ENQ, ACK = 0x11, 0x13, 0x05, 0x06
_BLOCK = 80
"""Default block size of ESC.H and ESC.I, bytes."""
_MANY = (0,) * 12


@dataclass
class Agreement:
    """Settings of the line; a character of 0 is none."""

    xon: int = 0
    xoff: int = 0
    hardware: bool = False
    """Whether the ready line follows the room in the buffer."""
    low: int = _BLOCK
    """Bytes of room at which it says "wait"."""
    block: int = _BLOCK
    """Bytes of room that an ENQ asks for."""
    enq: int = 0
    """0: any ENQ (5) is answered at once, whatever the room."""
    acks: tuple[int, ...] = (ACK,)
    immediate: tuple[int, ...] = ()
    """What an ENQ is answered with while there is no room, in mode 2."""
    mode: int = 2
    """1 as by ESC.H, 2 as by ESC.I: only there is ``immediate`` sent."""
    delay: float = 0.0
    """s before an answer, besides the machine's own time"""
    between: float = 0.0
    """s between the bytes of an answer"""
    trigger: int = 0
    """The host's sign that it will listen: answers wait for it."""
    ends: tuple[int, ...] = (13,)
    begins: int = 0

    @classmethod
    def built_in(cls, machine: Machine) -> Self:
        """Return what a machine begins with, by its profile."""
        kind = machine.serial.handshake
        new = cls(low=min(128, machine.serial.buffer // 4))
        new.xon, new.xoff = (XON, XOFF) if kind == "xon-xoff" else (0, 0)
        new.hardware = kind in ("rts-cts", "dtr")
        new.enq = ENQ if kind == "enq-ack" else 0
        new.block = min(_BLOCK, machine.serial.buffer // 2)
        return new

    def obey(self, letter: str, parameters: tuple[int, ...]) -> None:
        """Change it as ESC.letter says; R is the caller's."""
        given = parameters + _MANY
        doing = {
            "@": self._wire, "H": self._enquire, "I": self._invite, "M": self._dress,
            "N": self._space, "P": self._standard,
        }  # fmt: skip
        doing[letter](given)

    def _wire(self, given: tuple[int, ...]) -> None:
        nothing_said = not any(given)
        self.hardware = bool(given[1] & 1) or nothing_said
        self.low = self.block

    def _enquire(self, given: tuple[int, ...]) -> None:
        self._ask(1, given)

    def _invite(self, given: tuple[int, ...]) -> None:
        """Mode 2: without an ENQ, what follows is the XON character."""
        if given[1] or not given[2]:
            self._ask(2, given)
            self.xon = 0
        else:
            self.xon, self.low = given[2], given[0] or _BLOCK

    def _ask(self, mode: int, given: tuple[int, ...]) -> None:
        self.mode, self.block, self.enq = mode, given[0] or _BLOCK, given[1]
        self.acks = tuple(each for each in given[2:] if each) or (ACK,)

    def _dress(self, given: tuple[int, ...]) -> None:
        self.delay, self.trigger = given[0] / 1000, given[1]
        self.ends = tuple(each for each in given[3:5] if each) or (13,)
        self.begins = given[5]

    def _space(self, given: tuple[int, ...]) -> None:
        """The characters are XOFF where there is an XON, else the immediate answer to ENQ."""
        self.between, self.xoff = given[0] / 1000, given[1]
        self.immediate = tuple(each for each in given[1:] if each)

    def _standard(self, given: tuple[int, ...]) -> None:
        kind = given[0]
        self.xon, self.xoff = (XON, XOFF) if kind == 1 else (0, 0)
        self.enq = ENQ if kind == 2 else 0
        self.hardware = kind == 3
