"""What the operator is asked for before each set-up, and which answers stop the work."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from fabricate.bench import Bench, small_job, small_plan, stopping
from fabricate.verify import knife_job
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate import gates, shelf
from foldmill_fabricate.delivering import NEW, send_job
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.gates import Answer, Request, check, thickness_range
from foldmill_fabricate.materials import HalfCut
from foldmill_fabricate.operators import Verdict
from foldmill_fabricate.passes import Face, Gate, Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.errors import Stopped
from foldmill_fabricate.plotter.ledger import Ledger, Said, Word
from foldmill_fabricate.sending import Job

SCORE, HOLES = "2-front-score.hpgl", "1-front-holes.hpgl"
FRONT, REVERSE = (Face.FRONT,), (Face.REVERSE,)


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Job:
    return small_job(tmp_path_factory.mktemp("job"))


@pytest.fixture
def ledger(tmp_path: Path) -> Iterator[Ledger]:
    opened = Ledger(tmp_path / "ledger.sqlite")
    yield opened
    opened.close()


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench(small_plan())
    yield made
    made.leave()


def request(gate: Gate, face: Face = Face.FRONT, **more: object) -> Request:
    plan = small_plan()
    found = Request(gate, face, plan.passes[0].setups[1], plan, "K7QF")
    return replace(found, **more)  # type: ignore[arg-type]


def test_a_whole_job_passes_every_gate_in_order(job: Job, bench: Bench, ledger: Ledger) -> None:
    sent = list(send_job(job, bench.url, bench.hands, ledger=ledger))
    load, tool, flip, remove = Gate.LOAD, Gate.TOOL, Gate.FLIP, Gate.REMOVE
    assert bench.hands.gates == [load, tool, tool, flip, tool, remove]
    answered = ledger.answers(sent[0].sheet)
    tried = [one.told for one in answered if one.gate == "test-cut"]
    assert {each["verdict"] for each in tried} == {"not wanted"}
    gates = [one.gate for one in answered if one.gate != "test-cut"]
    assert gates == [gate.value for gate in bench.hands.gates]


def test_what_was_measured_is_kept_with_who_measured_it(
    job: Job, bench: Bench, ledger: Ledger
) -> None:
    bench.hands.answers[Gate.LOAD] = Answer(thickness=0.77, temperature=21.5, who="Ada")
    sent = list(send_job(job, bench.url, bench.hands, FRONT, ledger=ledger))
    (loaded,) = (one for one in ledger.answers(sent[0].sheet) if one.gate == "load")
    assert (loaded.who, loaded.told) == ("Ada", {"thickness": 0.77, "temperature": 21.5})
    history = ledger.history(sent[0].sheet)
    assert ("Ada", "load: temperature 21.5, thickness 0.77") in {(w, t) for _, w, t in history}


@pytest.mark.parametrize("thickness", [0.4, 0.59, 0.9, 3.0])
def test_a_sheet_of_another_thickness_is_refused_before_it_is_cut(
    job: Job, bench: Bench, ledger: Ledger, thickness: float
) -> None:
    bench.hands.answers[Gate.LOAD] = Answer(thickness=thickness)
    with pytest.raises(CannotSend, match=r"from 0\.60 to 0\.89 mm thick, and this one has"):
        list(send_job(job, bench.url, bench.hands, ledger=ledger))
    assert not bench.simulator.sheet.seen(Face.FRONT)


@pytest.mark.parametrize("slug", ["pp-0.5", "pp-0.8", "pet-0.25", "card-250"])
def test_a_sheet_as_thick_as_its_preset_says_is_within_its_range(slug: str) -> None:
    material = shelf.material(slug)
    cutter = shelf.machine("flatbed-wheel-knife")
    plan = make(knife_job.fold(), material, cutter, blank=(260.0, 240.0))
    low, high = thickness_range(plan)
    assert low <= material.thickness <= high


@given(st.floats(0.2, 2.0), st.floats(0.2, 0.9))
def test_no_half_cut_is_made_deeper_or_shallower_than_the_material_allows(
    thickness: float, exposure: float
) -> None:
    score = small_plan().material.score
    assert isinstance(score, HalfCut)
    asked = request(Gate.TOOL, thickness=thickness)
    try:
        check(asked, Answer(exposure=exposure))
    except CannotSend:
        return
    assert score.depth_ratio_min - 1e-9 <= exposure / thickness <= score.depth_ratio_max + 1e-9
    assert thickness - exposure >= score.web_min - 1e-9


@pytest.mark.parametrize("gate", [Gate.FLIP, Gate.RE_REGISTER])
def test_two_half_done_sheets_are_never_swapped(gate: Gate) -> None:
    check(request(gate), Answer(sheet=" k7qf "))
    for wrong in ("", "K7QG", "NEW"):
        with pytest.raises(CannotSend, match="is to be K7QF, and the id that was read off it"):
            check(request(gate), Answer(sheet=wrong))


@pytest.mark.parametrize("gate", [Gate.LOAD, Gate.TOOL, Gate.REMOVE])
def test_who_answers_beside_the_wrong_machine_is_told_by_the_id_they_give(gate: Gate) -> None:
    check(request(gate), Answer())
    with pytest.raises(CannotSend, match="and the id that was read off it is 93ZM"):
        check(request(gate), Answer(sheet="93zm"))


def test_the_wrong_sheet_at_the_flip_is_not_cut(job: Job, bench: Bench, ledger: Ledger) -> None:
    (_, one) = send_job(job, bench.url, bench.hands, FRONT, ledger=ledger)
    (_, two) = send_job(job, bench.url, bench.hands, FRONT, ledger=ledger, sheet=NEW)
    assert one.sheet != two.sheet
    bench.hands.answers[Gate.FLIP] = Answer(sheet=two.sheet)
    with pytest.raises(CannotSend, match=f"is to be {one.sheet}"):
        list(send_job(job, bench.url, bench.hands, REVERSE, ledger=ledger, sheet=one.sheet))
    assert not bench.simulator.sheet.seen(Face.REVERSE)


def test_a_sheet_that_was_left_is_looked_at_before_work_goes_on(
    job: Job, bench: Bench, ledger: Ledger
) -> None:
    with pytest.raises(Stopped):
        list(send_job(job, bench.url, bench.hands, FRONT, stopping(SCORE, 9), ledger=ledger))
    (sheet,) = ledger.open_sheets()
    bench.hands.gates.clear()
    record = sheet.records[1]
    bench.hands.words = [Said(Word.GO_ON, record.runs[-1].acked)]
    list(send_job(job, bench.url, bench.hands, FRONT, ledger=ledger, sheet=sheet.id))
    assert bench.hands.gates == [Gate.RE_REGISTER, Gate.TOOL]
    assert len(bench.simulator.sheets) == 2  # the one there was at first, and the loaded one


def test_a_front_that_was_moved_is_given_up_and_a_reverse_is_measured_again() -> None:
    with pytest.raises(CannotSend, match="Give it up with foldmill sheets K7QF --spoiled"):
        check(request(Gate.RE_REGISTER), Answer("K7QF", touched=True))
    with pytest.raises(CannotSend, match="measure its registration marks where they are now"):
        check(request(Gate.RE_REGISTER, Face.REVERSE), Answer("K7QF", touched=True))
    marks = ((1.0, 2.0), (3.0, 4.0))
    check(request(Gate.RE_REGISTER, Face.REVERSE), Answer("K7QF", touched=True, marks=marks))


def test_a_temperature_that_no_workshop_has_is_not_believed() -> None:
    check(request(Gate.LOAD), Answer(temperature=21.0))
    for wrong in (-40.0, 212.0, float("nan")):
        with pytest.raises(CannotSend, match="is not believed"):
            check(request(Gate.LOAD), Answer(temperature=wrong))


def test_an_untested_preset_is_tried_in_the_waste_before_the_part(
    job: Job, bench: Bench, ledger: Ledger
) -> None:
    bench.hands.verdicts = [Verdict.AGAIN, Verdict.GOOD]
    sent = list(send_job(job, bench.url, bench.hands, FRONT, ledger=ledger))
    assert bench.hands.offered == ["front-holes", "front-score"]
    first, second, *_ = bench.simulator.sheet.strokes[Face.FRONT]
    for tried in (first, second):
        xs, ys = zip(*tried.points, strict=True)
        assert max(max(xs) - min(xs), max(ys) - min(ys)) == 20 * 40
        assert len(tried.points) == 1 + small_plan().material.cut.repeats
    assert not set(first.points) & set(second.points)
    tried_before = [one.told for one in ledger.answers(sent[0].sheet) if one.gate == "test-cut"]
    assert [each["verdict"] for each in tried_before] == ["again", "good", "not wanted"]


def test_a_test_cut_that_was_cut_off_is_never_gone_over_again(
    job: Job, bench: Bench, ledger: Ledger
) -> None:
    """Cut twice it would be deeper than the part becomes, and be found good for that."""

    begun: list[str] = []

    def gone(request: Request) -> Verdict:
        begun.append(request.sheet)
        raise KeyboardInterrupt

    bench.hands.verdicts = [Verdict.GOOD]
    whole, bench.hands.judge = bench.hands.judge, gone  # type: ignore[method-assign]
    with pytest.raises(KeyboardInterrupt):
        list(send_job(job, bench.url, bench.hands, FRONT, ledger=ledger))
    bench.hands.judge = whole  # type: ignore[method-assign]
    list(send_job(job, bench.url, bench.hands, FRONT, ledger=ledger, sheet=begun[0]))
    first, *_ = bench.simulator.sheets[-2].strokes[Face.FRONT]
    second, *_ = bench.simulator.sheet.strokes[Face.FRONT]
    assert not set(first.points) & set(second.points)


def test_a_test_cut_that_is_no_good_stops_before_the_part_is_cut(
    job: Job, bench: Bench, ledger: Ledger
) -> None:
    bench.hands.verdicts = [Verdict.STOP]
    with pytest.raises(CannotSend, match="nothing of the part is cut with that setting"):
        list(send_job(job, bench.url, bench.hands, ledger=ledger))
    assert len(bench.simulator.sheet.seen(Face.FRONT)) == 1


def test_a_test_cut_may_be_asked_for_of_any_preset(job: Job, bench: Bench, ledger: Ledger) -> None:
    plain = Bench(small_plan())
    list(send_job(job, plain.url, plain.hands))
    list(send_job(job, bench.url, bench.hands, ledger=ledger, test_cut=True))
    assert bench.hands.offered == []
    more = len(bench.simulator.sheet.seen(Face.FRONT)) - len(plain.simulator.sheet.seen(Face.FRONT))
    assert more == 2
    plain.leave()


def test_plans_made_before_the_new_gates_still_load() -> None:
    text = small_plan().model_dump_json()
    assert "re-register" not in text
    assert "remove" not in text
    assert Plan.model_validate_json(text) == small_plan()


def test_whoever_comes_back_to_a_new_face_turns_the_sheet_and_sets_the_tool() -> None:
    plan = small_plan()
    reverse = plan.passes[1].setups[0]
    assert gates.due(reverse, plan, returned=False, begun=False) == (Gate.FLIP,)
    assert gates.due(reverse, plan, returned=True, begun=False) == (Gate.FLIP, Gate.TOOL)
    assert gates.due(reverse, plan, returned=True, begun=True) == (Gate.RE_REGISTER, Gate.TOOL)
