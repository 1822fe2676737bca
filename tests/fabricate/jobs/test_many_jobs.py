"""Some plotters, many jobs, gates, pauses, cancels and priorities: all end right, one at a time.

The plotters are simulators in this process, reached over TCP; what is drawn on each sheet is looked
at when it is taken off, and when the next one is laid where a job was cancelled.
"""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from pathlib import Path

from fabricate.jobs import mortal
from fabricate.jobs.workshop import (
    PATIENCE,
    Line,
    drawn,
    forks,
    machine,
    paths,
    plan,
    rest,
    seen,
    wanted,
)
from fabricate.verify import knife_job
from soaking import Soak

from foldmill_fabricate import folder
from foldmill_fabricate.jobs import Desk, JobState, Kind, Places, Question, Reply, Submission
from foldmill_fabricate.jobs.errors import JobRefused
from foldmill_fabricate.jobs.plotters import read
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.ledger import Record
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.servers import serve_tcp

MACHINE = "generic-hpgl-600"
SPEED_UP = 4.0
PROVING = 5 * PATIENCE
"""s of the wall in which something must happen: plans of all plotters may be proved at once."""
AT_GATES = frozenset({Kind.LOAD, Kind.FLIP, Kind.REMOVE, Kind.RE_REGISTER})


@dataclass
class Bench:
    """A plotter, and what was on the sheets that were taken off it."""

    job: Path
    truth: Counter[Line]
    simulator: Simulator = field(
        default_factory=lambda: Simulator(
            machine(blind=False), clock=RealClock(), speed_up=SPEED_UP
        )
    )
    loaded: str = ""
    made: list[str] = field(default_factory=list)

    def lay(self, question: Question) -> None:
        """Do what a question asks for, and look at the sheet."""
        rest(self.simulator)
        if question.kind is Kind.LOAD and question.sheet != self.loaded:
            assert not drawn(self.simulator) - self.truth, "of a job that was cancelled"
            self.simulator.new_sheet()
            self.loaded = question.sheet
        if question.kind is Kind.REMOVE:
            assert self.loaded == question.sheet
            assert drawn(self.simulator) == self.truth, "every line once, on its face"
            self.made.append(question.sheet)
        if question.face and question.face != self.simulator.sheet.up.value:
            self.simulator.flip()

    def look(self, record: Record) -> Reply:
        """Say where a program goes on that ended early."""
        rest(self.simulator)
        return seen(self.simulator, record, paths(self.job, blind=False)[record.program.name])


@dataclass
class Person:
    """Answers everything; cancels and pauses jobs once they ask for something, resumes them."""

    desk: Desk
    benches: dict[str, Bench]
    to_cancel: set[str]
    to_pause: set[str]
    late: str
    """the job that becomes urgent once any has begun"""

    def attend(self) -> None:
        """Answer until all jobs have ended; raises where nothing moves any more."""
        moved, end = 0, time.monotonic() + PROVING
        while not all(job.is_ended for job in self.desk.jobs()):
            if moved != (moved := self.desk.store.last_event()):
                end = time.monotonic() + PROVING
            assert time.monotonic() < end, self.desk.jobs()
            for question in self.desk.questions():
                self._answer(question)
            for job in self.desk.jobs([JobState.PAUSED]):
                if job.id not in self.to_pause:
                    _quietly(partial(self.desk.resume, job.id))
            time.sleep(0.03)
        assert not self.to_pause | self.to_cancel

    def _answer(self, question: Question) -> None:
        if self.late:
            self.desk.prioritise(self.late, 1000)
            self.late = ""
        if question.job in self.to_cancel and question.kind is Kind.FLIP:
            self.desk.cancel(question.job)
            self.to_cancel.remove(question.job)
            return
        if question.job in self.to_pause:
            self.desk.pause(question.job)
            self.to_pause.remove(question.job)
        bench = self.benches[self.desk.job(question.job).plotter]
        if question.kind in AT_GATES:
            bench.lay(question)
        reply = Reply(sheet=question.sheet, ok=question.kind is not Kind.TRY)
        if question.kind is Kind.DECIDE:
            reply = bench.look(self.desk.store.ledger.record(question.sheet, question.program or 0))
        _quietly(partial(self.desk.answer, question.id, reply))


def _quietly(call: Callable[[], object]) -> None:
    """Do something that may have become needless since it was looked at."""
    try:
        call()
    except JobRefused:
        return


def test_all_jobs_end_right_and_no_plotter_has_two_at_once(tmp_path: Path, soak: Soak) -> None:
    count, plotters = soak.size(5, 40), soak.size(2, 4)
    with (
        soak.part("many_jobs", 7, count, "jobs") as progress,
        _workshop(tmp_path, plotters) as (desk, benches, words),
    ):
        chance, kept = random.Random(7), desk.keep(tmp_path / "job")
        asked = [
            Submission(plan=kept, plotter=f"p{k % plotters}", priority=chance.choice((0, 0, 5)))
            for k in range(count - 1)
        ]
        asked.append(asked[-1].model_copy(update={"priority": -9, "plotter": f"p{plotters - 1}"}))
        jobs = [desk.submit(one).id for one in asked]
        late, rest_ = jobs[-1], jobs[:-1]
        mixed = chance.sample(rest_, 3 * max(1, count // 8))
        dropped, cancelled, paused = (set(mixed[k::3]) for k in range(3))
        for name in dropped:
            desk.cancel(name)
        person = Person(desk, benches, {*cancelled}, {*paused}, late)
        log, environment = tmp_path / "log", {"XDG_STATE_HOME": str(tmp_path / "state")}
        service = forks().Process(target=mortal.main, args=(words, environment, log))
        service.start()
        try:
            person.attend()
        finally:
            service.terminate()
            service.join(PATIENCE)
        for name in jobs:
            gone = name in dropped | cancelled
            assert desk.job(name).state is (JobState.CANCELLED if gone else JobState.DONE), (
                log.read_text()
            )
        made = [sheet for bench in benches.values() for sheet in bench.made]
        done = [name for name in jobs if desk.job(name).state is JobState.DONE]
        assert sorted(made) == sorted(desk.job(name).sheets[0] for name in done)
        _one_at_a_time(desk, jobs)
        _the_urgent_first(desk, jobs, late)
        progress.reached(count)


@contextmanager
def _workshop(root: Path, plotters: int) -> Iterator[tuple[Desk, dict[str, Bench], list[str]]]:
    folder.write(knife_job.fold(), plan(blind=False), root / "job", ["hpgl"])
    truth = wanted(root / "job", blind=False)
    benches = {f"p{k}": Bench(root / "job", truth) for k in range(plotters)}
    with ExitStack() as stack:
        words = [
            f"{name}={stack.enter_context(serve_tcp(bench.simulator))}@{MACHINE}"
            for name, bench in benches.items()
        ]
        desk = Desk(Places(root / "state/foldmill", ""), read(Path("/dev/null"), words))
        yield desk, benches, words
        desk.store.close()


def _one_at_a_time(desk: Desk, jobs: list[str]) -> None:
    """Each job has its plotter from its first event on it to its end, and nobody else has."""
    spans = _spans(desk, jobs)
    for plotter in desk.plotters:
        mine = sorted(span for name, span in spans.items() if desk.job(name).plotter == plotter)
        assert all(one[1] <= other[0] for one, other in pairwise(mine))


def _the_urgent_first(desk: Desk, jobs: list[str], late: str) -> None:
    """Jobs begin by priority, then as they came; one that becomes urgent is the next to begin."""
    spans = _spans(desk, jobs)
    for plotter in desk.plotters:
        mine = [name for name in jobs if name in spans and desk.job(name).plotter == plotter]
        mine = [name for name in mine if name != late]
        begun = sorted(mine, key=lambda name: spans[name][0])
        assert begun == sorted(mine, key=lambda name: (-desk.job(name).priority, jobs.index(name)))
    said = next(one.number for one in desk.store.events(job=late) if one.what == "priority 1000")
    where = desk.job(late).plotter
    beside = [spans[name][0] for name in spans if desk.job(name).plotter == where]
    assert min(number for number in beside if number > said) == spans[late][0]


def _spans(desk: Desk, jobs: list[str]) -> dict[str, tuple[int, int]]:
    """Return the first and last event of each job while it had its plotter."""
    found: dict[str, tuple[int, int]] = {}
    for name in jobs:
        heard = desk.store.events(job=name)
        begun = next((one.number for one in heard if one.what == "begun"), None)
        if begun is not None:
            found[name] = (begun, heard[-1].number)
    return found
