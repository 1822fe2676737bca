"""Whoever stands at the machine: does what a gate asks for, and says what only a person can."""

from __future__ import annotations

from typing import Protocol

from foldmill_fabricate.passes import Face, Gate, Plan, SetUp
from foldmill_fabricate.plotter.ledger import Record, Said, Word
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.simulator import devices


class Operator(Protocol):
    """Whoever stands at the machine."""

    def ready(self, gate: Gate, face: Face, setup: SetUp, plan: Plan) -> bool:
        """Do what the gate asks for, ``face`` up; False ends the job before the set-up starts."""
        ...

    def decide(self, record: Record, found: Start | None) -> Said | None:
        """Say how a program goes on that ended before its end; None leaves it as it is.

        found : where the machine proves to stand; None where it cannot, or stands nowhere.
        """
        ...

    def has_finished(self, record: Record) -> bool:
        """Say whether a machine that cannot say so has cut all of a program."""
        ...


def said(record: Record, found: Start) -> Said:
    """Return the word that goes on from a place."""
    if found.stroke >= record.program.strokes:
        return Said(Word.FINISHED)
    return Said(Word.GO_ON, found.stroke, found.vertex)


class SimulatedOperator:
    """Hands for a simulated plotter in this process: lays and turns its sheet, agrees to all.

    What is in doubt it decides only where the machine proves its place.
    """

    def __init__(self, url: str) -> None:
        self._simulator = devices.behind(url)

    def ready(self, gate: Gate, face: Face, setup: SetUp, plan: Plan) -> bool:  # noqa: ARG002
        """Do it at once."""
        if gate is Gate.LOAD:
            self._simulator.new_sheet()
        if gate in {Gate.LOAD, Gate.FLIP} and self._simulator.sheet.up is not face:
            self._simulator.flip()
        return True

    def decide(self, record: Record, found: Start | None) -> Said | None:
        """Go on from the proved place."""
        return said(record, found) if found else None

    def has_finished(self, record: Record) -> bool:  # noqa: ARG002
        """Wait until nothing moves any more."""
        self._simulator.advance()
        return self._simulator.device.idle
