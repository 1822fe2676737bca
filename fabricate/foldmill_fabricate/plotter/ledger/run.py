"""A run of a program: the one hand that may write what was sent and what was confirmed."""

from __future__ import annotations

from typing import Protocol

from foldmill_fabricate.plotter.errors import Fenced
from foldmill_fabricate.plotter.ledger.values import State


class Keeper(Protocol):
    """Who writes down how far a run is."""

    def write(self, run: Run, sent: int, acked: int) -> None:
        """Raise Fenced where the run lost its token."""
        ...

    def end(self, run: Run, state: State, why: str) -> None:
        """Raise Fenced where the run lost its token."""
        ...

    def loss(self, run: Run) -> Fenced | None:
        """Return why a run may not go on; None while it holds its token."""
        ...

    @property
    def is_shared(self) -> bool:
        """Whether anybody else can reach what is written down."""
        ...


class Run:
    """Holds a program's token. What writes raises Fenced once somebody else holds it."""

    def __init__(
        self, ledger: Keeper, sheet: str, number: int, token: int, first: int, strokes: int
    ) -> None:
        self._ledger, self._strokes = ledger, strokes
        self.sheet, self.number, self.token, self.first = sheet, number, token, first
        self.sent = self.acked = first

    def advance(self, sent: int, acked: int) -> None:
        """Write down, before their bytes leave, that strokes before ``sent`` may be cut.

        acked : strokes that the machine has confirmed. Neither ever falls. Nothing is written
        where nothing has changed.
        """
        sent, acked = max(min(sent, self._strokes), self.sent), max(acked, self.acked)
        if (sent, acked) != (self.sent, self.acked):
            self._ledger.write(self, sent, acked)
            self.sent, self.acked = sent, acked

    def end(self, state: State, note: str = "") -> None:
        """Give the token back; ``note`` : why, a sentence."""
        self._ledger.end(self, state, note)

    def cut_off(self, note: str) -> None:
        """Give the token back before the end; a loss of it is told together with the note."""
        try:
            self.end(State.INTERRUPTED, note)
        except Fenced as lost:
            raise type(lost)(f"{lost} {note}") from None

    def loss(self) -> Fenced | None:
        """Return why this run may not go on, Fenced or Spoiled; None while it holds its token."""
        return self._ledger.loss(self)

    @property
    def is_shared(self) -> bool:
        """Whether anybody else can take the token."""
        return self._ledger.is_shared
