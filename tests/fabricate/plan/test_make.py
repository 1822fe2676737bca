"""The plan of a sheet: faces, order of work, register."""

from __future__ import annotations

import re

import numpy as np
import pytest
from stools import ONE_TOOL, PENS, machine, material, stool, stool_plan, through_cut

from foldmill import Assignment, CreasePattern, Fold
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.passes import Face, Gate, Plan, Role
from foldmill_fabricate.plan import make
from foldmill_fabricate.plan.short import refuse_swallowed
from foldmill_fabricate.sheet import flipped, placed


def square(creases: str, side: float = 100.0) -> Fold:
    """A square with a cross of four creases from its middle, B elsewhere."""
    h = side / 2
    vertices = [[0, 0], [h, 0], [side, 0], [side, h], [side, side], [h, side], [0, side], [0, h]]
    rim = [[k, (k + 1) % 8] for k in range(8)]
    spokes = [[8, 1], [8, 3], [8, 5], [8, 7]]
    points = np.array([*vertices, [h, h]])
    return Fold(CreasePattern.from_lines(points, rim + spokes, "B" * 8 + creases))


def score_strokes(plan: Plan, face: Face) -> list[np.ndarray]:
    return [
        np.array(stroke.points)
        for work in plan.passes
        if work.face is face
        for setup in work.setups
        for operation in setup.operations
        if operation.role is Role.SCORE
        for stroke in operation.strokes
    ]


def covered(plan: Plan, face: Face, a: np.ndarray, b: np.ndarray) -> bool:
    """Whether the middle of the crease a-b lies on a score of that face, along it."""
    middle, along = (a + b) / 2, (b - a) / np.linalg.norm(b - a)
    for line in score_strokes(plan, face):
        step = line[1] - line[0]
        t = (middle - line[0]) @ step / (step @ step)
        foot = line[0] + t * step
        parallel = abs(along @ step) / np.linalg.norm(step) > 1 - 1e-9
        if parallel and 0 <= t <= 1 and np.linalg.norm(foot - middle) < 1e-6:
            return True
    return False


def test_mountains_are_scored_on_the_front_and_valleys_on_the_reverse_and_flats_nowhere() -> None:
    plan, pattern = stool_plan(), stool().pattern
    spots = placed(pattern.vertices, plan.placement)
    for (a, b), code in zip(pattern.edges, pattern.assignments, strict=True):
        front = covered(plan, Face.FRONT, spots[a], spots[b])
        reverse = covered(plan, Face.REVERSE, spots[a], spots[b])
        assert front == (code == Assignment.M)
        assert reverse == (code == Assignment.V)


def test_the_stool_fits_its_blank_only_when_turned() -> None:
    plan, points = stool_plan(), stool().pattern.vertices
    assert np.ptp(points, axis=0).max() > 500
    assert np.ptp(placed(points, plan.placement), axis=0).max() <= 490.1
    assert plan.placement.angle == pytest.approx(22.5)


def test_a_part_with_room_to_spare_is_not_turned() -> None:
    assert make(square("MVMV"), material(), machine()).placement.angle == 0


def test_a_blank_that_is_too_small_is_refused_with_the_missing_millimetres() -> None:
    with pytest.raises(DoesNotFit, match=r"12\.0 mm are missing.*492\.1 × 492\.1 mm"):
        make(stool(), material(), machine(), blank=(480, 480))


def test_a_blank_wider_than_the_machine_is_refused() -> None:
    with pytest.raises(DoesNotFit, match="20 mm too much"):
        make(stool(), material(), machine(), blank=(600, 500))


def test_work_goes_holes_scores_flip_scores_outline_with_the_fewest_tool_changes() -> None:
    setups = [setup for work in stool_plan().passes for setup in work.setups]
    assert [setup.name for setup in setups] == [
        "front-holes",
        "front-score",
        "reverse-score",
        "reverse-cut",
    ]
    assert [setup.gates for setup in setups] == [
        (Gate.LOAD, Gate.TOOL),
        (Gate.TOOL,),
        (Gate.FLIP,),
        (Gate.TOOL,),
    ]
    assert setups[-1].operations[-1].role is Role.CUT_OUTER


def test_a_machine_that_selects_its_tools_needs_hands_only_to_load_and_flip() -> None:
    setups = [setup for work in stool_plan(PENS).passes for setup in work.setups]
    assert [setup.gates for setup in setups] == [(Gate.LOAD,), (), (Gate.FLIP,), ()]
    assert [setup.tool for setup in setups] == [4, 2, 2, 4]


@pytest.mark.parametrize("kind", ["left-right", "end-over-end"])
def test_holes_map_onto_holes_only_under_the_chosen_flip(kind: str) -> None:
    plan = make(stool(), material(), machine(), flip=kind)  # type: ignore[arg-type]
    holes = {(round(h.x, 6), round(h.y, 6)) for h in plan.holes}
    assert len(holes) == 4
    wrong = "end-over-end" if kind == "left-right" else "left-right"
    turned = {tuple(np.round(p, 6)) for p in flipped(sorted(holes), plan.flip)}
    astray = {
        tuple(np.round(p, 6))
        for p in flipped(sorted(holes), plan.flip.model_copy(update={"kind": wrong}))
    }
    assert turned == holes
    assert not astray & holes


def test_holes_keep_clear_of_part_and_edge() -> None:
    import shapely

    plan = stool_plan()
    spots = placed(stool().pattern.vertices, plan.placement)
    part = shapely.Polygon(spots[stool().pattern.outline()[0]])
    for hole in plan.holes:
        rim = shapely.Point(hole.x, hole.y).buffer(hole.diameter / 2)
        assert part.distance(rim) >= 12 - 1e-3
        x0, y0, x1, y1 = rim.bounds
        assert min(x0, y0, 500 - x1, 500 - y1) >= 8 - 1e-3


def test_a_part_that_fills_its_blank_gets_an_edge_stop_instead_of_holes() -> None:
    plan = make(square("MVMV", 490), material(), machine())
    assert plan.holes == ()
    finding = next(f for f in plan.findings if f.code == "no-registration-holes")
    assert "short" in finding.message
    assert "edge stop" in finding.remedy


def test_the_witness_mark_is_not_its_own_mirror_image() -> None:
    plan = stool_plan()
    marks = [
        point
        for setup in plan.passes[0].setups
        for operation in setup.operations
        if operation.role is Role.WITNESS
        for stroke in operation.strokes
        for point in stroke.points
    ]
    assert len(marks) == 6
    there = {tuple(np.round(p, 6)) for p in marks}
    assert {tuple(np.round(p, 6)) for p in flipped(marks, plan.flip)} != there


def test_scores_stop_short_of_vertices_but_run_out_to_the_outline() -> None:
    plan = make(square("MVMV"), material(), machine())
    spots = placed(square("MVMV").pattern.vertices, plan.placement)
    ends = np.vstack(score_strokes(plan, Face.FRONT) + score_strokes(plan, Face.REVERSE))
    rim, middle = spots[[1, 3, 5, 7]], spots[8]
    for spot in rim:
        assert np.isclose(ends, spot, atol=1e-9).all(axis=1).any()
    assert np.linalg.norm(ends - middle, axis=1).min() == pytest.approx(0.75)


def test_two_scores_in_one_line_run_through_their_vertex_as_one_stroke() -> None:
    plan = make(square("MFMF"), material(), machine())
    [line] = score_strokes(plan, Face.FRONT)
    assert np.linalg.norm(line[1] - line[0]) == pytest.approx(100)


def test_a_mountain_that_goes_on_as_a_valley_stops_short_between() -> None:
    plan = make(square("MFVF"), material(), machine())
    [front], [reverse] = score_strokes(plan, Face.FRONT), score_strokes(plan, Face.REVERSE)
    gap = min(np.linalg.norm(a - b) for a in front for b in reverse)
    assert gap == pytest.approx(1.5)
    assert "vertex-rule" not in {finding.code for finding in plan.findings}


def test_a_job_with_scores_on_one_face_is_one_pass_without_register() -> None:
    plan = make(square("MFMF"), material(), machine())
    [work] = plan.passes
    assert work.face is Face.FRONT
    assert [setup.name for setup in work.setups] == ["front-score", "front-cut"]
    assert plan.holes == ()


def test_unassigned_creases_are_refused_with_their_count_unless_told_where() -> None:
    with pytest.raises(CannotPlan, match=r"2 creases are neither.*--unassigned"):
        make(square("MUMU"), material(), machine())
    plan = make(square("MUMU"), material(), machine(), unassigned="reverse")
    assert len(score_strokes(plan, Face.REVERSE)) == 2
    skipped = make(square("FUFU"), material(), machine(), unassigned="skip")
    assert not score_strokes(skipped, Face.FRONT)


def test_a_stylus_creases_the_inside_of_the_fold() -> None:
    score = material().score.model_copy(update={"score_face": "inside"})
    plan = make(square("MFMF"), material().model_copy(update={"score": score}), machine())
    assert plan.passes[0].face is Face.REVERSE


def test_ties_hold_the_part_on_straight_edges_away_from_corners() -> None:
    plan = stool_plan()
    spots = placed(stool().pattern.vertices, plan.placement)
    corners = spots[stool().pattern.outline()[0]]
    assert len(plan.ties) >= 3
    for tie in plan.ties:
        away = np.linalg.norm(corners - (tie.x, tie.y), axis=1)
        assert away.min() >= through_cut(material()).tie_corner + tie.width / 2 - 1e-9
    outer = plan.passes[-1].setups[-1].operations[-1].strokes
    drawn = sum(np.hypot(*np.diff(s.points, axis=0).T).sum() for s in outer)
    rim = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T).sum()
    assert drawn == pytest.approx(rim - sum(tie.width for tie in plan.ties))


def test_a_straight_edge_in_many_pieces_still_carries_ties() -> None:
    x = np.linspace(0, 60, 13)
    points = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 60])])
    rims = [[k + j, k + j + 1] for j in (0, 13) for k in range(12)]
    edges = [*rims, [0, 13], [12, 25]]
    plan = make(Fold(CreasePattern.from_lines(points, edges, "B" * 26)), material(), machine())
    assert len(plan.ties) >= 3
    assert len(plan.passes[0].setups) == 1


def test_an_inner_cut_comes_before_the_outline() -> None:
    slit = [[0, 0], [90, 0], [90, 90], [0, 90], [30, 45], [60, 45]]
    edges = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [0, 4], [3, 4], [1, 5], [2, 5]]
    fold = Fold(CreasePattern.from_lines(slit, edges, "BBBBCFFFF"))
    roles = [op.role for op in make(fold, material(), machine()).passes[-1].setups[-1].operations]
    assert roles == [Role.CUT_INNER, Role.CUT_OUTER]


def test_the_same_fold_gives_the_same_plan() -> None:
    again = make(stool(), material(), machine())
    assert again.model_dump_json() == stool_plan().model_dump_json()


def test_a_plan_survives_its_file() -> None:
    plan = stool_plan(ONE_TOOL)
    assert Plan.model_validate_json(plan.model_dump_json()) == plan


def test_a_weak_machine_is_told_that_it_may_not_cut_through() -> None:
    codes = {finding.code for finding in stool_plan(ONE_TOOL).findings}
    assert "through-cut-marginal" in codes
    assert "through-cut-marginal" not in {finding.code for finding in stool_plan(PENS).findings}


def test_creases_that_their_setbacks_swallow_are_refused_with_their_number_and_the_worst() -> None:
    small = square("MVMV", 1.0)
    spots = small.pattern.vertices
    stops = {8: 0.75, 1: 0.75}
    faces = {Face.FRONT: np.arange(8, 12)}
    with pytest.raises(CannotPlan, match="4 of 4 creases") as refused:
        refuse_swallowed(small.pattern, spots, faces, stops, material(), machine())
    said = str(refused.value)
    assert "nothing is left to score" in said
    assert "at least 4 mm long rather than 1.0 mm" in said  # (0.75 + 0.75) / 0.5 = 3, and a bit


def test_a_part_of_the_size_that_the_refusal_names_is_planned_and_a_smaller_one_is_not() -> None:
    with pytest.raises(CannotPlan) as refused:
        make(square("MVMV", 1.0), material(), machine())
    size = int(re.search(r"at least (\d+) mm", str(refused.value))[1])  # type: ignore[index]
    setback = material().score.setback
    assert size == np.ceil(2 * (setback + 0.01))
    plan = make(square("MVMV", size), material(), machine(), cut="score-and-snap")
    assert [f.code for f in plan.findings].count("short-crease") == 1
    with pytest.raises(CannotPlan, match="nothing is left"):
        make(square("MVMV", 2 * setback), material(), machine(), cut="score-and-snap")


def test_grooves_of_both_faces_that_end_too_near_at_a_vertex_are_an_error() -> None:
    vertices = [[0, 0], [100, 0], [100, 100], [0, 100], [50, 50], [100, 53]]
    edges = [[0, 1], [1, 5], [5, 2], [2, 3], [3, 0], [0, 4], [1, 4], [5, 4], [2, 4], [3, 4]]
    vertices.append([100, 58])
    edges[2:3] = [[5, 6], [6, 2]]
    edges.append([6, 4])
    fold = Fold(CreasePattern.from_lines(vertices, edges, "BBBBBB" + "MMMMM" + "V"))
    codes = {f.code: f.severity for f in make(fold, material(), machine()).findings}
    assert codes["vertex-rule"] == "error"
