"""Questions of device control that may still be answered, and which of them a number answers.

A machine answers in order, or drops a question that meets another answer. Which of the two it was
nobody knows by waiting: an answer may only be late. So the question after one in doubt is of the
other kind, and what it is answered by tells: free bytes are more than any error's number, and
answers before it are to questions before it. After it nothing is in doubt.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

LAST_ERROR = 18
"""The highest number of an I/O error that ESC.E answers; above it are free bytes."""


@dataclass(frozen=True)
class Question:
    """ESC.B or ESC.E, and what there was before it."""

    of_error: bool
    """Whether it is ESC.E."""
    sent: int
    """Units written before it."""
    proved: int
    """Units proved before it."""
    least: int
    """Bytes that the machine has free at least when it comes there."""
    when: float
    """s"""


class Questions:
    """Those to which an answer may still come, the oldest first: two at most."""

    def __init__(self) -> None:
        self._open: deque[Question] = deque()
        self.awaited: Question | None = None
        """The one that is waited for."""

    @property
    def doubtful(self) -> Question | None:
        """One that was dropped, or whose answer is late."""
        first = self._open[0] if self._open else None
        return None if first is self.awaited else first

    @property
    def open(self) -> bool:
        """Whether any answer may still come."""
        return bool(self._open)

    @property
    def tells_soon(self) -> bool:
        """Whether another question would tell at once what has become of the one waited for."""
        return (
            len(self._open) == 1 and not self._open[0].of_error and self._open[0].least > LAST_ERROR
        )

    def ask(self, question: Question) -> None:
        """Ask another; it is waited for."""
        self._open.append(question)
        self.awaited = question

    def doubt(self) -> None:
        """Wait no longer for the last; where two have met other answers, both were dropped."""
        self.awaited = None
        if len(self._open) > 1:
            self._open.clear()

    def answered(self, number: int) -> Question | None:
        """Take and return the question that a number answers; None where it answers none.

        What was asked before that one was dropped.
        """
        for place, question in enumerate(self._open):
            if len(self._open) == 1 or question.of_error == (number <= LAST_ERROR):
                for _ in range(place + 1):
                    self._open.popleft()
                self.awaited = self.awaited if self._open else None
                return question
        return None
