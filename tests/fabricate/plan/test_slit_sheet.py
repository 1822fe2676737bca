"""The sheet of a form with a slit: one inner cut from the centre to the outline, and no more."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from functools import cache
from io import StringIO
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import shapely
from slit_forms import PRESETS, form
from stools import machine, material, through_cut

from foldmill import Assignment, Fold
from foldmill.exchange import fold as fold_file
from foldmill.pattern import CreasePattern
from foldmill_fabricate.formats import dxf, hpgl
from foldmill_fabricate.passes import Operation, Plan, Role, Stroke
from foldmill_fabricate.pictures import pattern_svg
from foldmill_fabricate.plan import make
from foldmill_fabricate.sheet import placed
from foldmill_fabricate.verify import Verification, verify
from foldmill_fabricate.verify.rule import prove_rule
from foldmill_fabricate.verify.slit import slits

EVERY = pytest.mark.parametrize("name", PRESETS)
BOWL = "bowl-n8"


@cache
def plan_of(name: str) -> Plan:
    return make(form(name, slit=True), material(), machine())


def strokes(plan: Plan, *roles: Role) -> list[np.ndarray]:
    return [
        np.array(stroke.points)
        for side in plan.passes
        for setup in side.setups
        for operation in setup.operations
        if operation.role in roles
        for stroke in operation.strokes
    ]


def proved(plan: Plan, fold: Fold) -> Verification:
    return verify(plan, fold.pattern, hpgl.write(plan, fold))


@EVERY
def test_the_slit_is_one_stroke_from_the_outline_to_the_centre(name: str) -> None:
    fold, plan = form(name, slit=True), plan_of(name)
    (cut,) = strokes(plan, Role.CUT_INNER)
    assert fold.folded is not None
    bank = fold.pattern.vertices[fold.folded.seams[:, 0]]
    asked = placed(np.vstack([np.zeros((1, 2)), bank]), plan.placement)
    drawn = cut if np.hypot(*(cut[0] - asked[0])) < 1e-6 else cut[::-1]
    assert drawn == pytest.approx(asked, abs=1e-9)
    rim = shapely.MultiLineString(strokes(plan, Role.CUT_OUTER))
    assert rim.distance(shapely.Point(asked[-1])) < 1e-9


@EVERY
def test_the_outline_is_that_of_the_sheet_without_a_slit(name: str) -> None:
    whole = make(form(name, slit=False), material(), machine())
    one, two = (
        sum(shapely.LineString(line).length for line in strokes(plan, Role.CUT_OUTER))
        for plan in (whole, plan_of(name))
    )
    assert one == pytest.approx(two, abs=1e-6)


@EVERY
def test_no_tie_bridges_the_mouth_of_the_slit(name: str) -> None:
    plan = plan_of(name)
    (cut,) = strokes(plan, Role.CUT_INNER)
    gaps = [shapely.LineString(cut).distance(shapely.Point(tie.x, tie.y)) for tie in plan.ties]
    assert min(gaps) >= through_cut(plan.material).tie_corner


@EVERY
def test_scores_stop_short_of_the_centre_as_without_a_slit(name: str) -> None:
    plan = plan_of(name)
    centre = shapely.Point(placed([(0.0, 0.0)], plan.placement)[0])
    gaps = [shapely.LineString(line).distance(centre) for line in strokes(plan, Role.SCORE)]
    assert min(gaps) == pytest.approx(plan.material.score.setback)
    (cut,) = strokes(plan, Role.CUT_INNER)
    touching = [
        shapely.LineString(line).distance(shapely.LineString(cut))
        for line in strokes(plan, Role.SCORE)
    ]
    assert min(touching) < 1e-9, "scores run out into the slit, as into the outline"


@pytest.mark.parametrize("name", [name for name in PRESETS if name != "lampshade-n12"])
def test_both_proofs_find_nothing(name: str) -> None:
    fold = form(name, slit=True)
    read = fold_file.read(fold_file.write(fold))
    assert proved(plan_of(name), fold).findings == ()
    assert proved(make(read, material(), machine()), read).findings == ()


def test_the_lampshade_is_as_tight_in_its_centre_as_without_a_slit() -> None:
    """Its grooves are 0.004 mm too near each other there; the slit takes two of them away."""
    name = "lampshade-n12"
    counts = [
        Counter(finding.code for finding in make(fold, material(), machine()).findings)
        for fold in (form(name, slit=False), form(name, slit=True))
    ]
    assert counts[0]["vertex-rule"] - counts[1]["vertex-rule"] == 2
    assert set(counts[0]) == set(counts[1])


def edited(role: Role, change: Callable[[Operation], Operation | None]) -> Plan:
    plan = plan_of(BOWL)
    passes = []
    for side in plan.passes:
        setups = []
        for setup in side.setups:
            every = [change(op) if op.role is role else op for op in setup.operations]
            operations = tuple(op for op in every if op is not None)
            setups.append(setup.model_copy(update={"operations": operations}))
        passes.append(side.model_copy(update={"setups": tuple(setups)}))
    return plan.model_copy(update={"passes": tuple(passes)})


def with_strokes(operation: Operation, *lines: Stroke) -> Operation:
    return operation.model_copy(update={"strokes": lines})


def a_slit_is_forgotten() -> Plan:
    return edited(Role.CUT_INNER, lambda operation: None)


def a_slit_is_cut_along_both_banks() -> Plan:
    return edited(Role.CUT_INNER, lambda op: with_strokes(op, op.strokes[0], op.strokes[0]))


def a_slit_ends_before_the_outline() -> Plan:
    """It leaves out its outermost edge."""

    def shorter(op: Operation) -> Operation:
        return with_strokes(op, Stroke(points=op.strokes[0].points[1:]))

    return edited(Role.CUT_INNER, shorter)


def a_slit_runs_through_the_centre() -> Plan:
    def longer(op: Operation) -> Operation:
        points = op.strokes[0].points
        (x, y), (u, v) = points[-2:]
        beyond = (u + (u - x) / 10, v + (v - y) / 10)
        return with_strokes(op, Stroke(points=(*points, beyond)))

    return edited(Role.CUT_INNER, longer)


def a_slit_is_on_the_next_line() -> Plan:
    plan = plan_of(BOWL)
    centre = placed([(0.0, 0.0)], plan.placement)[0]

    def turned(op: Operation) -> Operation:
        step = np.array(op.strokes[0].points) - centre
        half = np.sqrt(0.5)
        spots = centre + step @ np.array([[half, half], [-half, half]])
        return with_strokes(op, Stroke(points=tuple((float(x), float(y)) for x, y in spots)))

    return edited(Role.CUT_INNER, turned)


def the_slit_is_part_of_the_outline() -> Plan:
    slit = Stroke(points=tuple(map(tuple, strokes(plan_of(BOWL), Role.CUT_INNER)[0].tolist())))
    return edited(Role.CUT_OUTER, lambda op: with_strokes(op, *op.strokes, slit))


@pytest.mark.parametrize(
    ("corrupt", "codes", "where"),
    [
        (a_slit_is_forgotten, {"missing-cut"}, "slit edge"),
        (a_slit_is_cut_along_both_banks, {"cut-twice"}, "slit edge"),
        (a_slit_ends_before_the_outline, {"missing-cut"}, "slit edge"),
        (a_slit_runs_through_the_centre, {"no-such-line"}, "cut-inner stroke 1"),
        (a_slit_is_on_the_next_line, {"missing-cut", "no-such-line"}, ""),
        (the_slit_is_part_of_the_outline, {"no-such-line"}, "cut-outer stroke"),
    ],
)
def test_a_wrong_slit_is_found_by_name(
    corrupt: Callable[[], Plan], codes: set[str], where: str
) -> None:
    plan, fold = corrupt(), form(BOWL, slit=True)
    found = prove_rule(plan, fold.pattern)
    assert {finding.code for finding in found} == codes
    assert all(where in finding.where for finding in found)
    assert not proved(plan, fold).ok


def test_a_plan_of_the_sheet_without_a_slit_lacks_it() -> None:
    whole = form(BOWL, slit=False)
    plan = make(whole, material(), machine())
    codes = {finding.code for finding in prove_rule(plan, form(BOWL, slit=True).pattern)}
    assert {"missing-cut", "not-to-score"} <= codes


def test_a_tie_over_the_mouth_is_said_to_be_near_a_corner() -> None:
    """Between the banks nothing holds the corner but the tie itself."""
    plan, fold = plan_of("star-n6"), form("star-n6", slit=True)
    (cut,) = strokes(plan, Role.CUT_INNER)
    mouth = max(cut, key=lambda spot: shapely.Point(spot).distance(shapely.Point(250, 250)))
    near = plan.ties[0].model_copy(update={"x": float(mouth[0]), "y": float(mouth[1])})
    moved = plan.model_copy(update={"ties": (near, *plan.ties[1:])})
    assert "tie-corner" in {finding.code for finding in prove_rule(moved, fold.pattern)}


@EVERY
def test_the_second_proof_finds_the_same_slit_by_itself(name: str) -> None:
    fold = form(name, slit=True)
    assert fold.folded is not None
    found = slits(fold.pattern)
    count = len(fold.folded.seams)
    assert (found.first.sum(), found.second.sum()) == (count, count)
    changed = np.flatnonzero(found.node != np.arange(len(found.node)))
    assert sorted(changed) == sorted(fold.folded.seams.max(axis=1))
    assert not slits(form(name, slit=False).pattern).first.any()


@EVERY
def test_ezdxf_finds_no_fault_in_the_drawings(name: str) -> None:
    fold, plan = form(name, slit=True), plan_of(name)
    for content in dxf.write(plan, fold).values():
        document = ezdxf.read(StringIO(content.decode()))  # type: ignore[attr-defined]
        assert not document.audit().errors


@EVERY
def test_a_plain_reader_of_the_file_sees_one_disc_with_one_border(name: str) -> None:
    """Reads the JSON by itself: walks the border, counts, and merges what lies at one place."""
    data = json.loads(fold_file.write(form(name, slit=True)))
    faces, letters = data["faces_vertices"], data["edges_assignment"]
    sides = {(f[k - 1], f[k]) for f in faces for k in range(3)}
    after = {a: b for a, b in sides if (b, a) not in sides}
    assert len(after) == letters.count("B")
    start = here = next(iter(after))
    length = 0
    while length == 0 or here != start:
        here, length = after[here], length + 1
    assert length == len(after), "the border is one loop that meets every vertex once"
    spots = [tuple(round(x, 6) + 0.0 for x in spot) for spot in data["vertices_coords"]]
    assert len(spots) - len(data["edges_vertices"]) + len(faces) == 1
    merged = {tuple(sorted((spots[a], spots[b]))) for a, b in data["edges_vertices"]}
    assert len(set(spots)) - len(merged) + len(faces) == 1
    (solid,) = data["file_frames"]
    assert len(solid["foldmill:seams"]) == len(spots) - len(set(spots))


def test_a_simulator_is_given_the_slit_as_one_cut() -> None:
    fold = form(BOWL, slit=True)
    text = pattern_svg(fold).decode()
    assert fold.folded is not None
    assert text.count("#00ff00") == len(fold.folded.seams)
    assert text.count("#000000") == 2 * 8


def test_a_cut_that_a_file_draws_as_a_cut_ends_like_a_slit() -> None:
    """C edges keep their way: scores at the inner end of the cut stop short of it."""
    spots = [(0, 0), (120, 0), (120, 120), (0, 120), (60, 60), (60, 0)]
    rim = [(0, 5), (5, 1), (1, 2), (2, 3), (3, 0)]
    edges = [*rim, (5, 4), (4, 2), (4, 3)]
    pattern = CreasePattern.from_lines(spots, edges, "BBBBBCMV", [0] * 6 + [-90, 90])
    assert pattern.count(Assignment.C) == 1
    plan = make(Fold(pattern), material(), machine())
    assert verify(plan, pattern, hpgl.write(plan, Fold(pattern))).findings == ()
    tip = shapely.Point(placed([(60.0, 60.0)], plan.placement)[0])
    gaps = [shapely.LineString(line).distance(tip) for line in strokes(plan, Role.SCORE)]
    assert gaps == pytest.approx([plan.material.score.setback] * 2)


def test_the_job_folder_of_a_slit_form_verifies(tmp_path: Path) -> None:
    from foldmill_fabricate import folder
    from foldmill_fabricate.verify import verify_folder

    fold = form("crown-n6", slit=True)
    folder.write(fold, plan_of("crown-n6"), tmp_path / "job", ["svg", "dxf", "hpgl"])
    assert verify_folder(tmp_path / "job").findings == ()
