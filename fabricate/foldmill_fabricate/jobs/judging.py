"""Judge an answer when it is given, by the rules a terminal has too, so that a person meets it."""

from __future__ import annotations

from collections.abc import Callable

from foldmill_fabricate import gates
from foldmill_fabricate.gates import Request
from foldmill_fabricate.jobs.errors import JobRefused
from foldmill_fabricate.jobs.hands import as_answer, as_word
from foldmill_fabricate.jobs.values import Kind, Question, Reply
from foldmill_fabricate.passes import Face, Gate, Plan, SetUp
from foldmill_fabricate.plotter.ledger import Ledger, Said, Word
from foldmill_fabricate.plotter.ledger.words import refuse

_GATES = frozenset(gate.value for gate in Gate)


def judge(question: Question, reply: Reply, plan: Callable[[], Plan], ledger: Ledger) -> None:
    """Raise CannotSend, LedgerRefused or JobRefused for an answer that cannot be.

    plan : reads the job's plan; only a gate needs it. To end the job may always be said.
    """
    if not reply.ok:
        return
    if question.kind.value in _GATES:
        gates.check(_request(question, plan()), as_answer(reply, ""))
    elif question.kind is Kind.JUDGE and not reply.verdict:
        raise JobRefused("Say what the test cut looks like: good, again or stop.")
    elif question.kind is Kind.DECIDE:
        _judge_word(question, reply, ledger)


def _judge_word(question: Question, reply: Reply, ledger: Ledger) -> None:
    word = as_word(reply, proved(question))
    if word is None:
        raise JobRefused(
            "Nothing proves where the machine stands: look at the sheet and say at which stroke it "
            "goes on, that all is cut, or that the sheet is given up."
        )
    if question.program is not None:
        refuse(ledger.record(question.sheet, question.program), word)


def proved(question: Question) -> Said | None:
    """Return the word that the machine's own place speaks for; None where it proves none."""
    if "proved" not in question.data:
        return None
    word = Word(question.data["proved"])
    stroke = int(question.data.get("stroke", 1)) - 1
    return (
        Said(word, stroke, int(question.data.get("vertex", 0)))
        if word is Word.GO_ON
        else Said(word)
    )


def _request(question: Question, plan: Plan) -> Request:
    known = question.data.get("thickness")
    return Request(
        Gate(question.kind.value),
        Face(question.face),
        _setup(question, plan),
        plan,
        question.sheet,
        None if known is None else float(known),
        bool(question.data.get("fitted")),
    )


def _setup(question: Question, plan: Plan) -> SetUp:
    every = [one for work in plan.passes for one in work.setups]
    named = [one for one in every if one.name == question.setup]
    return named[0] if named else every[0]
