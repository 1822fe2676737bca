"""What the ledger tells: sheets, the programs of each, and how far they have come."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

Span = tuple[int, int]
"""Strokes from the first to before the second."""


class State(StrEnum):
    """Where a program of a sheet stands."""

    READY = "ready"
    """may be begun, from its stroke ``first`` on"""
    RUNNING = "running"
    """somebody holds its token"""
    INTERRUPTED = "interrupted"
    """ended before its end; only a person's word goes on"""
    UNCONFIRMED = "sent, not confirmed"
    """all of it left this computer, and the machine could not say more"""
    DONE = "done"
    """confirmed by the machine, or by a person"""
    SPOILED = "spoiled"
    """its sheet is given up"""


FOLLOWS: Mapping[State, frozenset[State]] = {
    State.READY: frozenset({State.RUNNING, State.DONE, State.SPOILED}),
    State.RUNNING: frozenset({State.INTERRUPTED, State.UNCONFIRMED, State.DONE, State.SPOILED}),
    State.INTERRUPTED: frozenset({State.READY, State.DONE, State.SPOILED}),
    State.UNCONFIRMED: frozenset({State.READY, State.DONE, State.SPOILED}),
    State.DONE: frozenset({State.SPOILED}),
    State.SPOILED: frozenset(),
}
"""Which state may follow which. From interrupted and unconfirmed only a person's word leads on.

So does one from running to spoiled: it takes the token from whoever runs the program, and stops it.
"""


class Word(StrEnum):
    """What a person may say of a program that was interrupted or not confirmed."""

    GO_ON = "go on"
    """begin again at a stroke; all before it is cut"""
    FINISHED = "finished"
    """all of it is cut"""
    SPOILED = "spoiled"
    """the sheet is given up"""


@dataclass(frozen=True)
class Program:
    """A program of a job, as the ledger needs to know it."""

    name: str
    face: str
    sha256: str
    strokes: int


@dataclass(frozen=True)
class Entry:
    """One run of a program: which strokes, and how it ended."""

    token: int
    first: int
    """Stroke with which it began."""
    vertex: int
    """Vertex of that stroke at which it began; 0 for its start."""
    sent: int
    """Strokes of which at least one byte may have left."""
    acked: int
    """Strokes that are known to be executed; at least ``first``."""
    cut_to: int | None = None
    """A person's word: strokes before it are cut, of those that were doubtful."""

    @property
    def certain(self) -> Span:
        """Strokes that the machine has confirmed in this run, or a person has said are cut."""
        return self.first, max(self.acked, min(self.cut_to or 0, self.sent))

    @property
    def doubtful(self) -> Span:
        """Strokes of this run that may be cut, whole or in part, and of which nobody has spoken."""
        if self.cut_to is not None:
            return self.sent, self.sent
        return self.acked, max(self.acked, self.sent)


@dataclass(frozen=True)
class Answered:
    """What a person did and measured at a gate."""

    when: str
    """UTC, ISO 8601."""
    number: int | None
    """Program before which it was; None for the whole sheet."""
    who: str
    gate: str
    """Such as load, flip, re-register, test-cut."""
    told: Mapping[str, Any]
    """By name, such as thickness (mm), temperature (°C), marks (pairs of mm)."""


@dataclass(frozen=True)
class Record:
    """One program of a sheet, and how far it has come."""

    sheet: str
    number: int
    """0, 1, 2 … in order of work."""
    program: Program
    state: State
    first: int
    """Stroke with which the next run begins."""
    vertex: int
    """Vertex of that stroke at which it begins; 0 for its start."""
    overlap: float
    """mm by which the next run cuts again what is cut already, for through-cuts."""
    note: str
    """Why it ended as it did, a sentence."""
    runs: tuple[Entry, ...] = field(default=())

    @property
    def certain(self) -> tuple[int, ...]:
        """Strokes that are cut, by the machine's answers or a person's word."""
        return _strokes(run.certain for run in self.runs)

    @property
    def doubtful(self) -> tuple[int, ...]:
        """Strokes that may be cut, whole or in part; one that goes on from inside it is."""
        known = {*_strokes(run.doubtful for run in self.runs)}
        known |= {self.first} if self.vertex else set()
        return tuple(sorted(known - {*self.certain}))

    @property
    def left(self) -> tuple[int, ...]:
        """Strokes of which no byte has left."""
        return tuple(sorted({*range(self.program.strokes)} - {*self.certain, *self.doubtful}))


@dataclass(frozen=True)
class SheetRecord:
    """A sheet under work, or finished."""

    id: str
    """Short, to be written on the sheet."""
    job: str
    """SHA-256 of the plan."""
    title: str
    machine: str
    material: str
    begun: str
    """UTC, ISO 8601."""
    records: tuple[Record, ...]

    @property
    def digest(self) -> str:
        """SHA-256 of what is certain, doubtful and left: it changes with every stroke and word."""
        told = [
            (one.number, vars(one.program), one.first, one.vertex, [vars(run) for run in one.runs])
            for one in self.records
        ]
        return hashlib.sha256(json.dumps([self.id, told]).encode()).hexdigest()

    @property
    def is_open(self) -> bool:
        """Whether any of it is still to be made."""
        return any(record.state not in {State.DONE, State.SPOILED} for record in self.records)

    @property
    def is_given_up(self) -> bool:
        """Whether nothing more may be cut on it."""
        return any(record.state is State.SPOILED for record in self.records)

    @property
    def is_begun(self) -> bool:
        """Whether any byte of it may have left."""
        return any(record.runs for record in self.records)


def _strokes(spans: Iterable[Span]) -> tuple[int, ...]:
    return tuple(sorted({stroke for low, high in spans for stroke in range(low, high)}))
