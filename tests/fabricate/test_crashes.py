"""Killed, stopped and taken up again in any order, a sheet gets every stroke, and none unasked.

A run is a sequence of deliveries that end anywhere, by Ctrl-C or as if the host were gone between
one byte and the next. What the simulated tool has drawn is compared each time with what the ledger
calls certain and doubtful, and at the end with the whole job.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from math import hypot
from pathlib import Path

import pytest
from fabricate.bench import Bench, small_job, small_plan
from sqlalchemy import update

from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.passes import Face, ProgramFile
from foldmill_fabricate.plotter.errors import LedgerRefused, Stopped
from foldmill_fabricate.plotter.ledger import Ledger, Record, Run, Said, State, Word
from foldmill_fabricate.plotter.ledger.tables import PROGRAMS
from foldmill_fabricate.plotter.sender import Progress
from foldmill_fabricate.sending import Job

FRONT = (Face.FRONT,)
Path2 = tuple[tuple[int, int], ...]
STEP = 2.0
"""Steps by which a length may be off: a halted line ends on a whole one."""


class Killed(BaseException):
    """The host is gone."""


class Mortal(Ledger):
    """The real ledger, of a process that may be killed: then nothing more is written."""

    dead = False

    def end(self, run: Run, state: State, why: str) -> None:
        if not self.dead:
            super().end(run, state, why)

    def write(self, run: Run, sent: int, acked: int) -> None:
        if not self.dead:
            super().write(run, sent, acked)


class Careless(Mortal):
    """A ledger whose guard was taken out: whatever was under way is ready again from its start."""

    def recover(self, sheet: str, number: int) -> Record:
        with self._engine.begin() as at:
            where = (PROGRAMS.c.sheet == sheet) & (PROGRAMS.c.number == number)
            unfinished = PROGRAMS.c.state != State.DONE.value
            at.execute(update(PROGRAMS).where(where, unfinished).values(state=State.READY.value))
        return self.record(sheet, number)


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Job:
    return small_job(tmp_path_factory.mktemp("job"))


@cache
def paths(job: Job) -> dict[str, list[Path2]]:
    """Every stroke of the front, by program: what is drawn when nothing goes wrong."""
    bench = Bench(small_plan())
    found, before = {}, 0
    for sent in send_job(job, bench.url, bench.hands, FRONT):
        drawn = bench.simulator.sheet.strokes[Face.FRONT]
        found[sent.program.name] = [stroke.points for stroke in drawn[before:]]
        before = len(drawn)
    bench.leave()
    return found


@dataclass
class Story:
    """One sheet and all that happens to it."""

    job: Job
    ledger: Mortal
    bench: Bench = field(default_factory=lambda: Bench(small_plan()))
    asked: dict[tuple[str, int], int] = field(default_factory=dict)
    """How often a person had a stroke cut again from its start."""

    def deliver(self, name: str, after: int, kind: str) -> None:
        """Send until that instruction of a program; let the machine finish what it has."""
        simulator = self.bench.simulator
        alive = simulator.write, simulator.discard_output

        def tell(part: ProgramFile, progress: Progress) -> None:
            if part.name == name and progress.instructions == after:
                if kind == "stop":
                    raise KeyboardInterrupt
                self.ledger.dead = True
                simulator.write = lambda data: None  # type: ignore[method-assign]
                simulator.discard_output = lambda: None  # type: ignore[method-assign]
                raise Killed

        sheet = next(iter(self.ledger.open_sheets()), None)
        name_of = sheet.id if sheet else ""
        delivered = send_job(
            self.job, self.bench.url, self.bench.hands, FRONT, tell, self.ledger, name_of
        )
        with suppress(Killed, Stopped):
            list(delivered)
        self.ledger.dead = False
        simulator.write, simulator.discard_output = alive  # type: ignore[method-assign]
        simulator.clock.sleep(200.0)
        simulator.advance()

    def drawn(self) -> dict[tuple[str, int], list[Path2]]:
        """What was drawn along each stroke, in parts or whole."""
        found: dict[tuple[str, int], list[Path2]] = {}
        for sheet in self.bench.simulator.sheets:
            for stroke in sheet.seen(Face.FRONT):
                found.setdefault(self._which(stroke.points), []).append(stroke.points)
        return found

    def _which(self, drawn: Path2) -> tuple[str, int]:
        on = set(drawn[:-1] or drawn)
        fits = [
            (name, k)
            for name, strokes in paths(self.job).items()
            for k, path in enumerate(strokes)
            if on <= set(path)
        ]
        (one,) = fits
        return one

    def too_much(self) -> list[tuple[str, int]]:
        """Strokes that were cut more than their repeats, and more than a person has asked for."""
        return [
            key
            for key, parts in self.drawn().items()
            if sum(map(length, parts))
            > (1 + self.asked.get(key, 0)) * length(paths(self.job)[key[0]][key[1]]) + STEP
        ]

    def too_little(self) -> list[tuple[str, int]]:
        """Strokes that are not cut as long as they are."""
        drawn = self.drawn()
        return [
            (name, k)
            for name, strokes in paths(self.job).items()
            for k, path in enumerate(strokes)
            if sum(map(length, drawn.get((name, k), []))) < length(path) - STEP
        ]

    def look(self, record: Record) -> Said:
        """Say what a person who looks at the sheet says: the first stroke that is not cut whole."""
        last, name = record.runs[-1], record.program.name
        drawn, strokes = self.drawn(), paths(self.job)[name]
        for k in range(last.acked, min(last.sent, len(strokes))):
            if sum(map(length, drawn.get((name, k), []))) < length(strokes[k]) - STEP:
                self.asked[name, k] = self.asked.get((name, k), 0) + 1
                return Said(Word.GO_ON, k)
        left = bool(record.left)
        return Said(Word.GO_ON, last.sent) if left else Said(Word.FINISHED)

    def check_ledger(self) -> None:
        """Certain is drawn whole; what is drawn is certain or doubtful."""
        for sheet in self.ledger.open_sheets():
            for number in range(2):
                record = self.ledger.recover(sheet.id, number)
                name, drawn = record.program.name, self.drawn()
                mine = {k for (program, k) in drawn if program == name}
                assert mine <= {*record.certain, *record.doubtful}
                for k in record.certain:
                    whole = length(paths(self.job)[name][k])
                    assert sum(map(length, drawn[name, k])) >= whole - STEP


def length(path: Path2) -> float:
    return sum(hypot(u - x, v - y) for (x, y), (u, v) in pairwise(path))


@pytest.fixture
def story(job: Job, tmp_path: Path) -> Iterator[Story]:
    made = Story(job, Mortal(tmp_path / "ledger.sqlite"))
    yield made
    made.bench.leave()
    made.ledger.close()


PROGRAMS_OF_FRONT = {"1-front-holes.hpgl": 34, "2-front-score.hpgl": 16}
"""How many instructions, about, there are to stop at."""


@pytest.mark.parametrize("seed", range(6))
def test_however_often_it_is_interrupted_each_stroke_is_cut_as_often_as_it_should(
    story: Story, seed: int
) -> None:
    chance = random.Random(seed)
    for _ in range(chance.randint(1, 4)):
        name = chance.choice([*PROGRAMS_OF_FRONT])
        after = chance.randint(3, PROGRAMS_OF_FRONT[name])
        story.deliver(name, after, chance.choice(["stop", "kill", "kill"]))
        story.check_ledger()
        assert story.too_much() == []
        _nothing_without_a_word(story)
        _say(story)
    for _ in range(4):
        story.deliver("", 0, "")
        _say(story)
    assert story.ledger.open_sheets() == [] or _reverse_only(story)
    assert (story.too_much(), story.too_little()) == ([], [])


def _reverse_only(story: Story) -> bool:
    (sheet,) = story.ledger.open_sheets()
    return all(one.state is State.DONE for one in sheet.records if one.program.face == "front")


def _nothing_without_a_word(story: Story) -> None:
    """Try again, and say nothing."""
    sheet = next(iter(story.ledger.open_sheets()), None)
    doubt = {State.INTERRUPTED, State.UNCONFIRMED}
    if sheet is None or not any(record.state in doubt for record in sheet.records):
        return
    before = story.drawn()
    story.bench.hands.words = [None]
    with pytest.raises(LedgerRefused, match="only on a person's word"):
        story.deliver("", 0, "")
    assert story.drawn() == before


def _say(story: Story) -> None:
    """Have the person look at the sheet."""
    story.bench.hands.words = []
    for sheet in story.ledger.open_sheets():
        for number in range(2):
            record = story.ledger.recover(sheet.id, number)
            if record.state in {State.INTERRUPTED, State.UNCONFIRMED}:
                story.bench.hands.words = [story.look(record)]


def _killed_and_sent_again(story: Story) -> None:
    story.deliver("2-front-score.hpgl", 12, "kill")
    assert story.too_much() == []
    story.bench.hands.words = [None]
    try:
        story.deliver("", 0, "")
    except LedgerRefused:
        return


def test_with_the_guard_a_killed_program_that_is_sent_again_cuts_nothing_twice(
    story: Story,
) -> None:
    _killed_and_sent_again(story)
    assert story.too_much() == []


def test_without_the_guard_a_killed_program_that_is_sent_again_cuts_twice(
    job: Job, tmp_path: Path
) -> None:
    """Were the claim skipped, these tests would see it."""
    story = Story(job, Careless(tmp_path / "careless.sqlite"))
    _killed_and_sent_again(story)
    assert story.too_much() != []
    story.bench.leave()
