"""Coupons of many materials on many machines: what is on them, what is not, and why."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from coupons import coupon, declared

from foldmill_fabricate import shelf
from foldmill_fabricate.coupon import lettering, words
from foldmill_fabricate.coupon.make import make
from foldmill_fabricate.errors import DoesNotFit
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.materials import Perforation
from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.sheet import flipped
from foldmill_fabricate.verify import verify

CASES: list[dict[str, Any]] = [
    {},
    {"flip": "end-over-end"},
    {"degree": 6, "blank": (500.0, 420.0)},
    {"machine": "flatbed-wheel-knife", "material": "card-250"},
    {"machine": "generic-hpgl-pens", "material": "paper-80-120", "score": "perforation"},
    {"machine": "generic-hpgl-drag-knife", "material": "paper-80-120", "blank": (260.0, 260.0)},
    {"machine": "hp-7550a", "material": "paper-80-120", "blank": (280.0, 200.0)},
]


def kinds(plan: Plan) -> list[str]:
    return [ladder.kind for ladder in declared(plan).ladders]


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=lambda case: "-".join(map(str, case.values())) or "pp")
def test_a_coupon_is_proved_like_any_job(case: dict[str, Any]) -> None:
    fold, plan = coupon(**case)
    found = verify(plan, fold.pattern, hpgl.write(plan, fold))
    assert found.ok, [str(finding) for finding in found.findings]
    assert [work.face for work in plan.passes] == [Face.FRONT, Face.REVERSE]


def test_each_rung_is_made_with_its_own_figures() -> None:
    _, plan = coupon()
    setups = plan.passes[0].setups
    rungs = {
        ladder.kind: [rung.value for rung in ladder.rungs] for ladder in declared(plan).ladders
    }
    assert {setup.exposure for setup in setups if setup.process == "score"} == set(rungs["depth"])
    scored = [s for s in setups if any(op.role is Role.SCORE for op in s.operations)]
    assert {setup.force for setup in scored} == set(rungs["force"])
    times = {op.repeats for s in scored for op in s.operations if op.role is Role.SCORE}
    assert times == set(rungs["repeats"])


def test_no_rung_is_deeper_than_the_web_allows_nor_stronger_than_the_machine() -> None:
    _, plan = coupon()
    rungs = {
        ladder.kind: [rung.value for rung in ladder.rungs] for ladder in declared(plan).ladders
    }
    assert max(rungs["depth"]) <= plan.material.thickness - plan.material.score.web_min
    assert max(rungs["force"]) <= (plan.machine.tools.max_force or 0)


@pytest.mark.parametrize(
    ("case", "missing", "sentence"),
    [
        ({"machine": "flatbed-wheel-knife", "material": "card-250"}, "depth", "no blade"),
        (CASES[4], "depth", "goes through the sheet in any case"),
        ({"machine": "generic-hpgl-pens"}, "depth", "works through a whole face"),
        (CASES[6], "force", "creased by hand"),
        (CASES[6], "relief", "makes no holes"),
        ({"blank": (300.0, 300.0)}, "relief", "has no room"),
    ],
)
def test_a_ladder_that_means_nothing_is_left_out_with_a_sentence(
    case: dict[str, Any], missing: str, sentence: str
) -> None:
    _, plan = coupon(**case)
    assert missing not in kinds(plan)
    told = [each for each in declared(plan).left_out if each.startswith(f"The {missing} ladder")]
    assert len(told) == 1
    assert sentence in told[0]


def test_words_are_left_out_where_every_line_goes_through() -> None:
    _, plan = coupon(machine="grbl-laser")
    assert not declared(plan).words
    assert any("words are left out" in sentence for sentence in declared(plan).left_out)


def test_a_blank_that_is_too_small_is_refused_with_the_smallest_that_works() -> None:
    with pytest.raises(DoesNotFit, match=r"smallest that holds its bars and verniers is 170 × 234"):
        coupon(blank=(150.0, 150.0))
    fold, plan = coupon(blank=(170.0, 234.0))
    assert declared(plan).verniers
    assert verify(plan, fold.pattern, hpgl.write(plan, fold)).ok


@pytest.mark.parametrize("flip", ["left-right", "end-over-end"])
def test_words_on_the_reverse_are_set_anew_and_read_right_when_the_sheet_is_turned(
    flip: Any,
) -> None:
    """Seen from the reverse, the strokes of its heading are those of the alphabet, not mirrored."""
    _, plan = coupon(flip=flip)
    heading = next(words for words in declared(plan).words if words.text.startswith("REVERSE"))
    corner = flipped([heading.at], plan.flip)[0]
    wanted = {_key(stroke + corner) for stroke in lettering.strokes(heading.text, heading.height)}
    seen = {
        _key(flipped(stroke.points, plan.flip))
        for setup in plan.passes[1].setups
        for operation in setup.operations
        if operation.role is Role.LABEL
        for stroke in operation.strokes
    }
    assert wanted <= seen


def _key(points: np.ndarray) -> frozenset[tuple[float, float]]:
    return frozenset((round(float(x), 3), round(float(y), 3)) for x, y in points)


def _way(points: np.ndarray) -> tuple[float, ...]:
    return min(tuple(points.ravel().tolist()), tuple(points[::-1].ravel().tolist()))


def test_no_two_signs_of_the_alphabet_look_alike() -> None:
    signs = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-+.,:/°="
    shapes = [frozenset(map(_way, lettering.strokes(sign, 6.0))) for sign in signs]
    assert all(shapes)
    assert len(set(shapes)) == len(signs)


def test_a_word_is_as_high_and_as_long_as_it_is_said_to_be() -> None:
    points = np.vstack(lettering.strokes("E0.45 mm", 3.0))
    assert np.ptp(points[:, 1]) == pytest.approx(3.0)
    assert np.ptp(points[:, 0]) < lettering.width("E0.45 mm", 3.0)


@pytest.mark.parametrize("case", [CASES[4], {"machine": "grbl-laser", "material": "pet-0.25"}])
def test_a_perforation_is_tried_with_lands_of_several_lengths(case: dict[str, Any]) -> None:
    """On every strip the middle lands are as long as its figure says, within a stretched cut."""
    _, plan = coupon(**case)
    [ladder] = [each for each in declared(plan).ladders if each.kind == "gap"]
    score = plan.material.score
    assert isinstance(score, Perforation)
    assert score.gap in [rung.value for rung in ladder.rungs]
    assert len(ladder.rungs) >= 4
    cuts = np.array(
        [
            stroke.points
            for work in plan.passes
            for setup in work.setups
            for operation in setup.operations
            if operation.role is Role.SCORE
            for stroke in operation.strokes
        ]
    )
    shares = []
    for rung in ladder.rungs:
        (x, y), wide = rung.at, declared(plan).strip_width
        middles = cuts.mean(axis=1)
        inside = (abs(middles[:, 0] - x - wide / 2) < wide / 2) & (abs(middles[:, 1] - y - 7) < 7)
        row = np.sort(cuts[inside][:, :, 0], axis=1)
        row = row[np.argsort(row[:, 0])]
        lands, lengths = row[1:, 0] - row[:-1, 1], row[:, 1] - row[:, 0]
        assert row[0, 0] >= x + score.setback - 1e-6
        assert row[-1, 1] <= x + wide - score.setback + 1e-6
        assert lands == pytest.approx(rung.value, rel=0.35)
        shares.append(lands.mean() / lengths.mean())
    assert shares == pytest.approx([rung.value / score.cut for rung in ladder.rungs], rel=1e-3)


def test_only_perforations_have_lands_to_try() -> None:
    _, plan = coupon()
    assert "gap" not in kinds(plan)
    assert not any("gap" in sentence for sentence in declared(plan).left_out)


@pytest.mark.parametrize("case", CASES[:5])
def test_every_line_on_how_to_read_stands_by_itself(case: dict[str, Any]) -> None:
    """No line leans on a ladder that may not be on the sheet."""
    _, plan = coupon(**case)
    told = dict(words.lines(plan, declared(plan)))
    ladders = [text for name, text in told.items() if not name.startswith(("Vernier", "Bars"))]
    assert not [text for text in ladders if "the same" in text or "as before" in text]
    assert all("{" not in text for text in told.values())


def test_a_machine_that_works_from_drawings_tries_no_figures_of_its_own() -> None:
    own = shelf.machine("silhouette-like").model_copy(update={"language": "dmpl"})
    _, plan = make(shelf.material("card-250"), own)
    assert not {"depth", "force", "repeats"} & {*kinds(plan)}
    assert sum("works from drawings" in each for each in declared(plan).left_out) == 3


def test_machines_of_every_language_try_what_their_programs_can_set() -> None:
    for machine in ("silhouette-like", "generic-hpgl-600"):
        _, plan = make(shelf.material("card-250"), shelf.machine(machine))
        assert {"force", "repeats"} <= {*kinds(plan)}
