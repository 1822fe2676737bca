import csv
import io

import pytest

from foldmill import InvalidInput
from foldmill_fabricate.pictures.columns import columns_csv, columns_of, columns_picture

SEARCH = {
    "iterations": 2,
    "alpha_max_deg": [376.3, 360.2, 360.0],
    "e_max_deg": [16.3, 0.2, 0.0],
    "names": ["a", "b", "c"],
    "spans": [[0, 1], [2, 3], [4, 5]],
    "short": [1.0, 2.0],
}


def test_the_columns_of_a_report_are_its_lists_of_numbers_of_one_length() -> None:
    columns = columns_of(SEARCH)
    assert list(columns) == ["alpha_max_deg", "e_max_deg"]
    rows = list(csv.DictReader(io.StringIO(columns_csv(columns).decode())))
    assert [float(row["e_max_deg"]) for row in rows] == SEARCH["e_max_deg"]
    assert [row["step"] for row in rows] == ["0", "1", "2"]


def test_angle_sums_and_their_errors_are_two_graphs_one_of_them_logarithmic() -> None:
    drawn = columns_picture("Search", columns_of(SEARCH), ".svg").decode()
    assert drawn.count('id="axes_') == 2
    assert columns_picture("Search", columns_of(SEARCH)).startswith(b"\x89PNG")


def test_a_report_without_columns_is_not_drawn() -> None:
    with pytest.raises(InvalidInput, match="no columns"):
        columns_of({"freedoms": 43, "why": "text"})
