"""Where a job stands, and which state may follow which: one table, printed in the docs."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum


class JobState(StrEnum):
    """Where a job stands."""

    PLANNING = "planning"
    """a design that is being made into programs"""
    SUBMITTED = "submitted"
    """waits for its plotter"""
    RUNNING = "running"
    """its plotter is at work, or about to be"""
    WAITING = "waiting"
    """a person has to do something at the machine, and to say so"""
    PAUSED = "paused"
    """a person wants nothing more to be cut for now; the tool is up"""
    NEEDS_OPERATOR = "needs operator"
    """nobody can know how it goes on but a person who looks at the sheet"""
    DONE = "done"
    """all its sheets are made"""
    CANCELLED = "cancelled"
    """a person has ended it"""
    FAILED = "failed"
    """it cannot be made, or its sheet was given up"""


_S = JobState
_ENDED: frozenset[JobState] = frozenset()
FOLLOWS: Mapping[JobState, frozenset[JobState]] = {
    _S.PLANNING: frozenset({_S.SUBMITTED, _S.FAILED, _S.CANCELLED}),
    _S.SUBMITTED: frozenset({_S.RUNNING, _S.PAUSED, _S.CANCELLED}),
    _S.RUNNING: frozenset(
        {_S.WAITING, _S.PAUSED, _S.NEEDS_OPERATOR, _S.DONE, _S.CANCELLED, _S.FAILED}
    ),
    _S.WAITING: frozenset({_S.RUNNING, _S.NEEDS_OPERATOR, _S.CANCELLED}),
    _S.PAUSED: frozenset({_S.SUBMITTED, _S.RUNNING, _S.NEEDS_OPERATOR, _S.CANCELLED}),
    _S.NEEDS_OPERATOR: frozenset({_S.RUNNING, _S.CANCELLED}),
    _S.DONE: _ENDED,
    _S.CANCELLED: _ENDED,
    _S.FAILED: _ENDED,
}
"""Which state may follow which; none follows an end."""

QUEUED = frozenset({_S.SUBMITTED})
ACTIVE = frozenset({_S.RUNNING, _S.WAITING, _S.PAUSED, _S.NEEDS_OPERATOR})
"""States in which a job may have its plotter; a paused one has it only once it was begun."""
ENDED = frozenset(state for state, next_ in FOLLOWS.items() if not next_)


def table() -> str:
    """Return the table as Markdown, as it stands in the docs."""
    rows = [
        f"| {state.value} | {', '.join(s.value for s in JobState if s in FOLLOWS[state]) or '–'} |"
        for state in JobState
    ]
    return "\n".join(["| a job that is | may become |", "|---|---|", *rows]) + "\n"
