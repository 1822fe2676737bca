"""Dihedral angles of a vertex while a form moves."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import Fold, InvalidParameters
from foldmill.dihedral import creases_of, dihedral_angles
from foldmill.folded import fold_pattern
from foldmill.motion import Motion

FLAT = np.array([(0, 0), (10, 0), (10, 10), (0, 10), (-10, 10), (-10, 0)], float)
EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (3, 4), (0, 4), (4, 5), (0, 5)])
FACES = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)])


def book(t: float) -> np.ndarray:
    """Return a sheet folded along x = 0 by 180·t degrees, as a valley."""
    angle = np.pi * t / 2
    x, y = FLAT.T
    return np.column_stack([x * np.cos(angle), y, np.abs(x) * np.sin(angle)])


def sheet() -> tuple[Fold, Motion]:
    pattern, form = fold_pattern(FLAT, book(0), EDGES, FACES, np.zeros(len(EDGES), int))
    return Fold(pattern, form), Motion("close", "Close the book", book)


def test_only_the_spine_of_a_book_turns_and_by_the_angle_of_its_covers() -> None:
    fold, motion = sheet()
    times = [0.0, 0.25, 0.5, 1.0]
    table = dihedral_angles(fold, motion, 0, times)
    assert table.edges.tolist() == [3, 2, 6]  # clockwise from straight up: spine, right, left
    assert table.angles[:, 0] == pytest.approx([180, 135, 90, 0])
    assert table.angles[:, 1:] == pytest.approx(np.full((4, 2), 180.0))
    assert table.times.tolist() == times
    assert table.names == ("0-3 F", "0-2 F", "0-4 F")


def test_a_corner_of_the_sheet_has_no_creases() -> None:
    fold, motion = sheet()
    assert dihedral_angles(fold, motion, 1, [0.5]).angles.shape == (1, 0)


@pytest.mark.parametrize("vertex", [-1, 6])
def test_a_vertex_that_is_not_there_is_refused(vertex: int) -> None:
    with pytest.raises(InvalidParameters, match=f"no vertex {vertex}; the pattern has 0 to 5"):
        creases_of(sheet()[0], vertex)


def test_a_moment_beyond_the_motion_is_refused() -> None:
    fold, motion = sheet()
    with pytest.raises(InvalidParameters, match=r"'close' goes from t = 0 to 1, not to 1\.5"):
        dihedral_angles(fold, motion, 0, [0.0, 1.5])
