"""A foreign drawing is planned, proved as far as it can be, and cut like any other job."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
import shapely
from fabricate.bench import Bench
from fabricate.half_made import KNIFE, LASER, ONE_TOOL, PENS, left_half_made
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill import CreasePattern, Fold
from foldmill_fabricate import shelf
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.errors import CannotPlan, CannotSend, DoesNotFit
from foldmill_fabricate.foreign import Drawing, Use, limits, plan_drawing, read, write_drawing
from foldmill_fabricate.foreign.nesting import inside_first
from foldmill_fabricate.foreign.plan import thinned
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Operation, Plan, Role, Stroke
from foldmill_fabricate.plotter.ledger import Ledger, State
from foldmill_fabricate.remaking import read_spoken, remake, write_remake
from foldmill_fabricate.sending import open_job
from foldmill_fabricate.verify import report, verify_folder
from foldmill_fabricate.verify.rule import prove_rule

TEXT = (
    b"IN;SP1;PU-400,0;PD4000,0,4000,4000,-400,4000,-400,0;PU;SP2;PU0,2000;PD4000,2000;PU0,1000;"
    b"PD4000,1000;PU;SP3;PU1000,3000;CI400;PU2000,3000;PD;AR400,0,180;PU;SP0;"
)
PENS_USED = {1: Use.CUT, 2: Use.SCORE, 3: Use.INNER}
SMALL: dict[str, Any] = {"blank": (200.0, 180.0), "carrier": (300.0, 300.0)}


def drawing(data: bytes = TEXT) -> Drawing:
    return read(data, "lamp.plt")


def planned(slug: str = PENS, data: bytes = TEXT) -> Plan:
    material, machine = shelf.material("pp-0.75"), shelf.machine(slug)
    return plan_drawing(drawing(data), PENS_USED, material, machine, **SMALL)


def strokes(plan: Plan, role: Role) -> list[np.ndarray]:
    return [
        np.array(stroke.points)
        for work in plan.passes
        for setup in work.setups
        for operation in setup.operations
        if operation.role is role
        for stroke in operation.strokes
    ]


def test_its_lines_lie_in_the_middle_of_the_blank_as_in_the_file() -> None:
    plan = planned()
    shift = np.array([plan.placement.dx, plan.placement.dy])
    for pen, role in ((1, Role.CUT_OUTER), (2, Role.SCORE), (3, Role.CUT_INNER)):
        given = shapely.MultiLineString([np.array(way) + shift for way in drawing().pens[pen]])
        made = shapely.MultiLineString(strokes(plan, role))
        assert shapely.hausdorff_distance(given, made) < 1e-6
        assert abs(given.length - made.length) < 1e-6
    outline = np.vstack(strokes(plan, Role.CUT_OUTER))
    assert np.allclose(outline.min(axis=0) + outline.max(axis=0), (200, 180))
    roles = [op.role for setup in plan.passes[0].setups for op in setup.operations]
    assert roles == [Role.SCORE, Role.CUT_INNER, Role.CUT_OUTER]


@pytest.mark.long
@pytest.mark.parametrize("slug", [ONE_TOOL, PENS, KNIFE, "grbl-drag-knife", "silhouette-like"])
def test_it_is_written_proved_and_cut_like_any_other_job(slug: str, tmp_path: Path) -> None:
    plan = planned(slug)
    write_drawing(plan, tmp_path, [plan.machine.language])
    assert not (tmp_path / "pattern.fold").exists()
    proof = verify_folder(tmp_path)
    assert proof.ok
    assert [finding.code for finding in proof.findings] == ["no-pattern"]
    assert "not derived from a pattern" in report(proof)
    job, bench = open_job(tmp_path), Bench(plan)
    assert {one.state for one in send_job(job, bench.url, bench.hands)} == {State.DONE}
    bench.leave()


@settings(max_examples=8, deadline=None)
@given(st.integers(5, 40), st.sampled_from([PENS, ONE_TOOL]), st.randoms(use_true_random=False))
def test_lines_drawn_in_another_order_and_direction_make_the_same_programs(
    count: int, slug: str, dice: Random
) -> None:
    rows = dice.sample(range(0, 4000, 10), count)
    lines = [((x := dice.randrange(4000), y), (x + dice.randrange(1, 300), y)) for y in rows]
    mixed = [dice.choice((each, each[::-1])) for each in dice.sample(lines, count)]
    material, machine = shelf.material("pp-0.75"), shelf.machine(slug)
    written = []
    for each in (lines, mixed):
        text = "".join(f"PU{a},{b};PD{c},{d};" for (a, b), (c, d) in each)
        read_again = drawing(f"IN;SP1;{text}PU;SP0;".encode())
        plan = plan_drawing(read_again, {1: Use.SCORE}, material, machine, **SMALL)
        written.append(hpgl.write(plan, Fold(no_pattern())))
    assert written[0] == written[1]


def test_an_edited_program_is_not_sent(tmp_path: Path) -> None:
    write_drawing(planned(), tmp_path, ["hpgl"])
    program = tmp_path / "front.hpgl"
    program.write_bytes(program.read_bytes().replace(b"PU;SP0", b"PU9,9;PD99,99;PU;SP0"))
    with pytest.raises(CannotSend, match="does not verify"):
        open_job(tmp_path)


def test_no_byte_of_it_reaches_the_port(tmp_path: Path) -> None:
    """Odd spellings of the file are gone from what is sent."""
    odd = TEXT.replace(b"PD4000,2000", b"pd 3.99999e"[:9] + b",2000 , +4000. 2000")
    write_drawing(planned(data=odd), tmp_path, ["hpgl"])
    job, bench = open_job(tmp_path), Bench(planned())
    list(send_job(job, bench.url, bench.hands))
    sent = bytes(bench.simulator.device.traffic.program)
    assert b"pd" not in sent
    assert b"3.9999" not in sent
    assert b"CI" not in sent
    bench.leave()


def test_the_rest_of_one_that_was_stopped_is_planned_without_a_pattern(tmp_path: Path) -> None:
    write_drawing(planned(), tmp_path / "job", ["hpgl"])
    job, ledger = open_job(tmp_path / "job"), Ledger(tmp_path / "ledger.sqlite")
    bench = Bench(job.plan)
    sheet = left_half_made(job, bench, ledger, 0, 5)
    rest = remake(job.plan, sheet, [read_spoken("missing")])
    write_remake(rest, job.path, tmp_path / "rest", ["hpgl"])
    proof = verify_folder(tmp_path / "rest")
    assert proof.ok
    assert {finding.code for finding in proof.findings} == {"no-pattern", "remakes"}
    ledger.close()
    bench.leave()


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"SP1;PU0,0;PD4000,0;PU0,0;PD2000,0;PU;", r"run along each other for 50\.00 mm"),
        (b"SP1;PU0,0;PD4000,0,0,0;PU;", r"run along each other for 100\.00 mm"),
        (b"SP1;PU0,0;PD4000,0;PU;SP2;PU3000,0;PD5000,0;PU;", r"run along each other for 25\.00 mm"),
        (b"SP1;PU0,0;PD4000,0;PU0,0;PD4000,10;PU;", "run along each other"),
    ],
    ids=["within", "and back", "another pen", "at a small angle"],
)
def test_what_would_be_cut_twice_is_refused(data: bytes, told: str) -> None:
    pens = {1: Use.SCORE, 2: Use.CUT} if b"SP2" in data else {1: Use.SCORE}
    with pytest.raises(CannotPlan, match=told):
        plan_drawing(drawing(data), pens, shelf.material("pp-0.75"), shelf.machine(PENS))


def test_a_line_that_is_drawn_again_is_made_once_and_crossings_are_no_overlaps() -> None:
    again = b"SP1;PU0,0;PD4000,0;PU4000,0;PD0,0;PU2000,-900;PD2000,900;PU0,200;PD4000,-200;PU;"
    plan = plan_drawing(
        drawing(again), {1: Use.SCORE}, shelf.material("pp-0.75"), shelf.machine(PENS)
    )
    assert len(strokes(plan, Role.SCORE)) == 3


def test_pens_of_which_nothing_is_said_and_drawings_that_do_not_fit_are_refused() -> None:
    material, machine = shelf.material("pp-0.75"), shelf.machine(PENS)
    with pytest.raises(CannotPlan, match="pen 2 draws 2 lines, pen 3 draws 2 lines"):
        plan_drawing(drawing(), {1: Use.CUT}, material, machine)
    with pytest.raises(CannotPlan, match="has no pen 7; it draws with 1, 2, 3"):
        plan_drawing(drawing(), {**PENS_USED, 7: Use.CUT}, material, machine)
    with pytest.raises(CannotPlan, match="nothing is left"):
        plan_drawing(drawing(), dict.fromkeys((1, 2, 3), Use.SKIP), material, machine)
    with pytest.raises(DoesNotFit, match=r"110\.0 × 100\.0 mm.*12\.0 mm are missing.*112 × 102"):
        plan_drawing(drawing(), PENS_USED, material, machine, blank=(100.0, 200.0))
    with pytest.raises(CannotPlan, match="would perforate the scores"):
        plan_drawing(drawing(), PENS_USED, material, shelf.machine(LASER))


def _with(plan: Plan, **new: object) -> Plan:
    (work,) = plan.passes
    first, *others = work.setups
    operation: Operation = first.operations[0].model_copy(update=new)
    setup = first.model_copy(update={"operations": (operation, *first.operations[1:])})
    changed = work.model_copy(update={"setups": (setup, *others)})
    return plan.model_copy(update={"passes": (changed,)})


def test_what_is_wrong_in_its_plan_is_found_without_a_pattern() -> None:
    plan = planned()
    pattern = no_pattern()
    own = plan.passes[0].setups[0].operations[0].strokes
    (x, y), (u, v) = own[0].points
    half = Stroke(points=((x, y), ((x + u) / 2, (y + v) / 2)))
    edge = Stroke(points=((0.5, 0.5), (50.0, 0.5)))
    for new, code in (
        ({"strokes": (*own, half)}, "cut-twice"),
        ({"strokes": (*own, edge)}, "part-clearance"),
        ({"repeats": 9}, "set-up-values"),
        ({"role": Role.WITNESS}, "no-such-line"),
    ):
        assert code in {finding.code for finding in prove_rule(_with(plan, **new), pattern)}
    assert [finding.code for finding in prove_rule(plan, pattern)] == ["no-pattern"]


def no_pattern() -> CreasePattern:
    return CreasePattern.from_lines([], [], [], [])


def test_corners_nearer_than_a_step_are_one_and_the_line_stays_where_it_is() -> None:
    fine = [(k * 0.003, np.sin(k * 0.003)) for k in range(3000)]
    kept = thinned(fine)
    assert kept[0] == fine[0]
    assert kept[-1] == fine[-1]
    assert len(kept) < len(fine) / 5
    gap = shapely.hausdorff_distance(shapely.LineString(fine), shapely.LineString(kept))
    assert gap < limits.APART_MM
    speck = b"SP1;PU0,0;PD4000,0;PU;PU9,9;PD9.1,9;PD9.1,9.1;PD9,9;PU;"
    assert len(strokes(plan_drawing(drawing(speck), {1: Use.CUT}, *presets()), Role.CUT_OUTER)) == 1


def presets() -> tuple[Material, Machine]:
    return shelf.material("pp-0.75"), shelf.machine(PENS)


@given(st.lists(st.tuples(*[st.floats(0, 100)] * 4), min_size=1, max_size=12))
def test_what_lies_inside_a_closed_line_is_cut_before_it(boxes: list[tuple[float, ...]]) -> None:
    rings = []
    for x, y, w, h in boxes:
        corners = [(x, y), (x + w + 1, y), (x + w + 1, y + h + 1), (x, y + h + 1), (x, y)]
        rings.append(Stroke(points=tuple(corners)))
    done = inside_first(rings, 1, np.zeros(2))
    assert sorted(map(_box, done)) == sorted(map(_box, rings))
    areas = [shapely.box(*_box(ring)) for ring in done]
    for k, area in enumerate(areas):
        assert not any(area.contains_properly(later) for later in areas[k + 1 :])


def _box(ring: Stroke) -> tuple[float, float, float, float]:
    x, y = np.array(ring.points).T
    return float(x.min()), float(y.min()), float(x.max()), float(y.max())
