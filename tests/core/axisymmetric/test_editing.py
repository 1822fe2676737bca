"""Points are added and left out; the later ones get new numbers, and with them the other line."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import InvalidParameters
from foldmill.axisymmetric.editing import with_point, without_point
from foldmill_plugins import rotational, six_crease, tuck
from foldmill_plugins.tuck.params import Tuck

BOWL = rotational.DESIGN.params()


def distances(params: rotational.RotationalParams) -> list[float]:
    return [params.points[i].a for i in sorted(params.points)]


@pytest.mark.parametrize("i", range(1, 8))
def test_a_point_comes_in_at_its_number_and_the_later_ones_move_up(i: int) -> None:
    before = distances(BOWL)
    more = with_point(BOWL, i, a=47.5, branch=-1)
    assert distances(more) == [*before[: i - 1], 47.5, *before[i - 1 :]]
    assert more.points[i].branch == -1
    assert (more.n, more.phi, more.slit) == (BOWL.n, BOWL.phi, BOWL.slit)
    assert without_point(more, i) == BOWL


def test_parameters_are_never_changed_in_place() -> None:
    before = BOWL.model_dump_json()
    with_point(BOWL, 3, a=60.0)
    without_point(BOWL, 3)
    assert BOWL.model_dump_json() == before


def test_one_more_point_is_one_more_ring_of_paper() -> None:
    fold = rotational.DESIGN.run(with_point(BOWL, 7, a=150.0))
    faces = len(rotational.DESIGN.run(BOWL).pattern.faces)
    assert len(fold.pattern.faces) == faces + 2 * BOWL.n
    assert fold.pattern.size == pytest.approx(300, abs=1e-9)


def test_a_point_between_two_puts_the_later_ones_on_the_other_line() -> None:
    names = {handle.name for handle in rotational.DESIGN.run(BOWL).handles}
    fold = rotational.DESIGN.run(with_point(BOWL, 3, a=60.0))
    spots = {handle.name: handle.position for handle in fold.handles}
    assert set(spots) - names == {"points.7.a"}
    assert spots["points.3.a"] == pytest.approx([60.0, 0.0])
    turned = np.degrees(np.arctan2(*spots["points.4.a"][::-1]))
    assert (abs(turned), np.hypot(*spots["points.4.a"])) == pytest.approx((180 / BOWL.n, 76.0))


@pytest.mark.parametrize(("i", "said"), [(0, "as number 0"), (8, "number 1 to 7"), (-1, "1 to 6")])
def test_a_number_that_is_not_there_is_refused(i: int, said: str) -> None:
    with pytest.raises(InvalidParameters, match=said):
        with_point(BOWL, i, a=60.0)
    with pytest.raises(InvalidParameters, match=f"no number {i} to leave out: there are 1 to 6"):
        without_point(BOWL, i)


def test_what_is_no_point_is_refused_by_its_name() -> None:
    with pytest.raises(InvalidParameters, match=r"points\.3\.a is missing"):
        with_point(BOWL, 3)
    with pytest.raises(InvalidParameters, match=r"points\.3\.a must be more than 0 mm, not -2"):
        with_point(BOWL, 3, a=-2.0)
    two = rotational.DESIGN.validate({"points": {1: {"a": 40}, 2: {"a": 56}}})
    with pytest.raises(InvalidParameters, match="a facet needs points 1 and 2"):
        without_point(two, 1)


def test_points_that_do_not_rise_are_refused_by_the_family() -> None:
    with pytest.raises(InvalidParameters, match="Point 3 must lie farther out than point 1"):
        rotational.DESIGN.run(with_point(BOWL, 3, a=30.0))


def test_a_tube_takes_its_heights_the_same_way() -> None:
    tube = six_crease.DESIGN.params()
    last = len(tube.points)
    more = with_point(tube, last + 1, y=tube.points[last].y + 30)
    assert len(more.points) == last + 1
    assert without_point(more, last + 1) == tube
    with pytest.raises(InvalidParameters, match="point 3 must lie above point 1"):
        with_point(tube, 3, y=tube.points[1].y)


def test_a_tuck_stays_beside_its_point() -> None:
    stool = tuck.DESIGN.preset("stool-n8")
    tucked = stool.model_copy(update={"tucks": (_tuck(4),)})
    more = with_point(tucked, 1, a=60.0)
    assert [each.point for each in more.tucks] == [5]
    assert without_point(more, 1) == tucked
    assert without_point(tucked, 4).tucks == ()
    assert [each.point for each in with_point(tucked, 6, r=97.0, z=-140.0).tucks] == [4]


def _tuck(point: int) -> Tuck:
    return Tuck(point=point, t=189.2)
