from itertools import product

import numpy as np
import pytest

from foldmill import FoldmillError
from foldmill_fabricate.explore import Range
from foldmill_fabricate.explore.grid import grid
from foldmill_plugins.six_crease import DESIGN as TUBE
from foldmill_plugins.tuck import DESIGN as STOOL

CANDLESTICK = TUBE.preset("candlestick")


def test_rows_go_through_all_combinations_the_last_parameter_fastest() -> None:
    ranges = [Range.read("n=6,8"), Range.read("beta=0:20:10"), Range.read("points.3.y=27,28,29,30")]
    made = grid(TUBE, CANDLESTICK, ranges)
    columns = made.columns(np.arange(len(made)))
    expected = list(product((6, 8), (0, 10, 20), (27, 28, 29, 30)))
    assert list(zip(*columns.values(), strict=True)) == expected
    assert made.values(13) == {"n": 8, "beta": 0, "points.3.y": 28}
    assert made.told(13) == "n = 8, beta = 0 deg, points.3.y = 28 mm"
    assert [axis.is_whole for axis in made.axes] == [True, False, False]


@pytest.mark.parametrize(
    ("texts", "sentence"),
    [
        ([], "Nothing is varied"),
        (["beta=0,1", "beta=2,3"], "beta is varied twice"),
        (["betta=0,1"], "no parameter 'betta' here. There are: n, w, L, phi, beta"),
        (["points=0,1"], "points holds others .* vary one of points.1.y"),
        (["points.3=0,1"], "points.3 holds others"),
        (["points.10.y=0,1"], "no parameter 'points.10.y'"),
        (["n=6:8:0.5"], "n is a whole number, and 6.5 is none"),
        (["points.3.branch=0,1"], "points.3.branch is one of -1, 1, never 0"),
        (["beta=0:999:1", "phi=0:99:1", "L=0:9:0.5"], "1,000 × 100 × 19 = 1,900,000 rows, more"),
    ],
)
def test_a_grid_that_means_nothing_is_refused_with_what_there_is(
    texts: list[str], sentence: str
) -> None:
    with pytest.raises(FoldmillError, match=sentence):
        grid(TUBE, CANDLESTICK, [Range.read(text) for text in texts])


def test_a_choice_among_words_has_no_range() -> None:
    base = STOOL.preset("stool-n8")
    with pytest.raises(FoldmillError, match="is no number, so it has no range"):
        grid(STOOL, base, [Range.read("tucks.0.lies=0,1")])


def test_a_value_that_is_not_stated_can_be_varied() -> None:
    assert len(grid(TUBE, CANDLESTICK, [Range.read("points.3.gamma=0:90:45")])) == 3


def test_more_rows_are_allowed_when_asked_for() -> None:
    ranges = [Range.read("beta=0:9:1"), Range.read("phi=0:9:1")]
    assert len(grid(TUBE, CANDLESTICK, ranges, at_most=100)) == 100
    with pytest.raises(FoldmillError, match="--at-most 100"):
        grid(TUBE, CANDLESTICK, ranges, at_most=99)
