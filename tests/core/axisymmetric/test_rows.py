"""Columns of parameters keep the bounds of the model, and rows that are one form are found."""

import numpy as np

from foldmill.axisymmetric.rows import Rows, alike, in_bounds
from foldmill.configurations import with_values
from foldmill.errors import InvalidParameters
from foldmill_plugins.six_crease import DESIGN

BASE = DESIGN.preset("candlestick")
CASES = {
    "n": [2, 3, 7.5, 72, 73, np.nan],
    "w": [0, 1e-300, 10_000, np.nextafter(10_000, np.inf), np.inf],
    "phi": [np.nextafter(0, -1), -0.0, 0, 180, 180.0001],
    "L": [-1, 0, 10_000, 10_001, -np.inf],
    "points.3.branch": [-1, 0, 1, 0.5, np.nan],
    "points.3.gamma": [-720, 0, np.inf, np.nan],
    "tab": [-1, 0, 99_999, 100_000],
}


def is_taken(name: str, value: float) -> bool:
    try:
        with_values(DESIGN, BASE, {name: value})
    except InvalidParameters:
        return False
    return True


def test_a_column_keeps_bounds_where_the_model_takes_its_value() -> None:
    for name, values in CASES.items():
        kept = in_bounds(BASE, {name: np.array(values)})
        assert kept is not None
        assert kept.tolist() == [is_taken(name, value) for value in values], name
        assert 0 < kept.sum() < len(kept)


def test_a_row_keeps_bounds_where_all_its_values_do() -> None:
    columns = {"n": np.array([8, 2, 8, 2]), "phi": np.array([90, 90, 181, 181])}
    kept = in_bounds(BASE, columns)
    assert kept is not None
    assert kept.tolist() == [True, False, False, False]


def test_nothing_is_said_of_a_column_that_holds_other_parameters() -> None:
    assert in_bounds(BASE, {"points": np.zeros(2)}) is None


def test_a_parameter_is_its_column_where_it_varies_and_its_stated_value_elsewhere() -> None:
    rows = Rows(BASE, {"phi": np.array([10.0, 20.0, 30.0])})
    assert rows.of("phi").tolist() == [10, 20, 30]
    assert rows.of("points.2.y").tolist() == [6.5]
    assert rows.table(["phi", "w"]).tolist() == [[10, 10], [20, 10], [30, 10]]
    assert rows.table(["L", "w"]).tolist() == [[42, 10]]
    assert rows.within("points") == list(range(1, 10))


def test_rows_that_differ_by_rounding_are_of_one_kind_and_others_are_not() -> None:
    angle = np.radians([30.0, 150.0, 30.0, 31.0])
    keys = np.column_stack([42 * np.sin(angle), [1.0, 1.0, 2.0, 1.0]])
    one, kind = alike(keys)
    assert len(one) == 3
    assert kind[0] == kind[1]
    assert len({*kind.tolist()}) == 3
    assert np.allclose(keys[one][kind], keys, rtol=1e-11)
    assert (keys[one][kind][:, 1] == keys[:, 1]).all()


def test_no_length_and_its_negative_are_of_one_kind() -> None:
    _, kind = alike(np.array([[0.0], [-0.0], [1e-9]]))
    assert kind[0] == kind[1] != kind[2]
