"""Every word of a job's history is signed by who has said it, and what nobody said by foldmill."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from fabricate.bench import Bench, small_job, small_plan
from fabricate.jobs.test_work import PATIENCE, at_work
from fabricate.verify import knife_job

from foldmill_fabricate import shelf
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.jobs import Desk, JobState, Kind, Question, Reply, Submission
from foldmill_fabricate.jobs.rows import WORKER
from foldmill_fabricate.operators import Verdict
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.ledger import Ledger
from foldmill_fabricate.plotter.simulator.devices import adjusted

pytestmark = pytest.mark.long

NOBODY = "the account that the service runs under"


@pytest.fixture(autouse=True)
def _account(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let this process run under a name that must sign nothing that somebody else has said."""
    for name in ("LOGNAME", "USER", "LNAME", "USERNAME"):
        monkeypatch.setenv(name, NOBODY)


def until_asked(desk: Desk, job: str) -> list[Question]:
    """Wait until something is asked; nothing is once the job has ended."""
    end = time.monotonic() + PATIENCE
    while not (found := desk.questions(job)) and not desk.job(job).is_ended:
        assert time.monotonic() < end, "it is not asked"
        time.sleep(0.02)
    return found


def test_a_job_is_signed_from_its_submission_to_its_end(desk: Desk, plan: str) -> None:
    job = desk.submit(Submission(plan=plan, plotter="bench"), "sue").id
    people = {Kind.TRY: "tim", Kind.JUDGE: "jo", Kind.TOOL: "tom", Kind.LOAD: "lea"}
    with at_work(desk):
        while desk.job(job).state is not JobState.DONE:
            for one in until_asked(desk, job):
                verdict = "good" if one.kind is Kind.JUDGE else ""
                reply = Reply.model_validate({"sheet": one.sheet, "verdict": verdict})
                desk.answer(one.id, reply, people.get(one.kind, "ann"))
    history = desk.history(job)
    assert {line.who for line in history} == {"sue", *people.values(), "ann", WORKER}
    signed = {line.what.partition(":")[0]: line.who for line in history if line.sheet}
    assert signed["test-cut"] == "jo"
    assert (signed["load"], signed["tool"], signed["flip"]) == ("lea", "tom", "ann")
    assert (signed["laid"], signed["done"]) == (WORKER, WORKER)
    assert [line.when for line in history] == sorted(line.when for line in history)


def test_at_a_machine_that_cannot_say_it_is_signed_who_says_that_it_has_finished(
    tmp_path: Path,
) -> None:
    settings = {"handshake": "xon-xoff", "answers": "no"}
    blind = adjusted(shelf.machine("generic-hpgl-600"), settings)
    plan = make(knife_job.fold(), knife_job.material(), blind, blank=(260.0, 240.0))
    job, bench, ledger = small_job(tmp_path, plan), Bench(plan), Ledger("sqlite://")
    bench.hands.who, bench.hands.verdicts = "lee", [Verdict.GOOD] * 9
    sent = list(send_job(job, bench.url, bench.hands, ledger=ledger))
    history = ledger.history(sent[0].sheet)
    said = [who for _, who, what in history if what == "finished" or "test-cut" in what]
    assert len(said) > len(sent)
    assert {*said} == {"lee"}
    bench.leave()


def test_at_a_terminal_whoever_is_named_signs_all_and_else_who_is_at_the_computer(
    tmp_path: Path,
) -> None:
    job = small_job(tmp_path / "job", small_plan())
    for who, signs in (("ida", "ida"), ("", NOBODY)):
        bench, ledger = Bench(job.plan), Ledger(tmp_path / f"{who}.sqlite", who=who)
        (first, *_) = send_job(job, bench.url, bench.hands, ledger=ledger)
        assert {who for _, who, _ in ledger.history(first.sheet)} == {signs}
        ledger.close()
        bench.leave()
