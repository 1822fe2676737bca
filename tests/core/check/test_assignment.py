"""Mountain, valley and flat say what the sheet does in space."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from foldmill import CreasePattern, Fold, FoldedForm
from foldmill.check import assignment
from foldmill.finding import Severity


def hinge(letter: str, stated: float, actual: float, seam: float = 0.0) -> Fold:
    """Make two squares that meet in one crease, which folds by ``actual`` degrees."""
    flat = [[-10, 0], [0, 0], [0, 10], [-10, 10], [10, 0], [10, 10]]
    lines = [[0, 1], [1, 4], [4, 5], [5, 2], [2, 3], [3, 0], [1, 2]]
    angles = [0] * 6 + [stated]
    pattern = CreasePattern.from_lines(flat, lines, "BBBBBB" + letter, angles)
    turn = np.radians(actual)
    solid = np.column_stack([pattern.vertices, np.zeros(6)])
    # A valley brings the front faces together, so the right half rises towards the viewer.
    solid[4:, 0], solid[4:, 2] = 10 * np.cos(turn), 10 * np.sin(turn) + seam
    return Fold(pattern, FoldedForm(solid))


def codes(fold: Fold) -> dict[str, Severity]:
    return {finding.code: finding.severity for finding in assignment(fold).findings}


@pytest.mark.parametrize(
    ("letter", "angle"), [("V", 90), ("V", 180), ("M", -30), ("M", -180), ("F", 0)]
)
def test_a_crease_that_folds_as_stated_is_right(letter: str, angle: float) -> None:
    assert not codes(hinge(letter, angle, angle))


@pytest.mark.parametrize(
    ("letter", "stated", "actual"), [("V", 90, -90), ("V", 90, 89.99), ("F", 0, 5), ("M", -10, 0)]
)
def test_a_crease_that_folds_otherwise_is_an_error(
    letter: str, stated: float, actual: float
) -> None:
    fold = hinge(letter, stated, actual)
    assert codes(fold) == {"fold-angle": Severity.ERROR}
    gap = assignment(fold).figures["fold_angle_gap_deg"]
    assert gap == pytest.approx(abs(stated - actual), abs=1e-9)


def test_near_180_degrees_the_form_may_show_either_sign() -> None:
    assert not codes(hinge("V", 180, -179.99999))


def test_an_unassigned_crease_is_a_warning() -> None:
    assert codes(hinge("U", 0, 30)) == {"unassigned": Severity.WARNING}


def test_a_closed_crease_whose_sign_nobody_states_is_a_finding_of_its_own() -> None:
    fold = hinge("U", 0, 180)
    assert codes(fold) == {"closed-sign": Severity.WARNING}
    assert assignment(fold).figures["unassigned"] == 1


def test_a_seam_must_close() -> None:
    fold = hinge("V", 180, 180)
    assert fold.folded is not None
    closed = FoldedForm(fold.folded.vertices, np.array([[0, 4], [3, 5]]))
    assert not codes(replace(fold, folded=closed))
    ajar = hinge("V", 180, 180, seam=0.25)
    assert ajar.folded is not None
    report = assignment(replace(ajar, folded=FoldedForm(ajar.folded.vertices, closed.seams)))
    assert report.figures["seam_gap_mm"] == pytest.approx(0.25)
    assert "seam" in {finding.code for finding in report.findings}
