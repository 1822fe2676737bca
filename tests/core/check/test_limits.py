"""A good fold stays good when somebody writes it with few decimals, and a bad one stays bad."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest

from foldmill import Design, Fold, FoldedForm
from foldmill.check import check
from foldmill.exchange.fold import read, write
from foldmill_plugins import rotational, tuck

DESIGNS: tuple[Design[Any], ...] = (rotational.DESIGN, tuck.DESIGN)
GOOD = {
    f"{design.slug} {name}": design.run(design.preset(name))
    for design in DESIGNS
    for name in design.presets
}


def rounded(fold: Fold, decimals: int) -> Fold:
    """Return a fold as it comes out of a file whose numbers have so many decimals."""

    def numbers(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: numbers(each) for key, each in value.items()}
        if isinstance(value, list):
            return [numbers(each) for each in value]
        return round(value, decimals) if isinstance(value, float) else value

    return read(json.dumps(numbers(json.loads(write(fold)))))


@pytest.mark.parametrize("decimals", [6, 4])
@pytest.mark.parametrize("name", GOOD)
def test_a_good_fold_written_with_few_decimals_is_still_good(name: str, decimals: int) -> None:
    report = check(rounded(GOOD[name], decimals))
    assert not report.findings
    assert report.figures["isometry_limit"] == 1e-6
    assert report.figures["folded_angle_sum_limit_rad"] == 1e-5


@pytest.mark.parametrize("name", GOOD)
def test_what_a_design_makes_is_held_to_what_arithmetic_can_do(name: str) -> None:
    report = check(GOOD[name])
    assert report.figures["isometry_limit"] == 1e-12
    assert report.figures["angle_sum_limit_rad"] == 1e-11
    assert not report.findings


def test_what_a_design_adds_to_its_file_does_not_make_it_a_file() -> None:
    fold = GOOD["tuck stool-n8"]
    noted = replace(fold, meta={**fold.meta, "fold": {"frame": {"acme:note": 1}}})
    assert check(noted).figures["isometry_limit"] == 1e-12


def test_a_tenth_of_a_millimetre_is_wrong_in_a_file_as_well() -> None:
    fold = rounded(GOOD["tuck stool-n8"], 6)
    assert fold.folded is not None
    moved = fold.folded.vertices.copy()
    moved[3] += [0, 0, 0.1]
    report = check(replace(fold, folded=FoldedForm(moved, fold.folded.seams)))
    codes = {finding.code for finding in report.findings}
    assert {"folded-angle-sum", "isometry", "fold-angle"} <= codes
