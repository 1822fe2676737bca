import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill import InvalidInput
from foldmill_fabricate.toolpath.perforation import Dashes, perforated, shortest

PP = Dashes(cut=3.0, gap=1.5, land=1.5)
sizes = st.floats(0.5, 6.0)


@given(st.builds(Dashes, cut=sizes, gap=sizes, land=sizes), st.floats(0.1, 700.0))
def test_a_perforated_crease_lands_at_both_ends_and_its_cuts_never_meet(
    dashes: Dashes, length: float
) -> None:
    start, along = np.array([3.0, -4.0]), np.array([0.6, 0.8])
    cuts = perforated(start, start + length * along, dashes)
    assert (len(cuts) == 0) == (length < shortest(dashes))
    if not len(cuts):
        return
    places = (cuts - start) @ along
    assert places[0, 0] == pytest.approx(length - places[-1, 1], abs=1e-9)
    assert places[0, 0] >= dashes.land - 1e-9
    assert (np.diff(places.ravel()) > 0).all()
    assert np.ptp(places[:, 1] - places[:, 0]) < 1e-9
    assert np.abs((cuts - start) @ [-0.8, 0.6]).max() < 1e-9


def test_a_long_crease_keeps_nearly_the_cuts_and_gaps_that_were_asked_for() -> None:
    cuts = perforated(np.zeros(2), np.array([100.0, 0.0]), PP)
    assert len(cuts) == 22
    assert np.diff(cuts[0, :, 0])[0] == pytest.approx(3.0, rel=0.02)
    assert cuts[1, 0, 0] - cuts[0, 1, 0] == pytest.approx(1.5, rel=0.02)


def test_lands_are_never_shorter_than_asked_however_the_row_is_stretched() -> None:
    cuts = perforated(np.zeros(2), np.array([20.0, 0.0]), Dashes(cut=3.0, gap=1.0, land=4.0))
    assert cuts[0, 0, 0] == pytest.approx(4.0)
    assert cuts[-1, 1, 0] == pytest.approx(16.0)


def test_a_perforation_needs_lengths() -> None:
    with pytest.raises(InvalidInput, match="gap must be more than 0 mm, not 0"):
        Dashes(cut=1.0, gap=0.0, land=1.0)
