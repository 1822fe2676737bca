import numpy as np
import pytest

from foldmill import InvalidParameters, Outcome
from foldmill.configurations import one_by_one, outcomes, with_values
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
