from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from foldmill import InvalidParameters, Outcome, Outcomes
from foldmill.batch import Column
from foldmill.configurations import one_by_one, outcomes, with_values
from foldmill.errors import BrokenBatch
from foldmill_plugins.six_crease import DESIGN as TUBE
from foldmill_plugins.tuck import DESIGN as STOOL

CANDLESTICK = TUBE.preset("candlestick")


def test_a_tube_is_free_crosses_its_axis_or_has_no_candidate_by_where_its_second_point_is() -> None:
    found = one_by_one(TUBE, CANDLESTICK, {"beta": np.array([292.9, 200.0, 10.0, 500.0])})
    assert found.codes[0] == Outcome.FREE
    assert found.codes[3] == Outcome.REFUSED
    is_lost = found.codes == Outcome.NO_CANDIDATE
    assert set(found.at[~is_lost]) == {-1}
    assert (found.at[is_lost] >= 3).all()


def test_the_figures_of_a_stool_are_those_of_its_folded_form_and_its_sheet() -> None:
    found = outcomes(STOOL, STOOL.preset("stool-n8"), {"phi": np.array([90.0])})
    assert Outcome(found.codes[0]) is Outcome.FREE
    assert found.figures["height_mm"][0] == pytest.approx(149.99, abs=0.01)
    assert found.figures["width_x_mm"][0] == pytest.approx(220.05, abs=0.01)


def test_whole_numbers_stay_whole_and_a_misspelt_name_is_refused() -> None:
    changed = with_values(TUBE, CANDLESTICK, {"n": 8.0, "points.3.branch": 1.0, "phi": 80.0})
    assert (changed.n, changed.points[3].branch, changed.phi) == (8, 1, 80.0)
    with pytest.raises(InvalidParameters, match=r"'points.30.y': '30' is not among 1, 2, 3"):
        outcomes(TUBE, CANDLESTICK, {"points.30.y": np.zeros(2)})
    with pytest.raises(InvalidParameters, match="equally long"):
        outcomes(TUBE, CANDLESTICK, {"phi": np.zeros(2), "beta": np.zeros(3)})


def true(columns: Mapping[str, Column], **changes: object) -> Outcomes:
    """Return what becomes of candlesticks, and something else in its stead."""
    return replace(one_by_one(TUBE, CANDLESTICK, columns), **changes)  # type: ignore[arg-type]


PHI = {"phi": np.array([60.0, 70.0, 80.0])}
NOUGHT = np.zeros(3)


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (lambda _: None, "it returns NoneType, not Outcomes"),
        (lambda c: true({"phi": c["phi"][1:]}), r"it returns outcomes of shape \(2,\) for 3 rows"),
        (lambda c: true(c, codes=np.full(3, 77, np.uint8)), "it gives row 0 the code 77, which is"),
        (lambda c: true(c, codes=np.full(3, 300)), "its codes must be uint8, not int64"),
        (lambda c: true(c, at=np.full(3, np.nan)), "its at must be int32, not float64"),
        (lambda c: true(c, at=np.zeros(2, np.int32)), r"InvalidInput: The column 'at' has shape"),
        (lambda c: true(c, figures={"phi": NOUGHT}), "it calls a figure 'phi', which is the name"),
        (lambda c: true(c, figures={"beta": NOUGHT}), "it calls a figure 'beta'"),
        (lambda c: true(c, figures={"row": NOUGHT}), "it calls a figure 'row'"),
        (lambda c: true(c, figures={"a_mm": NOUGHT > 0}), "its figure 'a_mm' must be float64, not"),
    ],
)
def test_what_a_batch_must_not_return_is_refused_with_the_name_of_the_family(
    answer: Callable[[Mapping[str, Column]], Outcomes], said: str
) -> None:
    def batch(_: Any, columns: Mapping[str, Column]) -> Outcomes:
        return answer(columns)

    with pytest.raises(BrokenBatch, match=f"batch of the family 'six-crease' is broken: .*{said}"):
        outcomes(replace(TUBE, batch=batch), CANDLESTICK, PHI)


def test_a_batch_cannot_write_into_its_columns() -> None:
    def batch(_: Any, columns: Mapping[str, Column]) -> Outcomes:
        columns["phi"][:] = 0
        return true(columns)

    with pytest.raises(ValueError, match="read-only"):
        outcomes(replace(TUBE, batch=batch), CANDLESTICK, PHI)
    assert PHI["phi"].all()
