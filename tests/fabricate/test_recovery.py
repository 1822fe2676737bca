"""What goes on after an interruption: the tip's way, what is told, and what is refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fabricate.bench import Bench, small_job, small_plan, stopping
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill_fabricate import recovery
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter import blade, resume
from foldmill_fabricate.plotter.errors import LedgerRefused, Stopped
from foldmill_fabricate.plotter.ledger import Ledger, Said, Word
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.standing import stand
from foldmill_fabricate.sending import Job
from foldmill_fabricate.verify.blade import STARTS, dragged, tips

KNIFE = "generic-hpgl-drag-knife"
FRONT, REVERSE = (Face.FRONT,), (Face.REVERSE,)
SCORE, CUT = "2-front-score.hpgl", "4-reverse-cut.hpgl"
OFFSET = 0.25


@pytest.fixture(scope="module")
def knife(tmp_path_factory: pytest.TempPathFactory) -> Job:
    return small_job(tmp_path_factory.mktemp("knife"), small_plan(KNIFE))


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Job:
    return small_job(tmp_path_factory.mktemp("plain"))


@pytest.fixture
def ledger(tmp_path: Path) -> Iterator[Ledger]:
    opened = Ledger(tmp_path / "ledger.sqlite")
    yield opened
    opened.close()


def part_of(job: Job, name: str) -> Any:
    return next(part for part in job.plan.programs if part.name == name)


def holders(drawn: list[Any]) -> list[np.ndarray]:
    return [np.array(stroke.points, float) / 40 for stroke in drawn]


@settings(max_examples=12)
@given(st.integers(1, 4), st.integers(0, 11), st.sampled_from(STARTS.tolist()), st.data())
def test_a_knife_goes_on_with_its_tip_where_it_would_have_been(
    knife: Job, stroke: int, vertex: int, askew: float, data: st.DataObject
) -> None:
    """Wherever a program is taken up, and however somebody has turned the blade meanwhile."""
    part = part_of(knife, data.draw(st.sampled_from([SCORE, CUT, "1-front-holes.hpgl"])))
    program = recovery.program_of(knife, part)
    stroke = min(stroke, program.strokes - 1)
    path = resume.vertices(program, stroke)
    vertex = min(vertex, len(path) - 2)
    overlap = data.draw(st.sampled_from([0.0, 1.0, 5.0])) if part.name == CUT else 0.0
    start = Start(stroke, vertex, overlap, resume.lead_in(program, stroke))
    left = resume.rest(program, knife.plan.machine, 240, start)
    whole = [np.array(resume.vertices(program, k)) / 40 for k in range(program.strokes)]
    ways = [np.array(way, float) / 40 for way in _ways(left.data)]
    right = tips(whole, OFFSET)[stroke]
    cut = [way[0] for way, _ in dragged(ways, OFFSET, np.array([askew]))]
    assert np.array_equal(whole[-1][-1], ways[-1][-1])
    for spot in cut[1]:  # cut[0] is in the waste
        assert _from_line(spot, right) < 0.03
    assert np.hypot(*(cut[1][-1] - right[-1])) < 0.001


def _ways(data: bytes) -> list[list[tuple[float, float]]]:
    from foldmill_fabricate.verify.interpreter import interpret

    return [run.points.tolist() for run in interpret(b"IN;" + data).runs]


def _from_line(spot: np.ndarray, line: np.ndarray) -> float:
    a, d = line[:-1], np.diff(line, axis=0)
    length = np.maximum((d**2).sum(axis=1), 1e-12)
    share = np.clip(((spot - a) * d).sum(axis=1) / length, 0, 1)
    return float(np.hypot(*(a + share[:, None] * d - spot).T).min())


@pytest.mark.parametrize("after", [14, 21])
def test_a_knife_job_that_was_stopped_is_cut_to_its_end_on_the_simulator(
    knife: Job, ledger: Ledger, after: int
) -> None:
    whole, bench = Bench(small_plan(KNIFE)), Bench(small_plan(KNIFE))
    list(send_job(knife, whole.url, whole.hands, FRONT))
    with pytest.raises(Stopped):
        list(send_job(knife, bench.url, bench.hands, FRONT, stopping(SCORE, after), ledger=ledger))
    (sheet,) = ledger.open_sheets()
    record = sheet.records[1]
    bench.simulator.clock.sleep(5)
    bench.simulator.advance()
    before = len(bench.simulator.sheet.strokes[Face.FRONT])
    place = Said(Word.GO_ON, record.doubtful[-1])
    bench.hands.words = [place]
    list(send_job(knife, bench.url, bench.hands, FRONT, ledger=ledger, sheet=sheet.id))
    led, *cut = holders(bench.simulator.sheet.strokes[Face.FRONT][before:])
    wanted = holders(whole.simulator.sheet.strokes[Face.FRONT])
    right = tips(wanted, OFFSET)[-len(cut) :]
    for askew in STARTS:
        _, *found = tips([led, *cut], OFFSET, askew)
        for one, other in zip(found, right, strict=True):
            assert max(_from_line(spot, other) for spot in one) < 0.03
    for each in (whole, bench):
        each.leave()


@given(st.floats(-3.1, 3.1), st.floats(-3.1, 3.1), st.floats(4.0, 40.0))
def test_a_blade_is_swung_about_its_resting_tip(now: float, wanted: float, offset: float) -> None:
    holder = (1000.0, 2000.0)
    way = [holder, *blade.swung(holder, now, wanted, offset)]
    tip = np.array(holder) - offset * np.array([np.cos(now), np.sin(now)])
    (path,) = tips([np.array(way)], offset, now)
    assert np.hypot(*(path - tip).T).max() < 1.5  # steps: each chord ends on whole ones
    assert abs((blade.heading([way], offset, now) - wanted + np.pi) % (2 * np.pi) - np.pi) < 0.3


def test_our_blade_and_the_one_of_verification_turn_alike(knife: Job) -> None:
    program = recovery.program_of(knife, part_of(knife, SCORE))
    ways = [resume.vertices(program, k) for k in range(program.strokes)]
    *_, (_, headings) = dragged([np.array(way) for way in ways], 10.0, np.array([0.3]))
    apart = blade.heading(ways, 10.0, 0.3) - headings[0, -1]
    assert abs((apart + np.pi) % (2 * np.pi) - np.pi) < 1e-9


def test_a_person_is_told_in_which_stroke_the_machine_stands(plain: Job, ledger: Ledger) -> None:
    """Half-cut strokes go there and back: the place alone does not say how often."""
    told = []
    for after in range(8, 16):
        bench = Bench(small_plan())
        with pytest.raises(Stopped):
            list(send_job(plain, bench.url, bench.hands, FRONT, stopping(SCORE, after)))
        bench.simulator.clock.sleep(5)
        part = part_of(plain, SCORE)
        program = recovery.program_of(plain, part)
        found = _stand(bench)
        place = recovery._told(program, 0, program.strokes, found, plain.plan.machine)
        told.append(place)
        bench.leave()
    assert any("comes by there 2 times (vertex 0, 2)" in each for each in told)
    assert all("Which time it was it cannot say." in each or "no vertex" in each for each in told)


def _stand(bench: Bench) -> Any:
    from foldmill_fabricate.plotter import link

    machine = bench.simulator.machine
    with link.open_port(bench.url, machine) as port:
        return stand(port, machine)


def test_a_tool_that_is_down_has_left_the_strokes_first_vertex_behind(plain: Job) -> None:
    program = recovery.program_of(plain, part_of(plain, SCORE))
    first = resume.vertices(program, 0)
    assert first[0] == first[-1]  # there and back
    assert resume.locate(program, 0, 1, first[0]) is None
    assert resume.locate(program, 0, 1, first[0], is_down=True) == Start(1)
    assert resume.locate(program, 0, 1, first[1], is_down=True) == Start(0, 1)


def test_the_machine_says_whether_its_tool_is_down(plain: Job) -> None:
    bench = Bench(small_plan())
    from foldmill_fabricate.plotter import link

    with link.open_port(bench.url, bench.simulator.machine) as port:
        port.write(b"IN;SP1;PU400,400;PD800,800;")
        bench.simulator.clock.sleep(5)
        found = stand(port, bench.simulator.machine)
        assert found is not None
        assert (found.at, found.is_down) == ((800, 800), True)
        port.write(b"PU;")
        bench.simulator.clock.sleep(1)
        found = stand(port, bench.simulator.machine)
        assert found is not None
        assert found.is_down is False
    bench.leave()


@pytest.mark.parametrize("slug", ["generic-hpgl-600", "generic-hpgl-pens"])
def test_only_a_through_cut_is_cut_again_for_some_mm(slug: str, tmp_path: Path) -> None:
    job = small_job(tmp_path, small_plan(slug))
    for part in job.plan.programs:
        program = recovery.program_of(job, part)
        for stroke in range(program.strokes):
            setup = recovery.setup_at(job, part, stroke)
            said = Said(Word.GO_ON, stroke, 1, 2.0)
            if setup.process == "cut":
                recovery.refuse(job, part, said)
            else:
                with pytest.raises(LedgerRefused, match="is a score: 2 mm of it cut again"):
                    recovery.refuse(job, part, said)
    with pytest.raises(LedgerRefused, match="nothing before it to overlap"):
        recovery.refuse(job, part, Said(Word.GO_ON, program.strokes - 1, 0, 2.0))


def test_the_set_up_of_a_stroke_is_the_one_that_drew_it(tmp_path: Path) -> None:
    """Where SP selects tools, one program holds several set-ups."""
    job = small_job(tmp_path, small_plan("generic-hpgl-pens"))
    bench = Bench(small_plan("generic-hpgl-pens"))
    list(send_job(job, bench.url, bench.hands))
    for part in job.plan.programs:
        drawn = bench.simulator.sheet.strokes[part.face]
        tools = [recovery.setup_at(job, part, k).tool for k in range(len(drawn))]
        assert tools == [stroke.tool for stroke in drawn]
        assert len(set(tools)) == 2
    bench.leave()


def test_an_overlap_is_declared_in_the_ledger_and_cut(plain: Job, ledger: Ledger) -> None:
    bench = Bench(small_plan())
    with pytest.raises(Stopped):
        list(send_job(plain, bench.url, bench.hands, tell=stopping(CUT, 9), ledger=ledger))
    (sheet,) = ledger.open_sheets()
    record = sheet.records[3]
    stroke = record.doubtful[-1]
    path = resume.vertices(recovery.program_of(plain, part_of(plain, CUT)), stroke)
    before = len(bench.simulator.sheet.strokes[Face.REVERSE])
    bench.hands.words = [Said(Word.GO_ON, stroke, 1, 2.0)]
    list(send_job(plain, bench.url, bench.hands, REVERSE, ledger=ledger, sheet=sheet.id))
    first = bench.simulator.sheet.strokes[Face.REVERSE][before].points
    assert np.hypot(*(np.array(first[0]) - path[1])) == pytest.approx(2.0 * 40, abs=1)
    assert first[1] == path[1]
    told = [what for _, _, what in ledger.history(sheet.id)]
    assert f"go on at stroke {stroke + 1}, from inside it at vertex 1, cutting 2 mm again" in told
    bench.leave()


def test_a_job_that_was_planned_again_does_not_go_on_on_the_old_sheet(
    plain: Job, ledger: Ledger, tmp_path: Path
) -> None:
    bench = Bench(small_plan())
    (*_, front) = send_job(plain, bench.url, bench.hands, FRONT, ledger=ledger)
    cut = len(bench.simulator.sheet.strokes[Face.FRONT])
    again = small_job(
        tmp_path / "again", small_plan().model_copy(update={"temperatures": (21, 22)})
    )
    assert again.id != plain.id
    with pytest.raises(LedgerRefused, match=f"planned again.*Sheet {front.sheet}: 1-front-holes"):
        list(send_job(again, bench.url, bench.hands, REVERSE, ledger=ledger))
    with pytest.raises(LedgerRefused, match="planned otherwise: its programs are not these"):
        list(send_job(again, bench.url, bench.hands, REVERSE, ledger=ledger, sheet=front.sheet))
    assert len(bench.simulator.sheet.strokes[Face.FRONT]) == cut
    ledger.give_up(front.sheet)
    (*_, other) = send_job(again, bench.url, bench.hands, FRONT, ledger=ledger)
    assert other.sheet != front.sheet
    bench.leave()
