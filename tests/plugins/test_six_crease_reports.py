"""What a tube's reports say: its freedoms beside those that its hinges leave."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import Fold, ImpossibleGeometry
from foldmill_plugins.six_crease import DESIGN

SHAPES = pytest.mark.parametrize("name", DESIGN.presets)


def freedoms_left(vertices: np.ndarray, edges: np.ndarray) -> int:
    """Return how many ways there are to move without changing the length of any edge."""
    matrix = np.zeros((len(edges), len(vertices), 3))
    rows, (a, b) = np.arange(len(edges)), edges.T
    step = vertices[a] - vertices[b]
    step /= np.linalg.norm(step, axis=1, keepdims=True)
    matrix[rows, a], matrix[rows, b] = step, -step
    rank = np.linalg.matrix_rank(matrix.reshape(len(edges), -1))
    return 3 * len(vertices) - 6 - int(rank)


def glued(fold: Fold) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and edges of the tube, its seam one."""
    assert fold.folded is not None
    number = np.arange(len(fold.folded.vertices))
    number[fold.folded.seams[:, 1]] = fold.folded.seams[:, 0]
    kept, number = np.unique(number, return_inverse=True)
    edges = np.unique(np.sort(number[fold.pattern.edges], axis=1), axis=0)
    return fold.folded.vertices[kept], edges


@SHAPES
def test_the_freedoms_are_those_that_the_hinges_leave(name: str) -> None:
    params = DESIGN.preset(name)
    said, fold = DESIGN.report("freedoms", params), DESIGN.run(params)
    assert fold.folded is not None
    assert (said["N"], said["T"]) == (10, 9)
    open_sheet = freedoms_left(fold.folded.vertices, fold.pattern.edges)
    assert said["freedoms_open_sheet"] == open_sheet == 43
    assert said["freedoms_glued_tube"] == freedoms_left(*glued(fold)) == 34


def test_l_b_is_the_longest_that_still_has_a_form() -> None:
    params = DESIGN.preset("cup")
    bound = float(DESIGN.report("freedoms", params)["L_b_mm"])
    with pytest.raises(ImpossibleGeometry, match="is more than L_b"):
        DESIGN.report("freedoms", params.model_copy(update={"L": bound * (1 + 1e-9)}))
    with pytest.raises(ImpossibleGeometry, match="Point 3 has no place"):
        DESIGN.report("freedoms", params.model_copy(update={"L": bound * (1 - 1e-9)}))


def test_on_the_axis_l_has_no_bound() -> None:
    params = DESIGN.preset("bud").model_copy(update={"phi": 0.0})
    assert "point 1 is on the axis" in DESIGN.report("freedoms", params)["L_b_mm"]


def test_the_report_tells_where_the_motion_stops_and_why() -> None:
    said = DESIGN.report("freedoms", DESIGN.preset("vase-interrupted"))
    assert said["folding_rate_percent"] == pytest.approx(5.167, abs=1e-3)
    assert "point 7 reaches the axis" in said["stops"]
    assert DESIGN.report("freedoms", DESIGN.preset("vase"))["stops"].startswith("nowhere")
