"""Jobs over HTTP: the verbs of the terminal, by the client that the package brings."""

from __future__ import annotations

import json
import re
import shutil
import signal
import threading
import time
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import httpx
import pytest
from services import running, serving, square

from foldmill import Fold
from foldmill.errors import UnreadableFile
from foldmill.exchange import fold as fold_file
from foldmill_fabricate import folder as job_folder
from foldmill_fabricate import shelf
from foldmill_fabricate.client import Client, Unreachable
from foldmill_fabricate.errors import CannotPlan, CannotSend
from foldmill_fabricate.jobs import JobState, Kind, Places, Question, Reply, Submission
from foldmill_fabricate.jobs.errors import Clash, JobRefused, NoSuchJob
from foldmill_fabricate.jobs.values import Event, JobRecord
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.service.answers import events
from foldmill_fabricate.service.models import PlanRequest
from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens

BENCH = "bench=sim://generic-hpgl-600"
SHEET = {"material": "pp-0.75", "machine": "generic-hpgl-600"}


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the job folder of a square."""
    place = tmp_path_factory.mktemp("planned")
    job_folder.write(_square(), _plan(), place, ["svg", "hpgl"])
    return place


@cache
def _square() -> Fold:
    return fold_file.read(json.dumps(square()))


@cache
def _plan() -> Plan:
    return make(_square(), shelf.material("pp-0.75"), shelf.machine("generic-hpgl-600"))


@pytest.fixture
def queued(service: httpx.Client) -> Iterator[Client]:
    """Give a client of a service whose jobs nobody works on."""
    with Client(str(service.base_url)) as client:
        yield client


def until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + 300  # computing gives way to whatever else the machine does
    while not true():
        assert time.monotonic() < end, "nothing happens any more"
        time.sleep(0.05)


def reply(asked: Question) -> Reply:
    """Say what a careful person says."""
    if asked.kind is Kind.TRY:
        return Reply(ok=False)
    return Reply(sheet=asked.sheet if asked.kind in {Kind.FLIP, Kind.RE_REGISTER} else "")


def made(client: Client, job: JobRecord) -> JobRecord:
    """Answer whatever a job asks until it ends."""

    def over() -> bool:
        for asked in client.questions(job.id):
            client.answer(asked.id, reply(asked), "bert")
        return client.job(job.id).is_ended

    until(over)
    return client.job(job.id)


def test_a_job_is_made_gate_by_gate_and_nothing_of_it_is_lost_when_the_service_is_killed(
    planned: Path, tmp_path: Path
) -> None:
    state = tmp_path / "state"
    heard: list[Event] = []
    with serving(state, "--plotter", BENCH) as (process, url), Client(url) as client:
        job = client.submit(Submission(plan=client.keep(planned), plotter="bench"), "anna")
        follower = threading.Thread(target=_follow, args=(url, job.id, heard), daemon=True)
        follower.start()
        until(lambda: bool(client.questions(job.id)))
        assert [plotter.job for plotter in client.plotters()] == [job.id]
        first = client.questions(job.id)[0]
        client.answer(first.id, reply(first), "bert")
        with pytest.raises(Clash, match="answered already"):
            client.answer(first.id, reply(first), "bert")
        process.send_signal(signal.SIGKILL)
        process.wait()
        with pytest.raises(Unreachable, match="Does foldmill serve run"):
            client.job(job.id)
    port = url.rpartition(":")[2]
    with serving(state, "--plotter", BENCH, "--port", port), Client(url) as client:
        ended = made(client, job)
        assert ended.state is JobState.DONE, ended.note
        until(lambda: bool(heard) and heard[-1].state is JobState.DONE)
        _judge(client, ended, heard, planned)
        _refuse_order(client)
        figures = httpx.get(f"{url}/metrics").text
    assert 'foldmill_jobs{state="done"} 1.0' in figures
    strokes = _plan().figures.strokes
    assert f'foldmill_strokes_total{{plotter="bench"}} {float(strokes)}' in figures
    numbers = [event.number for event in heard]
    assert numbers == sorted(set(numbers)), "nothing is told twice"
    told = [event.what for event in heard]
    assert told[0].startswith("submitted: 1 ×")
    assert told.count("asks: remove") == 1


def _refuse_order(client: Client) -> None:
    """Order a design that cannot be: its job says why."""
    order = {"family": "rotational", "preset": "star-n6", "params": {"n": 1}}
    asked = Submission.model_validate({"design": order, "plotter": "bench"})
    job = client.submit(asked)
    assert job.state is JobState.PLANNING
    until(lambda: client.job(job.id).is_ended)
    assert client.job(job.id).state is JobState.FAILED
    assert "n must be at least" in client.job(job.id).note


def _follow(url: str, job: str, heard: list[Event]) -> None:
    with Client(url) as client:
        for event in client.follow(job=job):
            heard.append(event)
            if event.state is JobState.DONE:
                return


def _judge(client: Client, job: JobRecord, heard: list[Event], planned: Path) -> None:
    """Hold against each other what is told of a job that is done."""
    history = client.history(job.id)
    assert [line.what for line in history if not line.sheet] == [event.what for event in heard]
    assert {"anna", "bert", "foldmill"} <= {line.who for line in history}
    [sheet] = client.sheets(job.id)
    assert [row.state for row in sheet.programs] == ["done"] * len(_plan().passes[0].setups)
    assert all(row.certain == row.strokes and not row.doubtful for row in sheet.programs)
    picture = client.as_cut(job.id, sheet.id, "front").decode()
    groups = dict(re.findall(r'<g id="(\w+)".*?>(.*?)</g>', picture))
    drawn = {name: content.count("<path") for name, content in groups.items()}
    strokes = sum(row.strokes for row in sheet.programs)
    assert drawn == {"left": 0, "certain": strokes, "doubtful": 0}
    wire = b"".join(client.transcript(job.id, name) for name in client.transcripts(job.id))
    assert wire.count(b'"to": "machine"') > strokes
    plan = Plan.model_validate_json(client.job_file(job.id, "plan.json"))
    assert plan.passes == _plan().passes
    assert plan.machine == shelf.machine("generic-hpgl-600")


def test_a_job_waits_where_nobody_works_and_is_moved_about_by_the_verbs(
    queued: Client, planned: Path
) -> None:
    plan = queued.keep(planned)
    first = queued.submit(Submission(plan=plan, plotter="bench", key="monday"), "anna")
    assert (first.state, first.who) == (JobState.SUBMITTED, "anna")
    assert queued.submit(Submission(plan=plan, plotter="bench", key="monday")) == first
    with pytest.raises(Clash, match="'monday' was used before"):
        queued.submit(Submission(plan=plan, plotter="bench", key="monday", copies=2))
    assert queued.pause(first.id).state is JobState.PAUSED
    assert queued.resume(first.id).state is JobState.SUBMITTED
    assert queued.prioritise(first.id, 5).priority == 5
    assert queued.cancel(first.id, "bert").state is JobState.CANCELLED
    with pytest.raises(JobRefused):
        queued.resume(first.id)
    assert queued.jobs([JobState.CANCELLED], "bench")[0].id == first.id
    whos = [line.who for line in queued.history(first.id)]
    assert (whos[0], whos[-1]) == ("anna", "bert")
    assert queued.machine_of("bench") == "generic-hpgl-600"


def test_what_there_is_not_is_refused_with_the_error_it_is(queued: Client, planned: Path) -> None:
    plan = queued.keep(planned)
    with pytest.raises(NoSuchJob, match="There is no plotter 'lathe'"):
        queued.submit(Submission(plan=plan, plotter="lathe"))
    with pytest.raises(NoSuchJob, match="There is no plan"):
        queued.submit(Submission(plan="0" * 64, plotter="bench"))
    with pytest.raises(JobRefused, match="no plan of what is missing on sheet 'ZZZZ'"):
        queued.submit(Submission(plan=plan, plotter="bench", remakes="ZZZZ"))
    with pytest.raises(NoSuchJob):
        queued.job("NOSUCH")
    with pytest.raises(NoSuchJob, match="There is no question"):
        queued.answer("0123456789abcdef", Reply())
    with pytest.raises(NoSuchJob, match="There is no plotter"):
        queued.machine_of("lathe")
    stool = {"family": "tuck", "preset": "stool-n8"}
    narrow = {"design": stool, **SHEET, "options": {"blank": (90, 90)}}
    with pytest.raises(CannotPlan, match="blank"):
        queued.planned(PlanRequest.model_validate(narrow))


def test_a_kept_folder_is_the_one_that_was_sent(queued: Client, planned: Path) -> None:
    plan = queued.keep(planned)
    assert queued.keep(planned) == plan
    job = queued.submit(Submission(plan=plan, plotter="bench"))
    for name in ("plan.json", "pattern.fold", *(one.name for one in _programs(planned))):
        assert queued.job_file(job.id, name) == (planned / name).read_bytes()
    queued.cancel(job.id)


def _programs(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.hpgl"))


def test_a_job_folder_with_an_edited_program_is_not_kept(
    queued: Client, planned: Path, tmp_path: Path
) -> None:
    edited = shutil.copytree(planned, tmp_path / "edited")
    program = _programs(edited)[0]
    program.write_bytes(program.read_bytes().replace(b"PD", b"PU", 1))
    with pytest.raises(CannotSend, match="does not verify, and nothing of it is kept"):
        queued.keep(edited)
    (tmp_path / "empty").mkdir()
    with pytest.raises(UnreadableFile):
        queued.keep(tmp_path / "empty")


def test_a_token_of_each_scope_may_do_its_part_of_a_job(planned: Path, tmp_path: Path) -> None:
    tokens = Tokens(tmp_path)
    secrets = {scope: tokens.new(scope.value, scope) for scope in Scope}
    who = policy(tmp_path, "127.0.0.1", (), demand=True)
    with running(tmp_path, who) as service:
        view, submit, operate = (Client(str(service.base_url), secrets[scope]) for scope in Scope)
        plan = submit.keep(planned)
        with pytest.raises(Exception, match="allows to view, and this needs submit"):
            view.submit(Submission(plan=plan, plotter="bench"))
        job = submit.submit(Submission(plan=plan, plotter="bench"), "somebody else")
        assert job.who == "submit", "a token says who it is"
        assert view.job(job.id) == job
        for verb in (submit.pause, submit.cancel, view.cancel):
            with pytest.raises(Exception, match="and this needs operate"):
                verb(job.id)
        assert operate.cancel(job.id).state is JobState.CANCELLED
        assert view.history(job.id)[-1].who == "operate"
        for client in (view, submit, operate):
            client.close()


def test_events_are_heard_from_any_number_on(service: httpx.Client, planned: Path) -> None:
    with Client(str(service.base_url)) as client:
        job = client.submit(Submission(plan=client.keep(planned), plotter="bench"))
        client.cancel(job.id)
    asked: dict[str, str | int] = {"seconds": 0, "job": job.id}

    def heard(**headers: str) -> list[int]:
        answer = service.get("/api/v1/events", params=asked, headers=headers)
        assert answer.headers["content-type"].startswith("text/event-stream")
        told = [data for kind, data in events(answer.text.splitlines()) if kind == "job"]
        return [Event.model_validate_json(data).number for data in told]

    every = heard()
    assert len(every) == 2
    assert heard(**{"last-event-id": str(every[0])}) == every[1:]
    assert heard(**{"last-event-id": str(every[1])}) == []
    assert service.get("/api/v1/events", params={"job": "NOSUCH"}).status_code == 404


def test_a_client_without_a_service_says_how_to_start_one(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert Places().service.is_relative_to(tmp_path)
    with pytest.raises(Unreachable, match="foldmill serve"):
        Client()
