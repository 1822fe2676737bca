"""Opening an axisymmetric form into its flat sheet."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from foldmill import Fold, InvalidParameters
from foldmill.axisymmetric.points import LinePoint
from foldmill.axisymmetric.unfold import upright_points
from foldmill_plugins.rotational import DESIGN, RotationalParams

SEATED = {
    1: LinePoint(a=50),
    2: LinePoint(a=50 / np.cos(np.pi / 8)),
    3: LinePoint(a=80, gamma=-70),
    4: LinePoint(a=95),
}
"""A flat seat with p_1p_2 square to l1: point 3 is upright at φ = 90."""


def stretch(fold: Fold, vertices: np.ndarray) -> float:
    """Largest change of an edge's length, as a share of the sheet."""
    ends = vertices[fold.pattern.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return float(np.abs(lengths - fold.pattern.edge_lengths).max() / fold.pattern.size)


FORMS = {
    **DESIGN.presets,
    "seated": RotationalParams(n=8, phi=90, points=SEATED),
    "dished": RotationalParams(n=8, phi=70, points=SEATED),
}


@pytest.mark.parametrize("name", FORMS)
def test_it_begins_as_the_form_and_ends_exactly_flat(name: str) -> None:
    fold = DESIGN.run(FORMS[name])
    motion = fold.motions["unfold"]
    assert fold.folded is not None
    assert np.abs(motion.at(0) - fold.folded.vertices).max() < 1e-12 * fold.pattern.size
    end = motion.at(1)
    assert np.abs(end[:, 2]).max() < 1e-12 * fold.pattern.size
    assert np.abs(np.hypot(*end[:, :2].T) - np.hypot(*fold.pattern.vertices.T)).max() < 1e-9


@pytest.mark.parametrize("name", FORMS)
def test_no_facet_stretches_on_the_way(name: str) -> None:
    fold = DESIGN.run(FORMS[name])
    for vertices in fold.motions["unfold"].frames(16):
        assert stretch(fold, vertices) < 1e-12


@pytest.mark.parametrize("name", FORMS)
def test_it_does_not_jump(name: str) -> None:
    frames = DESIGN.run(FORMS[name]).motions["unfold"].frames(400)
    steps = [np.abs(b - a).max() for a, b in pairwise(frames)]
    assert max(steps) < 12 * np.mean(steps)


def test_an_upright_point_is_known_by_its_square_crease() -> None:
    assert upright_points(8, SEATED) == [3]
    assert upright_points(8, DESIGN.presets["bowl-n8"].points) == []


def test_asking_beyond_the_end_is_refused() -> None:
    with pytest.raises(InvalidParameters, match=r"from t = 0 to 1, not to 1\.5"):
        DESIGN.run().motions["unfold"].at(1.5)
