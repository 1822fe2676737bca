"""The pages a stranger folds from, for each kind of pattern."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import hand_made
import numpy as np
import poppler
import pytest
import stools

from foldmill import Assignment, Fold, installed
from foldmill.finding import Finding, Severity
from foldmill_fabricate import jobsheet
from foldmill_fabricate.jobsheet import part
from foldmill_fabricate.jobsheet.creases import arrange
from foldmill_fabricate.jobsheet.write import pages
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures.pattern import PRINTED

if TYPE_CHECKING:
    from conftest import Golden

PLAN = hand_made.plan()


def made(family: str, preset: str) -> Fold:
    design = installed().design(family)
    return design.run(design.preset(preset))


SHEETS = {
    "stool": stools.stool(),
    "lampshade": made("rotational", "lampshade-n12"),
    "tube": made("six-crease", "vase"),
    "no form": Fold(hand_made.fold().pattern),
}


@cache
def written(name: str) -> bytes:
    plan: Plan = stools.stool_plan() if name == "stool" else PLAN
    return jobsheet.write(plan, SHEETS[name])


@pytest.mark.long
@pytest.mark.parametrize("name", SHEETS)
def test_every_kind_of_crease_is_on_paper_with_its_angle(name: str, tmp_path: Path) -> None:
    fold = SHEETS[name]
    page = poppler.pages(written(name), tmp_path)[2].replace("×", "× ").replace("  ", " ")
    for group in arrange(fold.pattern).groups:
        kind = "mountain" if group.assignment == Assignment.M else "valley"
        assert f"{group.letter} {kind} {group.angle:.1f}° × {len(group.edges)}" in page


@pytest.mark.parametrize("name", ["hand-made", "stool-n8"])
def test_the_words_of_the_job_sheet_are_as_they_were(name: str, golden: Golden) -> None:
    stool = name == "stool-n8"
    plan = stools.stool_plan() if stool else PLAN
    fold = SHEETS["stool"] if stool else hand_made.fold()
    written_pages = list(pages(plan, fold))[2 if stool else 0 :]  # what is cut is others' affair
    rows = [
        f"{text.get_text()}\n"
        for page in written_pages
        for axes in page.figure.axes
        for text in (*axes.texts, axes.title)
        if text.get_text()
    ]
    golden.check(f"{name}/job-sheet.txt", "".join(rows).encode())


@pytest.mark.parametrize(
    ("name", "phrases"),
    [
        ("stool", ("220.1 × 220.1 × 150.0 mm", "from behind, below", "not computed and not tried")),
        ("lampshade", ("50 % of the way", "This is computed")),
        ("tube", ("folding rate FR 33 %", "Close the seam")),
        ("no form", ("The folded form is not known", "No order of folding is known")),
    ],
)
def test_the_form_and_the_order_of_folding_are_told(
    name: str, phrases: tuple[str, ...], tmp_path: Path
) -> None:
    page = poppler.pages(written(name), tmp_path)[3]
    for phrase in phrases:
        assert phrase in page


def test_untested_is_stamped_on_every_page_until_it_is_tested(tmp_path: Path) -> None:
    assert all("untested" in page for page in poppler.pages(written("no form"), tmp_path))
    tested = PLAN.material.model_copy(update={"tested": True})
    proven = PLAN.machine.model_copy(update={"verified": True})
    sure = PLAN.model_copy(update={"material": tested, "machine": proven})
    others = poppler.pages(jobsheet.write(sure, SHEETS["no form"]), tmp_path)[1:]
    assert not any("untested" in page for page in others)


def test_mountains_and_valleys_differ_in_black_and_white() -> None:
    assert PRINTED[Assignment.M].style == "-"
    assert PRINTED[Assignment.V].style != "-"


@pytest.mark.parametrize(("name", "order"), [("stool", 8), ("lampshade", 12), ("tube", 10)])
def test_the_enlarged_part_shows_every_kind_of_crease(name: str, order: int) -> None:
    fold = SHEETS[name]
    how = arrange(fold.pattern)
    shown = part.part(fold, how)
    assert shown.title.startswith(f"One of {order} equal parts")
    assert len(shown.edges) < 3 * len(fold.pattern.edges) / order
    for group in how.groups:
        assert np.intersect1d(group.edges, shown.edges).size


def test_the_enlarged_part_is_turned_and_not_mirrored() -> None:
    fold = SHEETS["stool"]
    shown, corners = part.part(fold, arrange(fold.pattern)), fold.pattern.vertices
    for flat in (shown.vertices, corners):
        one, two, three = (flat[fold.pattern.faces[:, k]] for k in range(3))
        (a, b), (c, d) = (two - one).T, (three - one).T
        assert (a * d - b * c > 0).all()
    lengths = [
        np.linalg.norm(np.diff(flat[fold.pattern.edges], axis=1), axis=2)
        for flat in (shown.vertices, corners)
    ]
    assert np.allclose(*lengths)


def test_a_crowded_pattern_shows_only_what_can_be_told_apart() -> None:
    fold = made("waterbomb", "vase")
    shown = part.part(fold, arrange(fold.pattern))
    assert len(shown.edges) <= part.MOST


def test_findings_that_do_not_fit_are_counted(tmp_path: Path) -> None:
    many = tuple(
        Finding(f"code-{k}", Severity.WARNING, f"crease {k}", "It is short. " * 12, "Fold it.")
        for k in range(40)
    )
    crowded = PLAN.model_copy(update={"findings": many})
    page = poppler.pages(jobsheet.write(crowded, SHEETS["no form"]), tmp_path)[1]
    told = page.count("It is short. It is short. It is short. It is short. It is short. It")
    assert 0 < told < 40
    assert "more in plan.json" in page
