"""The input buffer of a machine, which keeps count of every byte."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field


@dataclass
class Traffic:
    """What came in."""

    received: bytearray = field(default_factory=bytearray)
    """every byte, device control included"""
    program: bytearray = field(default_factory=bytearray)
    """the program only, the dropped bytes included"""
    begun: int = 0
    """bytes of it that have left the buffer because their execution has begun"""
    overruns: int = 0
    """bytes dropped because the buffer was full"""
    discarded: int = 0
    """bytes dropped from the buffer because the host, or IN, said so"""
    fullest: int = 0
    """highest occupancy of the buffer, bytes"""
    split: int = 0
    """times ESC.B came in the middle of an instruction, which real machines garble"""
    errors: Counter[int] = field(default_factory=Counter)
    """I/O errors by number"""


class InputBuffer:
    """Bytes that have come and not been begun."""

    def __init__(self, size: int, traffic: Traffic) -> None:
        self.size, self.traffic = size, traffic
        self.data = bytearray()
        self.dropping = 0
        """How many bytes more are dropped whatever the room."""

    @property
    def free(self) -> int:
        """Bytes that it still takes."""
        return self.size - len(self.data)

    def store(self, byte: int) -> bool:
        """Keep a byte of the program; return False where it is lost."""
        self.traffic.program.append(byte)
        if self.dropping or len(self.data) >= self.size:
            self.dropping -= bool(self.dropping)
            self.traffic.overruns += 1
            return False
        self.data.append(byte)
        if len(self.data) > self.traffic.fullest:
            self.traffic.fullest = len(self.data)
        return True

    def store_all(self, data: bytes) -> None:
        """Keep bytes of the program for which there is room."""
        self.traffic.program += data
        self.data += data
        self.traffic.fullest = max(self.traffic.fullest, len(self.data))

    def discard(self, but: int = 0) -> None:
        """Drop what waits, but for so many bytes at its end."""
        dropped = len(self.data) - but
        self.traffic.discarded += dropped
        del self.data[:dropped]
