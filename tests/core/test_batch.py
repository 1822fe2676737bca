import pickle

import numpy as np
import pytest

from foldmill import InvalidInput, NoCandidate, Outcomes


def test_every_column_has_a_value_for_each_configuration() -> None:
    codes, at = np.zeros(3, np.uint8), np.full(3, -1, np.int32)
    assert len(Outcomes(codes, at, {"height_mm": np.zeros(3)})) == 3
    with pytest.raises(InvalidInput, match=r"'height_mm' has shape \(2,\)"):
        Outcomes(codes, at, {"height_mm": np.zeros(2)})


def test_a_point_without_a_place_keeps_its_number_on_the_way_between_processes() -> None:
    carried = pickle.loads(pickle.dumps(NoCandidate("Point 4 has no place.", point=4)))
    assert (carried.point, str(carried)) == (4, "Point 4 has no place.")
