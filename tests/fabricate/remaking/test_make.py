"""What is missing on a half made sheet is cut, and nothing that lies there is cut again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fabricate.bench import Bench
from fabricate.half_made import (
    KNIFE,
    LASER,
    ONE_TOOL,
    PENS,
    Whole,
    cut,
    job_of,
    left_half_made,
    plan_of,
    seen,
    whole,
)
from fabricate.verify import knife_job

from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Gate, Plan, ProgramFile
from foldmill_fabricate.plotter.errors import LedgerRefused, Stopped
from foldmill_fabricate.plotter.ledger import Entry, Ledger, Said, SheetRecord, State, Word
from foldmill_fabricate.plotter.sender import Progress
from foldmill_fabricate.plotter.wish import Wish
from foldmill_fabricate.remaking import Fate, Spoken, read_spoken, remake, write_remake
from foldmill_fabricate.sending import Job, open_job
from foldmill_fabricate.verify.blade import tips

Jobs = dict[str, tuple[Job, Whole]]


@pytest.fixture(scope="module")
def jobs(tmp_path_factory: pytest.TempPathFactory) -> Jobs:
    found = {slug: job_of(tmp_path_factory.mktemp("job"), plan_of(slug)) for slug in (PENS, LASER)}
    return {slug: (job, whole(job)) for slug, job in found.items()}


@pytest.fixture
def ledger(tmp_path: Path) -> Iterator[Ledger]:
    opened = Ledger(tmp_path / "ledger.sqlite")
    yield opened
    opened.close()


def rest_of(job: Job, sheet: SheetRecord, said: list[Spoken], path: Path) -> Job:
    planned = remake(job.plan, sheet, said)
    write_remake(planned, job.path, path, [job.plan.machine.language])
    return open_job(path)


CASES = [
    (PENS, 0, 5),
    (PENS, 1, 5),
    (PENS, 1, 12),
    (LASER, 0, 12),
    (LASER, 0, 90),
]


@pytest.mark.long
@pytest.mark.parametrize(("slug", "number", "after"), CASES)
def test_the_union_of_both_is_the_plan_and_nothing_lies_there_twice(
    jobs: Jobs, slug: str, number: int, after: int, ledger: Ledger, tmp_path: Path
) -> None:
    job, sound = jobs[slug]
    bench = Bench(job.plan)
    sheet = left_half_made(job, bench, ledger, number, after)
    before = cut(bench)
    halves = before - sound.cut
    rest = rest_of(job, sheet, seen(sheet, bench, sound), tmp_path / "rest")
    sent = list(send_job(rest, bench.url, bench.hands, ledger=ledger))
    assert {each.state for each in sent} == {State.DONE}
    assert cut(bench) - halves == sound.cut
    assert sum(halves.values()) <= 1  # the one that goes through the sheet and was cut in part
    assert sum(before.values()) < sum(sound.cut.values())
    assert Gate.LOAD not in bench.hands.gates[1:]
    bench.leave()


def test_a_sheet_that_was_given_up_after_a_wish_to_stop_is_made_to_its_end(
    jobs: Jobs, ledger: Ledger, tmp_path: Path
) -> None:
    job, sound = jobs[PENS]
    bench, wish = Bench(job.plan), Wish()

    def tell(part: ProgramFile, progress: Progress) -> None:
        if part.name == "reverse.hpgl" and progress.instructions == 12:
            wish.stop()

    with pytest.raises(Stopped):
        list(send_job(job, bench.url, bench.hands, tell=tell, ledger=ledger, wish=wish))
    bench.simulator.clock.sleep(5)
    bench.simulator.advance()
    (open_sheet,) = ledger.open_sheets()
    sheet = ledger.give_up(open_sheet.id)
    rest = rest_of(job, sheet, seen(sheet, bench, sound), tmp_path / "rest")
    list(send_job(rest, bench.url, bench.hands, ledger=ledger))
    assert cut(bench) == sound.cut
    bench.leave()


def test_a_file_for_each_set_up_is_numbered_anew_and_done_ones_are_left_out(
    ledger: Ledger, tmp_path: Path
) -> None:
    job = job_of(tmp_path / "job", plan_of(ONE_TOOL))
    bench, sound = Bench(job.plan), whole(job)
    sheet = left_half_made(job, bench, ledger, 2, 12)
    rest = rest_of(job, sheet, seen(sheet, bench, sound), tmp_path / "rest")
    names = [part.name for part in rest.plan.programs]
    assert names == ["1-reverse-score.hpgl", "2-reverse-cut.hpgl"]
    (face,) = rest.plan.passes
    assert face.setups[0].gates == (Gate.RE_REGISTER, Gate.TOOL)
    list(send_job(rest, bench.url, bench.hands, ledger=ledger))
    assert cut(bench) == sound.cut
    bench.leave()


def test_a_knife_gets_its_lead_in_again_and_its_tip_goes_where_it_should(
    ledger: Ledger, tmp_path: Path
) -> None:
    job = job_of(tmp_path / "job", plan_of(KNIFE))
    bench, sound = Bench(job.plan), whole(job)
    sheet = left_half_made(job, bench, ledger, 3, 30)
    lying = len(bench.simulator.sheet.strokes[Face.REVERSE])
    rest = rest_of(job, sheet, seen(sheet, bench, sound), tmp_path / "rest")
    assert rest.plan.passes[-1].setups[-1].lead_in == job.plan.passes[-1].setups[-1].lead_in
    list(send_job(rest, bench.url, bench.hands, ledger=ledger))
    drawn = [np.array(s.points, float) for s in bench.simulator.sheet.strokes[Face.REVERSE]]
    there, made = drawn[:lying], drawn[lying:]
    wanted = tips([np.array(path) for path in sound.programs[3]], 10.0)[1:]
    kept = tips(there[len(sound.programs[2]) :], 10.0)[1:]
    added = tips(made, 10.0)[1:]
    whole_way = sum(_length(path) for path in wanted)
    together = sum(_length(path) for path in [*kept, *added])
    halves = [path for path in kept if not any(_alike(path, other) for other in wanted)]
    assert len(halves) <= 1
    assert abs(together - sum(map(_length, halves)) - whole_way) < 3.0
    for path in added:
        assert any(_alike(path, other) for other in wanted)
    bench.leave()


def _length(path: np.ndarray) -> float:
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def _alike(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether a tip went one way as another, within 0.04 mm and as often."""
    return _apart(one, other) < 1.5 and abs(_length(one) - _length(other)) < 2.0


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    import shapely

    return float(shapely.hausdorff_distance(shapely.LineString(one), shapely.LineString(other)))


def test_the_rest_of_a_rest_is_planned_like_any_other(
    jobs: Jobs, ledger: Ledger, tmp_path: Path
) -> None:
    job, sound = jobs[PENS]
    bench = Bench(job.plan)
    sheet = left_half_made(job, bench, ledger, 0, 5)
    rest = rest_of(job, sheet, seen(sheet, bench, sound), tmp_path / "rest")
    after = left_half_made(rest, bench, ledger, 1, 12)
    lying = cut(bench)
    doubts = {record.number: record.doubtful for record in after.records}
    said = [
        Spoken(
            Fate.CUT if lying[Face.REVERSE, sound.programs[1][stroke]] else Fate.MISSING,
            frozenset({stroke}),
            program="reverse.hpgl",
        )
        for stroke in doubts[1]
    ]
    last = rest_of(rest, after, said, tmp_path / "last")
    remakes = last.plan.remakes
    assert remakes is not None
    assert remakes.written == sheet.id != remakes.sheet
    assert last.plan.whole == job.plan
    list(send_job(last, bench.url, bench.hands, ledger=ledger))
    assert cut(bench) == sound.cut
    bench.leave()


def test_the_rest_is_made_once_and_its_origin_never_gone_on_with(
    jobs: Jobs, ledger: Ledger, tmp_path: Path
) -> None:
    job, sound = jobs[PENS]
    bench = Bench(job.plan)
    sheet = left_half_made(job, bench, ledger, 1, 12)
    said = seen(sheet, bench, sound)
    rest = rest_of(job, sheet, said, tmp_path / "rest")
    other = rest_of(job, sheet, [read_spoken("missing")], tmp_path / "other")
    list(send_job(rest, bench.url, bench.hands, ledger=ledger))
    made = cut(bench)
    for again, words in ((rest, "made already"), (other, "begun already from another plan")):
        with pytest.raises(LedgerRefused, match=words):
            list(send_job(again, bench.url, bench.hands, ledger=ledger))
    with pytest.raises(Exception, match="given up"):
        list(send_job(job, bench.url, bench.hands, ledger=ledger, sheet=sheet.id))
    assert cut(bench) == made
    bench.leave()


def test_a_rest_is_refused_once_more_of_its_origin_was_cut_or_spoken_of(
    jobs: Jobs, ledger: Ledger, tmp_path: Path
) -> None:
    job, sound = jobs[PENS]
    bench = Bench(job.plan)
    sheet = left_half_made(job, bench, ledger, 1, 12)
    rest = rest_of(job, sheet, seen(sheet, bench, sound), tmp_path / "rest")
    ledger.say(sheet.id, 1, Said(Word.GO_ON, sheet.records[1].doubtful[0]))
    before = cut(bench)
    with pytest.raises(LedgerRefused, match="not as it was when its rest was planned"):
        list(send_job(rest, bench.url, bench.hands, ledger=ledger))
    assert cut(bench) == before
    assert ledger.successor(sheet.id) is None
    bench.leave()


@pytest.fixture(scope="module")
def stopped(jobs: Jobs, tmp_path_factory: pytest.TempPathFactory) -> SheetRecord:
    """A sheet whose reverse was stopped within its scores."""
    job, _ = jobs[PENS]
    bench = Bench(job.plan)
    book = Ledger(tmp_path_factory.mktemp("ledger") / "ledger.sqlite")
    sheet = left_half_made(job, bench, book, 1, 12)
    bench.leave()
    book.close()
    return sheet


def with_states(sheet: SheetRecord, *states: State) -> SheetRecord:
    records = [replace(one, state=how) for one, how in zip(sheet.records, states, strict=True)]
    return replace(sheet, records=tuple(records))


@pytest.mark.parametrize(
    ("states", "words"),
    [
        ((State.DONE, State.DONE), "Nothing is missing"),
        ((State.DONE, State.READY), "neither interrupted nor given up"),
        ((State.DONE, State.RUNNING), "is being made"),
    ],
)
def test_a_sheet_that_is_still_gone_on_with_is_refused(
    jobs: Jobs, stopped: SheetRecord, states: tuple[State, ...], words: str
) -> None:
    with pytest.raises(CannotPlan, match=words):
        remake(jobs[PENS][0].plan, with_states(stopped, *states))


def test_a_sheet_of_another_job_and_one_that_was_never_begun_are_refused(
    jobs: Jobs, stopped: SheetRecord
) -> None:
    plan = jobs[PENS][0].plan
    with pytest.raises(CannotPlan, match="begun from another plan"):
        remake(plan, replace(stopped, job="f" * 64))
    fresh = tuple(replace(one, runs=(), state=State.SPOILED) for one in stopped.records)
    with pytest.raises(CannotPlan, match="Nothing is cut"):
        remake(plan, replace(stopped, records=fresh))
    front, reverse = stopped.records
    every = Entry(9, 0, 0, reverse.program.strokes, reverse.program.strokes)
    with pytest.raises(CannotPlan, match="Nothing is missing"):
        remake(plan, replace(stopped, records=(front, replace(reverse, runs=(every,)))))


def test_nothing_is_planned_while_a_stroke_is_in_doubt(jobs: Jobs, stopped: SheetRecord) -> None:
    with pytest.raises(CannotPlan, match=r"may be cut or not: reverse\.hpgl: 1-3"):
        remake(jobs[PENS][0].plan, stopped)


def test_half_a_score_is_refused_and_half_a_cut_is_made_again(
    jobs: Jobs, stopped: SheetRecord
) -> None:
    plan = jobs[PENS][0].plan
    with pytest.raises(CannotPlan, match=r"Stroke 2 of reverse\.hpgl is a score and cut in part"):
        remake(plan, stopped, [read_spoken("2", Fate.HALF), *_each(Fate.CUT, 1, 3)])
    half = remake(plan, stopped, [read_spoken("3", Fate.HALF), *_each(Fate.CUT, 1, 2)])
    gone = remake(plan, stopped, [*_each(Fate.MISSING, 3), *_each(Fate.CUT, 1, 2)])
    assert half.passes == gone.passes
    (work,) = half.passes
    assert sum(len(op.strokes) for setup in work.setups for op in setup.operations) == 5


def _each(fate: Fate, *numbers: int) -> list[Spoken]:
    return [Spoken(fate, frozenset({number - 1})) for number in numbers]


def test_half_a_groove_of_an_outline_that_is_snapped_off_is_refused(tmp_path: Path) -> None:
    """Such an outline is a cut by name, and no cut goes through."""
    grooved = _snapped(plan_of(PENS))
    assert not grooved.material.cut.goes_through
    stopped = _record_of(grooved)
    with pytest.raises(CannotPlan, match="is a groove"):
        remake(grooved, stopped, [read_spoken("3", Fate.HALF)])


def _snapped(plan: Plan) -> Plan:
    from foldmill_fabricate import shelf
    from foldmill_fabricate.formats import programs
    from foldmill_fabricate.passes import ProgramFile

    snap = next(each for each in shelf.material("pp-0.75").cuts if not each.goes_through)
    material: Material = knife_job.material().model_copy(update={"cut": snap})
    files = [
        ProgramFile(name=part.name, face=part.face, setups=part.setups, sha256="")
        for part in programs.layout(plan)
    ]
    return plan.model_copy(update={"material": material, "programs": tuple(files)})


def _record_of(plan: Plan) -> SheetRecord:
    from foldmill_fabricate.plotter.ledger import Program, Record
    from foldmill_fabricate.remaking.strokes import owners

    runs = {"front": (Entry(1, 0, 0, 9, 9),), "reverse": (Entry(1, 0, 0, 3, 2),)}
    records = tuple(
        Record(
            "ABCD",
            number,
            Program(part.name, part.face, "", len(owners(plan, part))),
            State.INTERRUPTED if number else State.DONE,
            *(0, 0, 0.0, ""),
            runs[part.face],
        )
        for number, part in enumerate(plan.programs)
    )
    return SheetRecord("ABCD", plan.digest, "", "", "", "", records)
