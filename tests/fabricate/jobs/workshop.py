"""A workshop in small: a simulated plotter, a service in a process of its own, and somebody there.

The simulator counts the bytes that reach it and kills the service where a test says so. What is
drawn on its sheets is the truth that the ledger is held against.
"""

from __future__ import annotations

import multiprocessing
import random
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from multiprocessing.context import ForkServerContext
from multiprocessing.process import BaseProcess
from pathlib import Path

from fabricate.bench import Bench
from fabricate.jobs import mortal
from fabricate.verify import knife_job

from foldmill_fabricate import folder, shelf
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.jobs import Desk, Kind, Places, Question, Reply, Submission
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.errors import LedgerFailed
from foldmill_fabricate.plotter.ledger import Entry, Record
from foldmill_fabricate.plotter.simulator import faults
from foldmill_fabricate.plotter.simulator.devices import adjusted
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.servers import serve_tcp
from foldmill_fabricate.sending import open_job

Spot = tuple[int, int]
Line = tuple[Face, Spot, Spot]
"""A straight line on a face, in steps, its lower end first."""
PATIENCE = 180.0
"""s of the wall in which a workshop must come to rest."""
SPEED_UP = 4.0


@cache
def forks() -> ForkServerContext:
    """Return where services come from: a process that has read all the code they need."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["fabricate.jobs.mortal", "foldmill_fabricate.jobs.host"])
    return context


@cache
def machine(*, blind: bool) -> Machine:
    """A plotter that can be asked where it is, or one that never says a word."""
    settings = {"baud": "115200"}
    if blind:
        settings |= {"handshake": "xon-xoff", "answers": "no"}
    made = adjusted(shelf.machine("generic-hpgl-600"), settings)
    quick = {"travel_speed": 4000.0, "acceleration": 200_000.0, "corner_speed": 500.0}
    motion = made.motion.model_copy(update=quick | {"lift_time": 0.006})
    return made.model_copy(update={"motion": motion})


@cache
def plan(*, blind: bool) -> Plan:
    """A square with four creases, both faces, made ten times as fast as anybody could."""
    shipped = knife_job.material()
    score = shipped.score.model_copy(update={"speed": 10 * shipped.score.speed})
    cut = shipped.cut.model_copy(update={"speed": 10 * shipped.cut.speed})
    material = shipped.model_copy(update={"score": score, "cut": cut})
    return make(knife_job.fold(), material, machine(blind=blind), blank=(260.0, 240.0))


def lines(face: Face, way: tuple[Spot, ...]) -> Counter[Line]:
    """Return the lines of a stroke, each as often as it was gone along."""
    return Counter((face, min(a, b), max(a, b)) for a, b in pairwise(way) if a != b)


def drawn(simulator: Simulator) -> Counter[Line]:
    """Return all lines on the sheet that is on the machine."""
    found: Counter[Line] = Counter()
    for face in Face:
        for stroke in simulator.sheet.seen(face):
            found += lines(face, stroke.points)
    return found


def rest(simulator: Simulator) -> None:
    """Wait until a machine stands still: it executes what it has."""
    end = time.monotonic() + PATIENCE
    simulator.advance()
    while not simulator.device.idle or simulator.queued:
        assert time.monotonic() < end
        time.sleep(0.02)
        simulator.advance()


def wanted(place: Path, *, blind: bool) -> Counter[Line]:
    """Return all lines of a job, both faces: what is on a sheet that is made as planned."""
    every = [each for strokes in paths(place, blind=blind).values() for each in strokes]
    whole: Counter[Line] = Counter()
    for face, way in every:
        whole += lines(face, way)
    return whole


@cache
def paths(place: Path, *, blind: bool) -> dict[str, list[tuple[Face, tuple[Spot, ...]]]]:
    """Return every stroke of a job by program: what is drawn when nothing goes wrong."""
    job, bench = open_job(place), Bench(plan(blind=blind))
    found: dict[str, list[tuple[Face, tuple[Spot, ...]]]] = {}
    before = dict.fromkeys(Face, 0)
    for sent in send_job(job, bench.url, bench.hands):
        bench.simulator.advance()
        face = sent.program.face
        strokes = bench.simulator.sheet.strokes[face]
        found[sent.program.name] = [(face, one.points) for one in strokes[before[face] :]]
        before[face] = len(strokes)
    bench.leave()
    return found


def is_cut(simulator: Simulator, face: Face, way: tuple[Spot, ...]) -> int:
    """Return how many lines of a stroke are on the sheet, in its order."""
    there, count = drawn(simulator), 0
    want: Counter[Line] = Counter()
    for pair in pairwise(way):
        want += lines(face, pair)
        if want - there:
            return count
        count += 1
    return count


def seen(
    simulator: Simulator, record: Record, strokes: list[tuple[Face, tuple[Spot, ...]]]
) -> Reply:
    """Say where a program goes on, as somebody who sees every line, inside a stroke too."""
    last = record.runs[-1]
    if last.acked == last.sent < len(strokes):
        return Reply()  # nothing has left since somebody spoke: as it was said then
    for k in range(last.acked, min(last.sent, len(strokes))):
        done, whole = is_cut(simulator, *strokes[k]), len(strokes[k][1]) - 1
        if done < whole:
            return Reply(word="go on", stroke=k + 1, vertex=done)
    if last.sent >= len(strokes):
        return Reply(word="finished")
    return Reply(word="go on", stroke=last.sent + 1)


@dataclass
class Workshop:
    """A plotter, a service that may be dead, and a person who knows what is on the sheet."""

    root: Path
    blind: bool = False
    seed: int = 0
    careless: bool = False
    forgetful: bool = False
    """Whether nobody switches a machine off and on that holds half an instruction."""
    eager: bool = False
    """Whether test cuts are wanted."""
    database: str = ""
    speed_up: float = SPEED_UP
    job: str = ""
    truth: Counter[Line] = field(default_factory=Counter)
    """What is to be on the sheet by the plan and by what the person chose."""
    killed: int = 0
    troubles: list[str] = field(default_factory=list)
    """What the person was told that is in the way."""

    def __post_init__(self) -> None:
        self.chance = random.Random(self.seed)
        self.simulator = Simulator(
            machine(blind=self.blind), clock=RealClock(), speed_up=self.speed_up
        )
        self.folder = self.root / "job"
        folder.write(knife_job.fold(), plan(blind=self.blind), self.folder, ["hpgl"])
        self.places = Places(self.root / "state/foldmill", self.database)
        self.port = ""
        self.process: BaseProcess | None = None
        self.left: int | None = None
        self.cut_off = False
        self.loaded = ""
        self.truth = wanted(self.folder, blind=self.blind)

    def desk(self) -> Desk:
        """Return the verbs of jobs."""
        one = Plotter(name="bench", port=self.port, machine="generic-hpgl-600")
        return Desk(self.places, {"bench": one})

    def open(self, port: str) -> None:
        """Begin: one job is submitted."""
        self.port = port
        self.at = self.desk()
        kept = self.at.keep(self.folder)
        self.job = self.at.submit(Submission(plan=kept, plotter="bench")).id
        hear = self.simulator.write

        def write(data: bytes) -> None:
            if self.cut_off:
                return
            if self.left is None or len(data) < self.left:
                hear(data)
                self.left = None if self.left is None else self.left - len(data)
                return
            hear(data[: self.left])
            self.left, self.cut_off = None, True  # what it had written is lost with it
            self.kill()

        self.simulator.write = write  # type: ignore[method-assign]

    def close(self) -> None:
        """End whatever runs."""
        self.kill()
        self.at.store.close()

    def kill(self) -> None:
        """Kill the service with SIGKILL."""
        if self.process is not None:
            self.process.kill()

    def start(self, point: str = "") -> None:
        """Start the service; point : where it dies by itself."""
        words = [f"bench={self.port}@generic-hpgl-600", *([point] if point else [])]
        words += ["careless"] if self.careless else []
        environment = {
            "XDG_STATE_HOME": str(self.root / "state"),
            "XDG_CONFIG_HOME": str(self.root / "config"),
            "FOLDMILL_DATABASE": self.places.database,
        }
        log = self.root / "service.log"
        self.process = forks().Process(target=mortal.main, args=(words, environment, log))
        self.process.start()

    @property
    def is_dead(self) -> bool:
        """Whether the service has ended."""
        return self.process is None or not self.process.is_alive()

    @property
    def is_ended(self) -> bool:
        """Whether the job has."""
        return self.at.job(self.job).is_ended

    def attend(self, until: Callable[[], bool]) -> None:
        """Answer what is asked until something is so; raises where nothing moves any more."""
        end = time.monotonic() + PATIENCE
        while True:
            with suppress(LedgerFailed):  # who looks meanwhile is told so, and looks again
                if until():
                    return
                for question in self.at.questions():
                    if until():  # it was asked meanwhile, and is not to be answered
                        return
                    self._answer(question)
                    end = time.monotonic() + PATIENCE
            assert time.monotonic() < end, self.log()
            time.sleep(0.03)

    def end(self) -> None:
        """Tell the service to end, by SIGTERM, and wait until it has."""
        assert self.process is not None
        self.process.terminate()
        self.process.join(PATIENCE)
        assert self.is_dead, self.log()

    def log(self) -> str:
        """Return what the service has said."""
        return (self.root / "service.log").read_text()[-4000:]

    def run(self, point: str = "", bytes_: int | None = None) -> bool:
        """Start the service and attend it until it dies or the job ends; True where it died."""
        self.left, self.cut_off = bytes_, False
        self.start(point)
        self.attend(lambda: self.is_dead or self.is_ended)
        died = not self.is_ended
        if not died:
            self.end()
        self.killed += died
        self.left = None
        self.rest()
        return died

    def rest(self) -> None:
        """Wait until the machine stands still: it executes what it has."""
        rest(self.simulator)

    # ── what a person does and sees ──────────────────────────────────────────────────────────────

    def _answer(self, question: Question) -> None:
        reply = Reply(sheet=question.sheet)
        if question.kind in {Kind.LOAD, Kind.FLIP, Kind.REMOVE, Kind.RE_REGISTER}:
            self.rest()
            self._heed(question)
            self._lay(question)
        elif question.kind is Kind.TRY:
            reply = Reply(ok=self.eager)
        elif question.kind is Kind.TROUBLE:
            self.troubles.append(question.text)
            time.sleep(1.0)
        elif question.kind in {Kind.DECIDE, Kind.FINISHED}:
            self.rest()
            record = self.at.store.ledger.record(question.sheet, question.program or 0)
            self._heed(question)
            if question.kind is Kind.DECIDE:
                reply = self._chosen(record) if self.blind else self._seen(record)
        try:
            self.at.answer(question.id, reply)
        except LookupError:
            return

    def _heed(self, question: Question) -> None:
        """Switch the machine off and on where that is asked for."""
        if "switch the machine off and on" in question.text and not self.forgetful:
            self._power_cycle()

    def _power_cycle(self) -> None:
        self.simulator.fail(faults.parse("power@0:0.1s"))
        time.sleep(0.3)
        self.rest()

    def _lay(self, question: Question) -> None:
        if question.kind is Kind.LOAD and question.sheet != self.loaded:
            self.simulator.new_sheet()
            self.loaded = question.sheet
        if question.face and question.face != self.simulator.sheet.up.value:
            self.simulator.flip()

    def strokes(self, record: Record) -> list[tuple[Face, tuple[Spot, ...]]]:
        """Return the strokes of a program as they are drawn when nothing goes wrong."""
        return paths(self.folder, blind=self.blind)[record.program.name]

    def is_cut(self, record: Record, stroke: int) -> int:
        """Return how many lines of a stroke are on the sheet, in its order."""
        return is_cut(self.simulator, *self.strokes(record)[stroke])

    def _seen(self, record: Record) -> Reply:
        return seen(self.simulator, record, self.strokes(record))

    def _chosen(self, record: Record) -> Reply:
        """Choose among what is doubtful, and remember what that makes of the sheet."""
        last, strokes = record.runs[-1], self.strokes(record)
        at = self.chance.randint(last.acked, min(last.sent, len(strokes)))
        there = drawn(self.simulator)
        for k in range(last.acked, min(last.sent, len(strokes))):
            for line, often in lines(*strokes[k]).items():
                self.truth[line] = there[line] + (often if k >= at else 0)
        if at >= len(strokes):
            return Reply(word="finished")
        return Reply(word="go on", stroke=at + 1)

    # ── what must hold ───────────────────────────────────────────────────────────────────────────

    def check_ledger(self) -> None:
        """What is certain is drawn whole; what is drawn is certain or doubtful."""
        for sheet in self.at.job(self.job).sheets:
            for record in self.at.store.ledger.sheet(sheet).records:
                spoken = {k for run in record.runs for k in range(run.first, run.cut_to or 0)}
                again = {k for run in record.runs for k in self._chosen_again(run)}
                for k in range(record.program.strokes):
                    done = self.is_cut(record, k)
                    known = k in {*record.certain, *record.doubtful, *again}
                    assert not done or known, (record.program.name, k, record)
                    if k in record.certain and k not in spoken:
                        assert done == len(self.strokes(record)[k][1]) - 1, (record, k)

    def _chosen_again(self, run: Entry) -> range:
        """Return strokes that are cut in part, and that a person who cannot see wants whole."""
        spoken = self.blind and run.cut_to is not None
        return range(run.cut_to or 0, run.sent) if spoken else range(0)

    def difference(self) -> tuple[Counter[Line], Counter[Line]]:
        """Return what is missing on the sheet, and what is too much."""
        there = drawn(self.simulator)
        return self.truth - there, there - self.truth


@contextmanager
def workshop(root: Path, **kind: object) -> Iterator[Workshop]:
    """Open a workshop while the context lasts."""
    shop = Workshop(root, **kind)  # type: ignore[arg-type]
    with serve_tcp(shop.simulator) as port:
        shop.open(port)
        try:
            yield shop
        finally:
            shop.close()
