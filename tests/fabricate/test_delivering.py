"""A sheet goes through stops, doubts and crashes, and no stroke is cut twice unasked."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest
from sqlalchemy import update
from stools import PENS, machine, material

from foldmill import installed
from foldmill_fabricate import folder
from foldmill_fabricate.delivering import NEW, Sent, Tell, send_job
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.gates import Answer, Request
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.operators import SimulatedOperator, Verdict
from foldmill_fabricate.passes import Face, Plan, ProgramFile
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter import resume
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.errors import LedgerRefused, Stopped
from foldmill_fabricate.plotter.languages import made_ready
from foldmill_fabricate.plotter.ledger import Ledger, Record, Said, State, Word, ledger_file
from foldmill_fabricate.plotter.ledger.reading import at_program
from foldmill_fabricate.plotter.ledger.run import Run
from foldmill_fabricate.plotter.ledger.tables import PROGRAMS
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.sender import Progress
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.servers import serve_tcp
from foldmill_fabricate.sending import Job, open_job

FRONT, REVERSE = (Face.FRONT,), (Face.REVERSE,)


@cache
def plan(slug: str = PENS, answers: bool = True) -> Plan:
    rotational = installed().design("rotational")
    cutter: Machine = machine(slug)
    serial = cutter.serial.model_copy(
        update={"answers": answers} | ({} if answers else {"handshake": "xon-xoff"})
    )
    fold = rotational.run(rotational.preset(next(iter(rotational.presets))))
    return make(fold, cut_once(), cutter.model_copy(update={"serial": serial}))


def cut_once() -> Material:
    """A material whose strokes come by no place twice, so that a place proves where it goes on."""
    stock = material()
    once = {
        "score": stock.score.model_copy(update={"repeats": 1}),
        "cut": stock.cut.model_copy(update={"repeats": 1}),
    }
    return stock.model_copy(update=once)


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Job:
    return made(tmp_path_factory.mktemp("job"), plan())


def made(path: Path, planned: Plan) -> Job:
    rotational = installed().design("rotational")
    fold = rotational.run(rotational.preset(next(iter(rotational.presets))))
    folder.write(fold, planned, path, ["hpgl"])
    return open_job(path)


@pytest.fixture
def ledger(tmp_path: Path) -> Iterator[Ledger]:
    opened = Ledger(tmp_path / "ledger.sqlite")
    yield opened
    opened.close()


class Bench:
    """A simulated plotter, and a person who says what a test wants said."""

    def __init__(self, name: str, machine: Machine) -> None:
        self.simulator = Simulator(machine)
        self.url = devices.plug(name, self.simulator)
        self.operator = Scripted(self.url)

    def strokes(self, face: Face) -> list[object]:
        """All that was cut on a face, whatever sheet it was."""
        return [stroke for sheet in self.simulator.sheets for stroke in sheet.strokes[face]]


class Scripted(SimulatedOperator):
    """Says what it is told to say, and remembers what it was asked."""

    def __init__(self, url: str) -> None:
        super().__init__(url)
        self.words: list[Said | None] = []
        self.asked: list[tuple[Record, Start | None]] = []
        self.told: list[str] = []

    def decide(self, record: Record, found: Start | None, told: str) -> Said | None:
        self.asked.append((record, found))
        self.told.append(told)
        return self.words.pop(0) if self.words else super().decide(record, found, told)


@pytest.fixture
def bench(request: pytest.FixtureRequest) -> Iterator[Bench]:
    made = Bench(f"bench-{request.node.name}", plan().machine)
    yield made
    devices.unplug(made.url)


@pytest.fixture(scope="module")
def whole(job: Job) -> dict[Face, list[object]]:
    """What the job cuts when nothing goes wrong."""
    bench = Bench("whole", plan().machine)
    sent = list(send_job(job, bench.url, bench.operator))
    assert [each.state for each in sent] == [State.DONE, State.DONE]
    devices.unplug(bench.url)
    return {face: bench.strokes(face) for face in Face}


def stopping(after: int, name: str = "front.hpgl") -> Tell:
    def tell(part: ProgramFile, progress: Progress) -> None:
        if part.name == name and progress.instructions == after:
            raise KeyboardInterrupt

    return tell


def test_faces_that_are_sent_one_by_one_are_one_sheet(
    job: Job, bench: Bench, ledger: Ledger, whole: dict[Face, list[object]]
) -> None:
    first = list(send_job(job, bench.url, bench.operator, FRONT, ledger=ledger))
    second = list(send_job(job, bench.url, bench.operator, REVERSE, ledger=ledger))
    assert first[0].sheet == second[0].sheet
    assert ledger.open_sheets() == []
    assert {face: bench.strokes(face) for face in Face} == whole


def test_a_sheet_that_is_half_made_is_not_begun_again_by_mistake(
    job: Job, bench: Bench, ledger: Ledger
) -> None:
    (front,) = send_job(job, bench.url, bench.operator, FRONT, ledger=ledger)
    cut = len(bench.strokes(Face.FRONT))
    with pytest.raises(LedgerRefused, match=rf"begun already.*{front.sheet}: front.hpgl done"):
        list(send_job(job, bench.url, bench.operator, ledger=ledger))
    assert len(bench.strokes(Face.FRONT)) == cut
    (other, _) = send_job(job, bench.url, bench.operator, ledger=ledger, sheet=NEW)
    assert other.sheet != front.sheet
    (rest,) = send_job(job, bench.url, bench.operator, ledger=ledger, sheet=front.sheet.lower())
    assert (rest.sheet, rest.program.face) == (front.sheet, Face.REVERSE)


def test_a_sheet_of_another_plan_is_refused(
    job: Job, bench: Bench, ledger: Ledger, tmp_path: Path
) -> None:
    (front,) = send_job(job, bench.url, bench.operator, FRONT, ledger=ledger)
    other = made(tmp_path / "other", plan().model_copy(update={"title": "Another"}))
    with pytest.raises(LedgerRefused, match="name the folder it was begun from"):
        list(send_job(other, bench.url, bench.operator, ledger=ledger, sheet=front.sheet))
    with pytest.raises(LedgerRefused, match="knows no sheet"):
        list(send_job(job, bench.url, bench.operator, ledger=ledger, sheet="ZZZZ"))


@pytest.mark.parametrize("after", [41, 60, 90])
def test_a_stopped_program_goes_on_where_the_machine_stands(
    job: Job, bench: Bench, ledger: Ledger, whole: dict[Face, list[object]], after: int
) -> None:
    with pytest.raises(Stopped):
        list(send_job(job, bench.url, bench.operator, FRONT, stopping(after), ledger=ledger))
    (sheet,) = ledger.open_sheets()
    found = sheet.records[0]
    assert found.state is State.INTERRUPTED
    bench.operator.words = []
    sent = list(send_job(job, bench.url, bench.operator, FRONT, ledger=ledger, sheet=sheet.id))
    record, start = bench.operator.asked[0]
    assert start is not None
    assert record.runs[-1].acked <= start.stroke <= record.runs[-1].sent
    assert [each.state for each in sent] == [State.DONE]
    assert joined(bench.strokes(Face.FRONT)) == joined(whole[Face.FRONT])


def joined(strokes: Sequence[object]) -> set[tuple[tuple[int, int], ...]]:
    """Every straight piece that was cut, once, whichever way."""
    pieces = set()
    for stroke in strokes:
        path = [tuple(map(int, spot)) for spot in stroke.points]  # type: ignore[attr-defined]
        pieces |= {tuple(sorted(pair)) for pair in pairwise(path)}
    return pieces  # type: ignore[return-value]


def test_a_closed_cut_ends_where_it_began_and_proves_nothing(job: Job) -> None:
    """The machine stands at the seam of a hole: cut, or still to be cut? A person must look."""
    front = made_ready(job.programs["front.hpgl"], job.plan.machine)
    path = resume.vertices(front, 0)
    seam, inside = path[0], path[len(path) // 2]
    assert path.count(seam) == 2
    assert resume.locate(front, 0, 1, seam) is None
    assert resume.locate(front, 0, 1, inside) == Start(0, path.index(inside))


class Unguarded(Ledger):
    """A ledger whose compare-and-set is taken out: every program is always ready."""

    def recover(self, sheet: str, number: int) -> Record:
        return replace(self.record(sheet, number), state=State.READY)

    def claim(self, sheet: str, number: int, device: str) -> Run:
        with self._engine.begin() as at:
            mine = at_program(sheet, number)
            at.execute(update(PROGRAMS).where(mine).values(state=State.READY.value))
        return super().claim(sheet, number, device)


@pytest.mark.parametrize("guarded", [True, False])
def test_it_is_the_ledgers_guard_that_keeps_strokes_from_being_cut_twice(
    guarded: bool, job: Job, bench: Bench, tmp_path: Path
) -> None:
    ledger = (Ledger if guarded else Unguarded)(tmp_path / "ledger.sqlite")
    with pytest.raises(Stopped):
        list(send_job(job, bench.url, bench.operator, FRONT, stopping(30), ledger=ledger))
    (sheet,) = ledger.open_sheets()
    bench.operator.words = [None]
    with suppress(LedgerRefused):
        list(send_job(job, bench.url, bench.operator, FRONT, ledger=ledger, sheet=sheet.id))
    ledger.close()
    drawn = bench.strokes(Face.FRONT)
    assert (len({*drawn}) == len(drawn)) is guarded


def test_without_a_word_a_program_in_doubt_is_left_as_it_is(
    job: Job, bench: Bench, ledger: Ledger
) -> None:
    with pytest.raises(Stopped):
        list(send_job(job, bench.url, bench.operator, FRONT, stopping(30), ledger=ledger))
    (sheet,) = ledger.open_sheets()
    bench.operator.words = [None]
    received = len(bench.simulator.device.traffic.program)
    with pytest.raises(LedgerRefused, match=r"Of \d+ strokes .* only on a person's word"):
        list(send_job(job, bench.url, bench.operator, FRONT, ledger=ledger, sheet=sheet.id))
    asked = bytes(bench.simulator.device.traffic.program[received:])
    assert b"PD" not in asked
    with pytest.raises(LedgerRefused, match="begun already"):
        list(send_job(job, bench.url, bench.operator, REVERSE, ledger=ledger))


def test_a_spoiled_sheet_is_not_gone_on_with(job: Job, bench: Bench, ledger: Ledger) -> None:
    with pytest.raises(Stopped):
        list(send_job(job, bench.url, bench.operator, FRONT, stopping(30), ledger=ledger))
    (sheet,) = ledger.open_sheets()
    bench.operator.words = [Said(Word.SPOILED)]
    with pytest.raises(CannotSend, match="given up"):
        list(send_job(job, bench.url, bench.operator, FRONT, ledger=ledger, sheet=sheet.id))
    assert ledger.open_sheets() == []


def test_a_machine_that_cannot_say_is_done_when_a_person_has_seen_it(
    tmp_path: Path, ledger: Ledger
) -> None:
    blind = made(tmp_path / "blind", plan(PENS, False))
    bench = Bench("blind", blind.plan.machine)
    sent = list(send_job(blind, bench.url, bench.operator, ledger=ledger))
    assert [each.state for each in sent] == [State.DONE, State.DONE]
    said = [what for _, _, what in ledger.history(sent[0].sheet)]
    assert said.count("finished") == 2
    assert said.count("sent, not confirmed") == 2
    unseen = Bench("unseen", blind.plan.machine)
    unseen.operator.has_finished = lambda record: False  # type: ignore[method-assign]
    (only,) = send_job(blind, unseen.url, unseen.operator, ledger=ledger)
    assert only.state is State.UNCONFIRMED
    for each in (bench, unseen):
        devices.unplug(each.url)


HOST = """
import sys
from pathlib import Path
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.gates import Answer
from foldmill_fabricate.sending import open_job

class Hands:
    who = ""
    def ready(self, request): return Answer(sheet=request.sheet)
    def wants_test_cut(self, *_): return False
    def judge(self, *_): raise AssertionError
    def decide(self, *_): return None
    def has_finished(self, *_): return False

list(send_job(open_job(Path(sys.argv[1])), sys.argv[2], Hands()))
"""


@pytest.mark.parametrize("kill_at", [900])
def test_after_a_killed_host_the_truth_lies_between_certain_and_doubtful(
    tmp_path: Path, kill_at: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    job = made(tmp_path / "job", plan())
    simulator = Simulator(plan().machine, clock=RealClock(), speed_up=60)
    with serve_tcp(simulator) as url:
        host = subprocess.Popen([sys.executable, "-c", HOST, str(tmp_path / "job"), url])
        deadline = time.monotonic() + 60
        while len(simulator.device.traffic.received) < kill_at and time.monotonic() < deadline:
            time.sleep(0.005)
        host.send_signal(signal.SIGKILL)
        host.wait()
        simulator.clock.sleep(0.2)
        (sheet,) = Ledger(ledger_file()).open_sheets(job.id)
        found = Ledger(ledger_file()).recover(sheet.id, 0)
        drawn = len(simulator.sheet.strokes[Face.FRONT])
        assert found.state is State.INTERRUPTED
        assert len(found.certain) <= drawn <= len(found.certain) + len(found.doubtful)
        sent = list(send_job(job, url, Terminal(), FRONT, sheet=sheet.id))
    assert [each.state for each in sent] == [State.DONE]
    assert max_times(simulator.sheet.strokes[Face.FRONT]) == 1
    assert isinstance(sent[0], Sent)


class Terminal:
    """A person who believes the machine where it proves its place."""

    who = ""

    def ready(self, request: Request) -> Answer:
        return Answer(sheet=request.sheet)

    def wants_test_cut(self, _request: Request) -> bool:
        return False

    def judge(self, _request: Request) -> Verdict:
        return Verdict.GOOD

    def decide(self, record: Record, found: Start | None, _told: str) -> Said | None:
        assert found is not None
        assert record.runs[-1].acked <= found.stroke
        return Said(Word.GO_ON, found.stroke, found.vertex)

    def has_finished(self, _record: Record) -> bool:
        return False


def max_times(strokes: Sequence[object]) -> int:
    """Return how often the most frequent stroke was cut."""
    paths = [tuple(map(tuple, stroke.points)) for stroke in strokes]  # type: ignore[attr-defined]
    return max(paths.count(path) for path in paths)
