"""The operator of a job: whoever answers its questions, at a terminal or in a browser.

Answers are judged when they are given (``judging``), so that a person meets the refusal. What waits
here hears of a pause, a cancel and the end of the process, too.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from threading import Event
from typing import Any

from foldmill_fabricate import instructions
from foldmill_fabricate.gates import Answer, Request
from foldmill_fabricate.jobs.asking import Asked
from foldmill_fabricate.jobs.errors import Cancelled, Leave
from foldmill_fabricate.jobs.states import JobState
from foldmill_fabricate.jobs.store import CANCEL, JobStore
from foldmill_fabricate.jobs.values import Kind, Question, Reply
from foldmill_fabricate.operators import SimulatedOperator, Verdict, said
from foldmill_fabricate.plotter.errors import LedgerFailed, Spoiled
from foldmill_fabricate.plotter.ledger import Record, Said, Word, account
from foldmill_fabricate.plotter.resume import Start

LOOK = 0.2
"""s between two looks for an answer."""


class Hands:
    """Asks in the name of a job, as the holder of its token, and waits for the answer.

    url : of the plotter; a simulated one's sheet is laid and turned for whoever answers.
    """

    def __init__(
        self, store: JobStore, job: str, token: int, leaving: Event, url: str = ""
    ) -> None:
        self._store, self._job, self._token, self._leaving = store, job, token, leaving
        self._simulated = url if url.startswith("sim://") else ""
        self.who = ""
        self.sheet = ""
        """Id of the sheet that is worked on, while it is one that may be given up."""

    def ready(self, request: Request) -> Answer:
        """Ask for what a gate asks for."""
        text = instructions.instruction(_undrawn(request))
        data = {"thickness": request.thickness, "fitted": request.fitted}
        reply, who = self.ask(Kind(request.gate.value), text, request, data=data)
        self._go_on(reply)
        if self._simulated:  # no hand reaches that sheet
            SimulatedOperator(self._simulated).ready(request)
        return as_answer(reply, who)

    def wants_test_cut(self, request: Request) -> bool:
        """Ask."""
        text = (
            f"The preset {request.plan.material.title} is untested. A test cut of 20 mm in the "
            f"waste for {request.setup.name}?"
        )
        return self.ask(Kind.TRY, text, request)[0].ok

    def judge(self, request: Request) -> Verdict:
        """Ask what it looks like."""
        what = "bends without tearing" if request.setup.process == "score" else "is cut through"
        text = (
            f"Wait until the machine stands still, and look whether the sheet {what} there: good; "
            "again, once the tool is set anew; or stop."
        )
        reply, _ = self.ask(Kind.JUDGE, text, request)
        return Verdict(reply.verdict) if reply.ok and reply.verdict else Verdict.STOP

    def decide(self, record: Record, found: Start | None, told: str) -> Said | None:
        """Tell what is certain and ask how it goes on."""
        proved = said(record, found) if found else None
        lines = [f"{record.program.name} of sheet {record.sheet} ended early. {record.note}"]
        lines += [account(record), told]
        lines += [f"The machine stands where it can {proved}."] if proved else []
        place = {"stroke": proved.stroke + 1, "vertex": proved.vertex} if proved else {}
        data = {"proved": proved.word.value, **place} if proved else {}
        text = "\n".join(line for line in lines if line)
        reply, who = self.ask(Kind.DECIDE, text, record=record, data=data)
        self._go_on(reply)
        word = as_word(reply, proved)
        return replace(word, who=who) if word else None

    def has_finished(self, record: Record) -> bool:
        """Ask: the machine cannot say."""
        text = (
            f"All of {record.program.name} is sent, and this machine cannot say when it is done. "
            "Wait until it stands still and look at the sheet: is it done?"
        )
        return self.ask(Kind.FINISHED, text, record=record)[0].ok

    def ask(
        self,
        kind: Kind,
        text: str,
        request: Request | None = None,
        *,
        record: Record | None = None,
        sheet: str = "",
        data: Mapping[str, Any] | None = None,
    ) -> tuple[Reply, str]:
        """Ask, wait for the answer, and return it with the name of who gave it.

        Raises Cancelled, Leave, and Spoiled where the sheet is given up before it is answered.
        """
        asked = Asked(
            self._job,
            kind,
            text,
            sheet=request.sheet if request else record.sheet if record else sheet,
            program=record.number if record else None,
            setup=request.setup.name if request else "",
            face=request.face.value if request else record.program.face if record else "",
            data=data or {},
        )
        self._store.move(self._job, self._token, JobState.RUNNING)
        reply = self._wait(self._store.ask(self._token, asked))
        self._store.move(self._job, self._token, JobState.RUNNING)
        self.who = reply[1]
        return reply

    def _go_on(self, reply: Reply) -> None:
        """Raise Cancelled where the answer is to end the job."""
        if not reply.ok:
            raise Cancelled("Ended by a person.")

    def _wait(self, question: Question) -> tuple[Reply, str]:
        while True:
            with suppress(LedgerFailed):  # the machine stands still: the question can wait
                self.heed()
                self._heed_sheet()
                reply = self._store.reply(question.id)
                if reply is not None:
                    return reply
            self._leaving.wait(LOOK)

    def _heed_sheet(self) -> None:
        """Raise Spoiled where the sheet is given up meanwhile: nothing more is asked of it then."""
        if self.sheet and self._store.ledger.sheet(self.sheet).is_given_up:
            raise Spoiled(f"Sheet {self.sheet} was given up.")

    def heed(self) -> None:
        """Raise Cancelled or Leave where job or process are to end, Fenced where it is lost."""
        if self._leaving.is_set():
            raise Leave("The service ends.")
        if self._store.wish(self._job, self._token) == CANCEL:
            raise Cancelled("Cancelled.")


def as_answer(reply: Reply, who: str) -> Answer:
    """Return a reply as what a gate is answered with."""
    return Answer(
        reply.sheet,
        reply.thickness,
        reply.temperature,
        reply.exposure,
        reply.touched,
        reply.marks,
        who,
    )


def as_word(reply: Reply, proved: Said | None) -> Said | None:
    """Return a reply as a word on a program in doubt; None where it says nothing."""
    if not reply.word:
        return proved
    word = Word(reply.word)
    if word is not Word.GO_ON:
        return Said(word)
    if not reply.stroke:
        return proved
    return Said(word, reply.stroke - 1, reply.vertex, reply.overlap)


def _undrawn(request: Request) -> Request:
    """Leave the drawing of the flip out: who answers may be elsewhere, and gets it from there."""
    return replace(request, picture=None)
