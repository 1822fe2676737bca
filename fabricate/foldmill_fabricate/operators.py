"""Whoever stands at the machine: does what a gate asks for, and says what only a person can."""

from __future__ import annotations

from enum import StrEnum
from typing import Protocol

from foldmill_fabricate.gates import Answer, Request
from foldmill_fabricate.passes import Gate
from foldmill_fabricate.plotter.ledger import Record, Said, Word
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.simulator import devices


class Verdict(StrEnum):
    """What a person says of a test cut."""

    GOOD = "good"
    AGAIN = "again"
    """the tool was set anew; cut another"""
    STOP = "stop"


class Operator(Protocol):
    """Whoever stands at the machine."""

    @property
    def who(self) -> str:
        """Who has spoken last; empty for whoever is at the computer."""
        ...

    def ready(self, request: Request) -> Answer | None:
        """Do what the gate asks for; None ends the job before the set-up starts."""
        ...

    def wants_test_cut(self, request: Request) -> bool:
        """Say whether an untested preset is tried in the waste first."""
        ...

    def judge(self, request: Request) -> Verdict:
        """Look at a test cut, once the machine stands still."""
        ...

    def decide(self, record: Record, found: Start | None, told: str) -> Said | None:
        """Say how a program goes on that ended before its end; None leaves it as it is.

        found : where the machine proves to stand; None where it cannot, or stands nowhere. told :
        what is known of where it stands, a sentence; empty for nothing.
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

    who = ""

    def __init__(self, url: str) -> None:
        self._simulator = devices.behind(url)

    def ready(self, request: Request) -> Answer | None:
        """Do it at once."""
        if request.gate is Gate.LOAD:
            self._simulator.new_sheet()
        turned = request.gate in {Gate.LOAD, Gate.FLIP, Gate.RE_REGISTER}
        if turned and self._simulator.sheet.up is not request.face:
            self._simulator.flip()
        return Answer(sheet=request.sheet)

    def wants_test_cut(self, request: Request) -> bool:  # noqa: ARG002
        """Nothing can be learnt of a material that is not there."""
        return False

    def judge(self, request: Request) -> Verdict:  # noqa: ARG002
        """Find every cut good."""
        return Verdict.GOOD

    def decide(self, record: Record, found: Start | None, told: str) -> Said | None:  # noqa: ARG002
        """Go on from the proved place."""
        return said(record, found) if found else None

    def has_finished(self, record: Record) -> bool:  # noqa: ARG002
        """Wait until nothing moves any more."""
        self._simulator.advance()
        return self._simulator.device.idle
