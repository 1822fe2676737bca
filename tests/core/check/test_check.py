"""The stool meets the numbers it is known for, and what cannot be checked is never called right."""

from __future__ import annotations

from dataclasses import replace

import pytest

from foldmill import CreasePattern, Fold
from foldmill.check import NOT_CHECKED, check
from foldmill.finding import Finding, Severity
from foldmill_plugins.tuck import DESIGN


@pytest.fixture(scope="module")
def stool() -> Fold:
    return DESIGN.run(DESIGN.preset("stool-n8"))


def test_the_stool_is_a_sheet_that_folds_without_stretching_or_passing_through_itself(
    stool: Fold,
) -> None:
    report = check(stool)
    figures = report.figures
    assert not report.findings
    assert (figures["vertices"], figures["edges"], figures["faces"]) == (65, 176, 112)
    assert (figures["mountains"], figures["valleys"], figures["flats"]) == (80, 56, 24)
    assert float(figures["angle_sum_rad"]) < 1e-11
    assert float(figures["folded_angle_sum_rad"]) < 1e-11
    assert float(figures["isometry"]) < 1e-12
    assert float(figures["fold_angle_gap_deg"]) < 1e-9
    assert figures["penetrations"] == 0


def test_a_pattern_alone_is_told_what_was_not_checked(stool: Fold) -> None:
    report = check(Fold(stool.pattern))
    said = [finding for finding in report.findings if finding.code == "not-checked"]
    assert len(said) == 4
    assert {finding.severity for finding in report.findings} == {Severity.INFO}
    for figure in ("folded_angle_sum_rad", "isometry", "fold_angle_gap_deg", "penetrations"):
        assert report.figures[figure] == NOT_CHECKED
    assert float(report.figures["angle_sum_rad"]) < 1e-11


def test_nothing_at_all_is_no_sheet_and_breaks_no_check() -> None:
    empty = CreasePattern([], [], [], [], [])  # type: ignore[arg-type]
    assert check(Fold(empty)).findings[0].code == "outline"


def test_what_only_the_family_can_find_is_told_with_all_else(stool: Fold) -> None:
    own = Finding("crease-sign", Severity.ERROR, "edge 3", "It folds the other way.")
    report = check(replace(stool, findings=(own,)))
    assert report.findings == (own,)
    assert report.has_errors
