import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate.errors import CannotExplore
from foldmill_fabricate.explore import Range


def test_tenths_are_tenths_and_the_end_is_reached() -> None:
    assert Range.read("t=0:1:0.1").values == (0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1)
    assert Range.read("t=0:0.95:0.1").values[-1] == 0.9
    assert Range.read("t=1:0:-0.25").values == (1, 0.75, 0.5, 0.25, 0)
    assert Range.read("t=5:5:1").values == (5,)


def test_a_count_spaces_values_evenly_with_both_ends_and_a_list_is_put_in_order() -> None:
    assert Range.read("points.3.a=-1:1:x5").values == (-1, -0.5, 0, 0.5, 1)
    assert Range.read("n=12,6,8") == Range("n", (6, 8, 12))
    assert Range.read("--fold-angle=1,2").name == "fold_angle"


@given(
    st.integers(-1000, 1000), st.integers(1, 300), st.sampled_from([0.1, 0.25, 0.3, 1e-6, 7, 1e9])
)
def test_every_value_is_the_double_nearest_to_its_decimal(
    start: int, count: int, step: float
) -> None:
    stop = start + step * count
    values = Range.steps("x", start, stop, step).values
    assert abs(len(values) - (count + 1)) <= 1  # the end itself is rounded
    for k, value in enumerate(values):
        assert math.isclose(value, start + k * step, rel_tol=1e-12, abs_tol=1e-12)
    assert all(a < b for a, b in pairwise(values))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("beta=0:10:0", "the step is 0"),
        ("beta=10:0:2", r"a step of 2 leads away from 0; write 10:0:-2\."),
        ("beta=0:inf:1", "inf is no finite number"),
        ("beta=nan", "nan is no finite number"),
        ("beta=0:1e999:1", "no finite number"),
        ("beta=0:1e300:1e-300", "would take .* values, more than 10,000,000"),
        ("beta=0:ten:1", "'ten' is no number"),
        ("beta=0:1", "has 2 parts, not 3"),
        ("beta=0:10:x1", "1 values from 0 to 10 are no range"),
        ("beta=0:10:x-3", "x-3 is no count"),
        ("beta=3,3", "takes a value twice"),
        ("beta", "says not what to vary"),
        ("=1:2:1", "says not what to vary"),
    ],
)
def test_a_range_that_means_nothing_is_refused_with_what_to_write(text: str, sentence: str) -> None:
    with pytest.raises(CannotExplore, match=sentence):
        Range.read(text)
