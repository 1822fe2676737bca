"""What a folder is told: an order where there is one, and honestly where it comes from."""

from __future__ import annotations

from dataclasses import replace

import hand_made
import numpy as np
import pytest
import stools

from foldmill import CreasePattern, Fold, installed
from foldmill.exchange import fold as fold_file
from foldmill_fabricate.jobsheet import order
from foldmill_fabricate.jobsheet.creases import Arrangement, arrange
from foldmill_fabricate.jobsheet.moving import SHARES, closing

PLAN = hand_made.plan()
STOOL = stools.stool()
HOW = arrange(STOOL.pattern)


def made(family: str, preset: str) -> Fold:
    design = installed().design(family)
    return design.run(design.preset(preset))


LAMP = made("rotational", "lampshade-n12")


def read_back(fold: Fold) -> Fold:
    return fold_file.read(fold_file.write(fold))


def flat_folded() -> Fold:
    """Return a square that is folded in half, twice; no form is known of it."""
    flat = [(x, y) for y in (0.0, 50.0, 100.0) for x in (0.0, 50.0, 100.0)]
    rim = [(0, 1), (1, 2), (2, 5), (5, 8), (8, 7), (7, 6), (6, 3), (3, 0)]
    edges = [*rim, (4, 1), (4, 3), (4, 5), (4, 7)]
    angles = [0.0] * 8 + [-180.0, 180.0, 180.0, 180.0]
    return Fold(CreasePattern.from_lines(flat, edges, "B" * 8 + "MVVV", angles))


def test_folding_goes_from_the_middle_outward_and_closes_tucks_last() -> None:
    steps = order.folding_steps(PLAN, HOW)
    outward = next(step for step in steps if "from the middle outward" in step)
    letters = [group.letter for group in HOW.groups if not group.is_closed]
    assert [outward.index(f" {letter} ") for letter in letters] == sorted(
        outward.index(f" {letter} ") for letter in letters
    )
    assert any("L, M (front meets front)" in step for step in steps)
    assert "L, M" in next(step for step in steps if step.startswith("Close the tucks last"))
    assert "not computed" in order.derived(HOW, None, STOOL)


@pytest.mark.parametrize(
    ("face", "said"),
    [
        ("outside", "front has the grooves of the mountains"),
        ("inside", "front has the grooves of the valleys"),
        ("either", "write an F on the front"),
    ],
)
def test_a_folder_is_told_by_what_to_know_the_front(face: str, said: str) -> None:
    score = PLAN.material.score.model_copy(update={"score_face": face})
    other = PLAN.model_copy(update={"material": PLAN.material.model_copy(update={"score": score})})
    assert said in order.folding_steps(other, HOW)[0]


def test_only_a_form_with_tucks_is_told_of_tucks_and_one_with_a_seam_of_its_seam() -> None:
    bare = Arrangement("rings", HOW.name, HOW.groups[:3])
    assert not any("tucks" in step for step in order.folding_steps(PLAN, bare))
    assert not any("seam" in step for step in order.folding_steps(PLAN, HOW))
    assert any("Close the seam" in step for step in order.folding_steps(PLAN, HOW, seams=5))


@pytest.mark.parametrize("fold", [LAMP, read_back(LAMP)], ids=["made", "read from a file"])
def test_where_a_motion_leads_from_the_flat_sheet_the_order_is_computed(fold: Fold) -> None:
    moving = closing(fold)
    assert moving is not None
    assert moving.opens_flat
    how = arrange(fold.pattern)
    assert any("all creases together" in step for step in order.folding_steps(PLAN, how, 0, moving))
    assert order.derived(how, moving, fold).startswith("This is computed")
    head, *rows = order.crease_table(how, moving, fold)
    assert head[-3:] == ("at 25%", "at 50%", "at 75%")
    assert len(rows) == len(how.groups)
    for row, group in zip(rows, how.groups, strict=True):
        passed = [float(cell.rstrip("°")) for cell in row[-3:]]
        assert passed == sorted(passed)
        assert passed[-1] < group.angle


def test_angles_on_the_way_grow_from_the_flat_sheet_to_the_form() -> None:
    moving = closing(LAMP)
    assert moving is not None
    on_the_way = np.abs(moving.angles(LAMP))
    assert len(on_the_way) == len(SHARES)
    assert (np.diff(on_the_way, axis=0) > -1e-6).all()
    assert (on_the_way[-1] <= np.abs(LAMP.pattern.fold_angles) + 1e-6).all()
    names = [name for name, _ in moving.stages(LAMP)]
    assert names == ["25 % of the way", "50 % of the way", "75 % of the way"]


def test_a_motion_that_ends_elsewhere_is_no_order_of_folding() -> None:
    tube = made("six-crease", "vase")
    moving, how = closing(tube), arrange(tube.pattern)
    assert moving is not None
    assert not moving.opens_flat
    steps = order.folding_steps(PLAN, how, 3, moving)
    assert any("row by row, beginning from the lower edge" in step for step in steps)
    assert "rows of creases" in order.derived(how, moving, tube)


def test_where_no_order_is_known_the_sheet_says_so() -> None:
    fold = flat_folded()
    how = arrange(fold.pattern)
    assert closing(fold) is None
    said = order.derived(how, None, fold)
    assert "No order of folding is known" in said
    assert "folded form is not known" in said
    assert any("it ends flat" in step for step in order.folding_steps(PLAN, how))


def test_a_family_that_is_not_installed_leaves_only_its_motion_unknown() -> None:
    alone = read_back(LAMP)
    other = {**alone.meta, "design": {**alone.meta["design"], "slug": "nobodys"}}
    assert closing(replace(alone, meta=other)) is None
    bent = {**alone.meta["design"]["params"], "phi": 70}
    changed = {**alone.meta, "design": {**alone.meta["design"], "params": bent}}
    assert closing(replace(alone, meta=changed)) is None  # what it makes is another pattern
