"""Eight processes: which face they work on, what they draw, and what a machine lacks for them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import stools
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from foldmill import Assignment, CreasePattern, Fold
from foldmill_fabricate import shelf
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.kinds import Kind
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Operation, Plan, Role, Stroke
from foldmill_fabricate.plan import make
from foldmill_fabricate.sheet import placed
from foldmill_fabricate.verify import verify
from foldmill_fabricate.verify.rule import prove_rule

WAYS: list[tuple[str, str, Kind]] = [
    ("pp-0.75", "generic-hpgl-600", "half-cut"),
    ("pp-0.8", "flatbed-wheel-knife", "v-score"),
    ("card-250", "flatbed-wheel-knife", "crease-wheel"),
    ("paper-80-120", "generic-hpgl-pens", "stylus"),
    ("pp-0.5", "flatbed-wheel-knife", "perforation"),
    ("paper-80-120", "generic-hpgl-600", "pen"),
]
GROOVE = {
    "half-cut": "outside",
    "v-score": "inside",
    "crease-wheel": "outside",
    "stylus": "inside",
    "perforation": "through",
    "pen": "through",
}
"""Where facts about each process say that its groove is; written down here a second time."""
EVERY = pytest.mark.parametrize(("material", "machine", "kind"), WAYS)


def fan(letters: str, turn: float = 0.0, side: float = 160.0) -> CreasePattern:
    """A square with creases from its middle to points on its sides, not in corners."""
    h, n = side / 2, len(letters)
    corners = [(-h, -h), (h, -h), (h, h), (-h, h)]
    ways = np.radians(turn + 360 * np.arange(n) / n)
    rays = np.column_stack([np.cos(ways), np.sin(ways)])
    ends = h * rays / np.abs(rays).max(axis=1)[:, None]
    rim = sorted([*corners, *map(tuple, ends.tolist())], key=lambda p: np.arctan2(p[1], p[0]))
    spots = [*rim, (0.0, 0.0)]
    sides = [(k, (k + 1) % len(rim)) for k in range(len(rim))]
    spokes = [(rim.index(tuple(end)), len(rim)) for end in ends.tolist()]
    angles = [0.0] * len(sides) + [{"M": -70.0, "V": 70.0}[c] for c in letters]
    return CreasePattern.from_lines(spots, sides + spokes, "B" * len(sides) + letters, angles)


def planned(pattern: CreasePattern, material: str, machine: str, kind: Kind) -> Plan:
    return make(Fold(pattern), shelf.material(material), shelf.machine(machine), score=kind)


def scores(plan: Plan, face: Face) -> list[Stroke]:
    return [
        stroke
        for side in plan.passes
        if side.face is face
        for setup in side.setups
        for operation in setup.operations
        if operation.role is Role.SCORE
        for stroke in operation.strokes
    ]


def drawn_at(plan: Plan, face: Face, start: np.ndarray, end: np.ndarray) -> bool:
    """Whether any score of a face lies on the line from start to end."""
    step = (end - start) / np.hypot(*(end - start))
    return any(drawn_on(np.array(stroke.points), start, step) for stroke in scores(plan, face))


@pytest.mark.long
@EVERY
@settings(max_examples=8)
@given(letters=st.text("MV", min_size=3, max_size=7), turn=st.floats(5, 25))
@example(letters="MVM", turn=15.2)
def test_the_groove_of_every_fold_is_on_the_side_the_process_says(
    material: str, machine: str, kind: Kind, letters: str, turn: float
) -> None:
    rays = turn + 360 * np.arange(len(letters)) / len(letters)
    assume((abs(rays % 90 - 45) > 0.1).all())  # a crease that ends in a corner is another pattern
    pattern = fan(letters, turn)
    plan = planned(pattern, material, machine, kind)
    spots = placed(pattern.vertices, plan.placement)
    for (a, b), code in zip(pattern.edges, pattern.assignments, strict=True):
        if code not in (Assignment.M, Assignment.V):
            continue
        middle = len(pattern.vertices) - 1
        start, end = spots[middle], spots[a if b == middle else b]
        on = {face for face in Face if drawn_at(plan, face, start, end)}
        # the front is the outside of a mountain, the reverse that of a valley
        outside = Face.FRONT if code == Assignment.M else Face.REVERSE
        inside = Face.REVERSE if code == Assignment.M else Face.FRONT
        wanted = {"outside": outside, "inside": inside, "through": Face.REVERSE}[GROOVE[kind]]
        assert on == {wanted}


@EVERY
@pytest.mark.parametrize("letters", ["MVMV", "MMMV", "VVV", "MVMVMV"])
def test_both_proofs_agree_with_the_plan(
    material: str, machine: str, kind: Kind, letters: str
) -> None:
    pattern = fan(letters, 10.0)
    plan = planned(pattern, material, machine, kind)
    assert prove_rule(plan, pattern) == []
    assert verify(plan, pattern, hpgl.write(plan, Fold(pattern))).findings == ()


@EVERY
def test_each_process_is_proved_on_the_stool(material: str, machine: str, kind: Kind) -> None:
    plan = make(stools.stool(), shelf.material(material), shelf.machine(machine), score=kind)
    assert prove_rule(plan, stools.stool().pattern) == []
    assert plan.material.score.kind == kind


@cache
def perforated() -> tuple[Plan, CreasePattern]:
    pattern = fan("MVMV", 10.0)
    return planned(pattern, "pp-0.5", "flatbed-wheel-knife", "perforation"), pattern


def test_a_perforation_leaves_lands_at_its_ends_and_between_its_cuts() -> None:
    plan, pattern = perforated()
    spots = placed(pattern.vertices, plan.placement)
    score = plan.material.score
    assert score.kind == "perforation"
    middle = spots[-1]
    for end in spots[pattern.edges[pattern.assignments != Assignment.B]].reshape(-1, 2):
        if np.allclose(end, middle):
            continue
        along = (end - middle) / np.hypot(*(end - middle))
        cuts = sorted(
            sorted(float((np.array(point) - middle) @ along) for point in stroke.points)
            for stroke in scores(plan, Face.REVERSE)
            if drawn_on(np.array(stroke.points), middle, along)
        )
        places = np.array([0.0, *np.ravel(cuts), float(np.hypot(*(end - middle)))])
        steps = np.diff(places)
        assert steps[[0, -1]].min() >= score.setback - 1e-9
        assert steps[1::2] == pytest.approx(score.cut, rel=0.1)
        assert steps[2:-1:2] == pytest.approx(score.gap, rel=0.1)


def drawn_on(points: np.ndarray, start: np.ndarray, along: np.ndarray) -> bool:
    off = points - start
    beside = np.abs(off[:, 0] * along[1] - off[:, 1] * along[0]).max()
    return bool(beside < 1e-6 and (off @ along > 0).all())


def changed(plan: Plan, change: object) -> Plan:
    """Replace the strokes of the scores."""

    def edit(operation: Operation) -> Operation:
        if operation.role is not Role.SCORE:
            return operation
        return operation.model_copy(update={"strokes": change(operation.strokes)})  # type: ignore[operator]

    passes = tuple(
        side.model_copy(
            update={
                "setups": tuple(
                    s.model_copy(update={"operations": tuple(edit(op) for op in s.operations)})
                    for s in side.setups
                )
            }
        )
        for side in plan.passes
    )
    return plan.model_copy(update={"passes": passes})


def without_two(strokes: tuple[Stroke, ...]) -> tuple[Stroke, ...]:
    return strokes[:4] + strokes[6:]


def with_one_twice(strokes: tuple[Stroke, ...]) -> tuple[Stroke, ...]:
    return (*strokes, strokes[3])


def with_three_in_one(strokes: tuple[Stroke, ...]) -> tuple[Stroke, ...]:
    whole = Stroke(points=(strokes[4].points[0], strokes[6].points[1]))
    return (*strokes[:4], whole, *strokes[7:])


def into_the_vertex(strokes: tuple[Stroke, ...]) -> tuple[Stroke, ...]:
    """Draw each cut on to the middle of the sheet, where it comes near it."""
    middle = np.array([250.0, 250.0])
    found = []
    for stroke in strokes:
        a, b = np.array(stroke.points)
        ends = sorted((a, b), key=lambda end: float(np.hypot(*(end - middle))))
        near = np.hypot(*(ends[0] - middle)) < 3
        points = (middle, ends[1]) if near else (a, b)
        found.append(Stroke(points=tuple((float(x), float(y)) for x, y in points)))
    return tuple(found)


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (without_two, "missing-score"),
        (with_one_twice, "scored-twice"),
        (with_three_in_one, "perforation-cut"),
        (into_the_vertex, "dash-in-corner"),
    ],
)
def test_a_wrong_row_of_cuts_is_found(change: object, code: str) -> None:
    plan, pattern = perforated()
    assert code in {finding.code for finding in prove_rule(changed(plan, change), pattern)}


def test_a_crease_too_short_for_one_cut_is_refused_with_its_length() -> None:
    spots = [(0, 0), (90, 0), (90, 90), (0, 90), (43, 45), (47, 45)]
    lines = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (0, 4), (3, 4), (1, 5), (2, 5)]
    short = CreasePattern.from_lines(spots, lines, "BBBBMMMVV")
    with pytest.raises(CannotPlan, match=r"4\.00 mm long; a perforation takes 4\.50 mm"):
        planned(short, "pp-0.75", "flatbed-wheel-knife", "perforation")


def test_an_outline_that_is_snapped_off_is_one_groove_without_ties() -> None:
    pattern = fan("MVMV", 10.0)
    plan = make(Fold(pattern), stools.material(), stools.machine(), cut="score-and-snap")
    assert not plan.ties
    assert not plan.holes
    [outline] = [
        stroke
        for setup in plan.passes[-1].setups
        for operation in setup.operations
        if operation.role is Role.CUT_OUTER
        for stroke in operation.strokes
    ]
    assert outline.closed
    assert plan.passes[-1].setups[-1].exposure < plan.material.thickness
    assert "no-registration-holes" in {finding.code for finding in plan.findings}
    assert verify(plan, pattern, hpgl.write(plan, Fold(pattern))).findings == ()


def test_a_slot_cannot_be_snapped_off() -> None:
    spots = [(0, 0), (90, 0), (90, 90), (0, 90), (30, 45), (60, 45)]
    lines = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (0, 4), (3, 4), (1, 5), (2, 5)]
    fold = Fold(CreasePattern.from_lines(spots, lines, "BBBBCFFFF"))
    with pytest.raises(CannotPlan, match="only an outline can be snapped off"):
        make(fold, stools.material(), stools.machine(), cut="score-and-snap")


def weak(force: float) -> Machine:
    machine = stools.machine()
    tools = machine.tools.model_copy(update={"max_force": force})
    return machine.model_copy(update={"tools": tools})


def test_a_machine_too_weak_to_cut_through_scores_the_outline_to_be_snapped() -> None:
    fold, forces = Fold(fan("MVMV", 10.0)), (500, 250, 249, 200)
    plans = [make(fold, stools.material(), weak(force)) for force in forces]
    kinds = [plan.material.cut.kind for plan in plans]
    assert kinds == ["through-cut", "through-cut", "score-and-snap", "score-and-snap"]


def test_a_machine_too_weak_to_score_is_told_what_would_work() -> None:
    with pytest.raises(CannotPlan) as caught:
        make(Fold(fan("MVMV", 10.0)), stools.material(), weak(150))
    said = str(caught.value)
    assert "half-cut: it takes 200 gf, and the machine has 150 gf" in said
    assert "crease-wheel: the machine does not offer it" in said
    assert "Take a machine that offers half-cut with 200 gf" in said


def test_a_process_that_is_asked_for_and_cannot_be_done_is_refused() -> None:
    fold = Fold(fan("MVMV", 10.0))
    with pytest.raises(CannotPlan, match=r"does not offer it.*Plan with --score half-cut"):
        make(fold, stools.material(), stools.machine(), score="crease-wheel")
    with pytest.raises(CannotPlan, match="its preset knows half-cut, crease-wheel, perforation"):
        make(fold, stools.material(), stools.machine(), score="stylus")


def test_a_laser_perforates_what_it_cannot_score() -> None:
    plan = make(Fold(fan("MVMV", 10.0)), stools.material(), shelf.machine("grbl-laser"))
    assert plan.material.score.kind == "perforation"
    assert [side.face for side in plan.passes] == [Face.REVERSE]
    assert {setup.force for setup in plan.passes[0].setups} == {0.0}
    assert "power-by-trial" in {finding.code for finding in plan.findings}


def test_a_language_that_nothing_installed_writes_is_said_to_be_so() -> None:
    machine = shelf.machine("grbl-laser").model_copy(update={"language": "semaphore"})
    plan = make(Fold(fan("MVMV", 10.0)), stools.material(), machine)
    (found,) = [finding for finding in plan.findings if finding.code == "no-programs"]
    assert "speaks semaphore" in found.message


def test_a_pen_plotter_draws_a_small_sheet_of_paper() -> None:
    pattern = fan("MVMV", 10.0)
    paper, plotter = shelf.material("paper-80-120"), shelf.machine("hp-7475a")
    plan = make(Fold(pattern), paper, plotter, blank=(297, 210))
    assert (plan.material.score.kind, plan.material.cut.kind) == ("pen", "pen")
    assert not plan.ties
    result = verify(plan, pattern, hpgl.write(plan, Fold(pattern)))
    assert result.findings == ()
    assert result.figures.tolerance == pytest.approx(25.4 / 1021)


def test_a_machine_gets_no_programs_in_another_language() -> None:
    plan = make(Fold(fan("MVMV", 10.0)), stools.material(), shelf.machine("silhouette-like"))
    with pytest.raises(CannotPlan, match="speaks gp-gl, so a program in hpgl is nothing to it"):
        hpgl.write(plan, Fold(fan("MVMV", 10.0)))


def test_a_plan_keeps_every_process_of_its_material() -> None:
    material: Material = stools.material()
    plan = make(Fold(fan("MVMV", 10.0)), material, shelf.machine("grbl-laser"))
    again = Plan.model_validate_json(plan.model_dump_json())
    assert again == plan
    assert {score.kind for score in again.material.scores} == {s.kind for s in material.scores}


def test_a_process_the_machine_does_not_offer_is_found_in_the_plan() -> None:
    plan, pattern = perforated()
    elsewhere = plan.model_copy(update={"machine": shelf.machine("hp-7475a")})
    assert "not-offered" in {finding.code for finding in prove_rule(elsewhere, pattern)}


def test_a_pen_is_pressed_no_more_lightly_than_its_machine_can() -> None:
    machine = shelf.machine("graphtec-summa-like")
    fold = Fold(fan("MVMV"))
    plan = make(fold, shelf.material("paper-80-120"), machine, score="pen", blank=(200, 200))
    scores = [s for work in plan.passes for s in work.setups if s.process == "score"]
    assert {setup.force for setup in scores} == {machine.tools.min_force}
    assert shelf.material("paper-80-120").scores[-1].force < machine.tools.min_force
    assert verify(plan, fold.pattern, hpgl.write(plan, fold)).ok
    lighter = plan.model_copy(
        update={
            "passes": tuple(
                work.model_copy(
                    update={
                        "setups": tuple(
                            s.model_copy(update={"force": 18.0}) if s.process == "score" else s
                            for s in work.setups
                        )
                    }
                )
                for work in plan.passes
            )
        }
    )
    found = verify(lighter, fold.pattern, hpgl.write(lighter, fold)).findings
    assert "set-up-values" in {finding.code for finding in found}
