"""Fold angles follow the FOLD convention: seen from the front, valleys are positive."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import Assignment, Fold, FoldedForm, InvalidPattern, planar
from foldmill.folded import assign, fold_angles, fold_pattern

EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])
AROUND = planar.edge_faces(EDGES, FACES)
FLAT = np.array([[0, 0], [1, -1], [2, 0], [1, 1.0]])


def hinge(degrees: float) -> np.ndarray:
    """Fold the upper half of a square about the x axis; positive lifts it towards the viewer."""
    tilt = np.radians(degrees)
    return np.array([[0, 0, 0], [1, -1, 0], [2, 0, 0], [1, np.cos(tilt), np.sin(tilt)]])


@pytest.mark.parametrize("degrees", [-179.0, -90.0, -1e-3, 0.0, 30.0, 90.0, 179.9])
def test_paper_that_comes_towards_the_viewer_folds_by_a_positive_angle(degrees: float) -> None:
    angles = fold_angles(hinge(degrees), EDGES, FACES, AROUND)
    assert angles[:4].tolist() == [0, 0, 0, 0]
    assert angles[4] == pytest.approx(degrees, abs=1e-10)


def test_the_angle_does_not_depend_on_the_direction_of_the_edge() -> None:
    backwards = EDGES[:, ::-1]
    angles = fold_angles(hinge(50), backwards, FACES, planar.edge_faces(backwards, FACES))
    assert angles[4] == pytest.approx(50)


@pytest.mark.parametrize(
    ("degrees", "letter"), [(90, "V"), (-90, "M"), (0, "F"), (5e-5, "F"), (2e-4, "V"), (-2e-4, "M")]
)
def test_the_assignment_follows_the_angle(degrees: float, letter: str) -> None:
    sheet, form = fold_pattern(FLAT, hinge(degrees), EDGES, FACES, np.zeros(5))
    assert sheet.letters() == "BBBB" + letter
    assert (sheet.fold_angles[4] == 0) == (letter == "F")
    assert form.size == 2


@pytest.mark.parametrize(("stated", "letter"), [(1, "V"), (-1, "M"), (0, "U")])
@pytest.mark.parametrize("noise", [180.0, -180.0, 179.99999, -179.99999])
def test_of_a_crease_folded_shut_only_the_family_knows_the_sign(
    noise: float, stated: int, letter: str
) -> None:
    codes, angles = assign(np.array([0, 0, 0, 0, noise]), AROUND, [0, 0, 0, 0, stated])
    assert Assignment(codes[4]).name == letter
    assert angles[4] == 180 * stated


def test_a_form_is_finite_and_belongs_to_its_pattern() -> None:
    sheet, _ = fold_pattern(FLAT, hinge(10), EDGES, FACES, np.zeros(5))
    with pytest.raises(InvalidPattern, match="must be finite"):
        FoldedForm(np.array([[0, 0, np.nan]]))
    with pytest.raises(InvalidPattern, match="4 vertices, its folded form 3"):
        Fold(sheet, FoldedForm(np.zeros((3, 3))))
