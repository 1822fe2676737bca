"""One direction of a serial line: bytes leave one after the other, ten bits each (8N1)."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from math import inf


class Transmitter:
    """Sends queued bytes at the baud rate; can be held by XOFF and let go by XON."""

    def __init__(self, byte_time: float) -> None:
        self.byte_time = byte_time
        self.queue: deque[int] = deque()
        self.urgent: deque[int] = deque()
        """XON and XOFF, which overtake what is queued."""
        self.held = False
        self.grace = 0
        """Bytes that still leave after XOFF, because they are in the chip's FIFO."""
        self.not_before = 0.0
        """When the next queued byte may leave, s: the time a machine needs to answer."""
        self.between = 0.0
        """s of rest between two bytes."""
        self.done = inf
        """When the byte on its way is over, s."""
        self._byte = 0

    @property
    def sending(self) -> bool:
        """Whether a byte is on its way."""
        return self.done < inf

    @property
    def next_event(self) -> float:
        """When something happens here by itself, s; infinite for never."""
        if self.done < inf:
            return self.done
        waiting = self.urgent or (self.queue and self._may_send)
        return self.not_before if waiting else inf

    def put(self, data: Iterable[int], now: float) -> None:
        """Queue bytes."""
        self.queue.extend(data)
        self._start(now)

    def put_first(self, byte: int, now: float) -> None:
        """Queue a byte that overtakes."""
        self.urgent.append(byte)
        self._start(now)

    def hold(self, grace: int) -> None:
        """Stop after ``grace`` further bytes."""
        self.held, self.grace = True, grace

    def release(self, now: float) -> None:
        """Go on."""
        self.held = False
        self._start(now)

    def silence(self) -> None:
        """Lose what is queued and what is on its way."""
        self.queue.clear()
        self.urgent.clear()
        self.done = inf

    def happen(self, now: float) -> int | None:
        """Do what is due; return the byte that has arrived at the other end, or None."""
        if self.done > now:
            self._start(now)
            return None
        byte, self.done = self._byte, inf
        self._start(now)
        return byte

    def run(
        self, wanted: frozenset[int], most: int, until: float, before: float
    ) -> tuple[bytearray, float]:
        """Let bytes arrive one after the other; return them, and when the last of them did, s.

        They end with the first that is not wanted, after ``most`` of them, or where the next would
        arrive after ``until`` or not before ``before``. Nothing holds or overtakes them.
        """
        queue, byte, done, last = self.queue, self._byte, self.done, inf
        taken = bytearray()
        while byte in wanted and done <= until and done < before and len(taken) < most:
            taken.append(byte)
            last = done
            if not queue:
                done = inf
                break
            byte, done = queue.popleft(), last + self.byte_time + self.between
        self._byte, self.done = byte, done
        return taken, last

    @property
    def _may_send(self) -> bool:
        return not self.held or self.grace > 0

    def _start(self, now: float) -> None:
        if self.done < inf:
            return
        if self.urgent:
            self._byte = self.urgent.popleft()
        elif self.queue and self._may_send and now >= self.not_before:
            self._byte = self.queue.popleft()
            self.grace -= self.held
        else:
            return
        self.done = now + self.byte_time + self.between
