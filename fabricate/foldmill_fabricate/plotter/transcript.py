"""What went over the wire: written down while it goes, and played back.

A transcript is a file of JSON lines: ``t`` (s since the first), ``to`` (``machine`` or ``host``)
and ``data`` (hexadecimal). Played back it is a port that answers what was answered, and refuses
anything else than what was written.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TextIO

from foldmill_fabricate.plotter.clock import Clock, VirtualClock
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.space import is_full, sentence

MACHINE, HOST = "machine", "host"
_DIGITS = 6
_EXACT = 1e-6
"""s to which times are written down; an answer must not be late for that."""


class Recorded:
    """A port whose bytes are written down; whatever else it can do, the port itself does."""

    def __init__(self, port: Any, clock: Clock, to: TextIO) -> None:
        self.__dict__.update(_port=port, _clock=clock, _to=to, _began=clock.now(), _broken=False)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.__dict__["_port"], name)

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self.__dict__["_port"], name, value)

    def write(self, data: bytes) -> Any:
        """Write down and write."""
        self._note(MACHINE, data)
        return self.__dict__["_port"].write(data)

    def read(self, size: int = 1) -> bytes:
        """Read and write down."""
        data: bytes = self.__dict__["_port"].read(size)
        if data:
            self._note(HOST, data)
        return data

    def _note(self, direction: str, data: bytes) -> None:
        seconds = self.__dict__["_clock"].now() - self.__dict__["_began"]
        row = {"t": round(seconds, _DIGITS), "to": direction, "data": data.hex()}
        if self.__dict__["_broken"]:
            return  # the machine is being stopped: that must reach it
        try:
            self.__dict__["_to"].write(json.dumps(row) + "\n")
        except OSError as error:
            self.__dict__["_broken"] = True
            raise _unwritten(Path(self.__dict__["_to"].name), error) from None


@contextmanager
def recorded(port: Any, clock: Clock, path: Path | None) -> Iterator[Any]:
    """Give the port, written down in a new file where one is named.

    Raises PlotterError where the file cannot be written, and so does whatever the port is used for
    then; but only once: to stop the machine it goes on to be of use.
    """
    if path is None:
        yield port
        return
    try:
        to = path.open("w", encoding="ascii", buffering=1)
    except OSError as error:
        raise _unwritten(path, error) from None
    try:
        yield Recorded(port, clock, to)
    finally:
        with suppress(OSError):  # of what could not be written the delivery has spoken
            to.close()


def _unwritten(path: Path, error: OSError) -> PlotterError:
    """Return what is said of a transcript that takes no more; nothing is sent without one."""
    if is_full(error):
        return PlotterError(f"The transcript {path.name} has no room. {sentence(path)}")
    return PlotterError(f"The transcript {path} cannot be written: {error.strerror}.")


class Replayed:
    """A port made of a transcript, on a clock of its own.

    An answer comes as long after what was written before it as it did then, so that it does not
    matter how long a person took between two programs.
    """

    is_open = True
    out_waiting = 0
    timeout: float | None = 0.02
    dsr = cts = True

    def __init__(self, rows: Iterable[str]) -> None:
        self.clock = VirtualClock()
        read = [json.loads(row) for row in rows if row.strip()]
        self._written = b"".join(bytes.fromhex(row["data"]) for row in read if row["to"] == MACHINE)
        self._at = 0
        self._when: dict[int, float] = {0: 0.0}
        """By bytes written: when they were."""
        self._answers: deque[tuple[float, int, bytes]] = deque()
        """How long after how many bytes which answer came."""
        sent, last = 0, 0.0
        for row in read:
            data, at = bytes.fromhex(row["data"]), float(row["t"])
            if row["to"] == MACHINE:
                sent, last = sent + len(data), at
            else:
                self._answers.append((at - last, sent, data))
        self._heard = b""

    @classmethod
    def of(cls, path: Path) -> Replayed:
        """Read a transcript's file."""
        return cls(path.read_text().splitlines())

    @property
    def is_over(self) -> bool:
        """Whether all was written that had been."""
        return self._at == len(self._written)

    @property
    def in_waiting(self) -> int:
        """Bytes that were answered by this time, to what has been written."""
        while self._answers and self._is_due:
            self._heard += self._answers.popleft()[2]
        return len(self._heard)

    @property
    def _is_due(self) -> bool:
        return self._answers[0][1] <= self._at and self._due <= self.clock.now()

    @property
    def _due(self) -> float:
        """When the next answer comes, s; it is counted from the last writing it can follow."""
        after, sent, _ = self._answers[0]
        when: float = self._when.get(sent, self._when[self._at])
        return when + after - 2 * _EXACT

    def write(self, data: bytes) -> int:
        """Take what was written then; raises PlotterError for anything else."""
        wanted = self._written[self._at : self._at + len(data)]
        if data != wanted:
            raise PlotterError(
                f"Byte {self._at} of the transcript: {wanted!r} was written then, {data!r} now."
            )
        self._at += len(data)
        self._when[self._at] = self.clock.now()
        return len(data)

    def read(self, size: int = 1) -> bytes:
        """Return what is there, or wait for the next answer up to the time-out."""
        if self.in_waiting < size:
            limit = self.clock.now() + (self.timeout or 0.0)
            due = self._due if self._answers else limit
            self.clock.sleep_until(min(max(due, self.clock.now()), limit))
            if self.in_waiting < size:
                self.clock.sleep_until(limit)
        taken, self._heard = self._heard[:size], self._heard[size:]
        return taken

    def reset_input_buffer(self) -> None:
        """Drop what has come."""
        self._heard = self._heard[self.in_waiting :]

    def reset_output_buffer(self) -> None:
        """Nothing waits."""

    def close(self) -> None:
        """Nothing is held."""

    def __enter__(self) -> Replayed:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
