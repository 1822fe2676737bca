from __future__ import annotations

import io
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from foldmill import Outcome
from foldmill.configurations import with_values
from foldmill_fabricate.errors import CannotExplore
from foldmill_fabricate.explore import FAULT, Local, Range, Sweep, explore
from foldmill_fabricate.explore.picture import LOOKS, sweep_picture
from foldmill_fabricate.explore.stated import stated
from foldmill_fabricate.explore.view import APART, THUMBNAILS, thumbnails, view
from foldmill_plugins.rotational import DESIGN as BOWL
from foldmill_plugins.rotational import RotationalParams

TEXTS = re.compile(rb"<!--(.*?)-->")
Bowls = Sweep[RotationalParams]


def bowls(*texts: str) -> Bowls:
    return explore(BOWL, BOWL.preset("bowl-n8"), [Range.read(t) for t in texts], Local(1))


@pytest.fixture(scope="module")
def maps() -> Bowls:
    """Two sizes of map: n = 6 and n = 8."""
    return bowls("phi=40:110:10", "points.4.a=95:105:5", "n=6,8")


def rgb(colour: str) -> tuple[int, ...]:
    return tuple(int(colour[k : k + 2], 16) for k in (1, 3, 5))


def test_the_map_has_the_colours_of_its_outcomes_in_their_shares(maps: Bowls) -> None:
    content = sweep_picture(maps)
    pixels = np.asarray(Image.open(io.BytesIO(content)).convert("RGB")).reshape(-1, 3)
    seen = view(maps)
    areas = {
        kind: int((pixels == rgb(look.colour)).all(axis=1).sum())
        for kind, look in LOOKS.items()
        if kind != FAULT  # black, as the letters are
    }
    for kind, area in areas.items():
        assert (area > 1000) == (seen.codes == kind).any()
    free, crossing = (seen.codes == kind for kind in (Outcome.FREE, Outcome.CROSSES_AXIS))
    share = areas[Outcome.FREE.value] / areas[Outcome.CROSSES_AXIS.value]
    assert share == pytest.approx(free.sum() / crossing.sum(), rel=0.15)


def test_the_colours_differ_in_lightness_for_those_who_see_no_colours() -> None:
    greys = sorted(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in
                   (rgb(look.colour) for look in LOOKS.values()))  # fmt: skip
    assert np.diff(greys).min() > 10


def test_an_svg_is_well_formed_and_pictures_are_the_same_each_time(maps: Bowls) -> None:
    content = sweep_picture(maps, ".svg", [1])
    assert content == sweep_picture(maps, ".svg", [1])
    assert sweep_picture(maps, ".png", [1]) == sweep_picture(maps, ".png", [1])
    assert ElementTree.fromstring(content).tag.endswith("svg")


def test_a_map_goes_through_the_row_it_is_asked_for(maps: Bowls) -> None:
    for row in (0, 1, 17):
        seen = view(maps, row)
        assert row in seen.rows
        assert seen.rows.shape == (8, 3)
        n = maps.grid.values(row)["n"]
        assert {maps.grid.values(int(each))["n"] for each in seen.rows.ravel()} == {n}
        assert seen.fixed == f"n = {n:g}"
    with pytest.raises(CannotExplore, match=r"Row 0 .* is not in the picture, where n = 8"):
        thumbnails(view(maps, 1), [0])


def test_the_forms_beside_it_are_free_different_and_among_them_the_centre(maps: Bowls) -> None:
    chosen = thumbnails(view(maps))
    assert 1 < len(chosen) <= THUMBNAILS
    assert len(set(chosen)) == len(chosen)
    assert (maps.outcomes.codes[chosen] == Outcome.FREE).all()
    assert maps.regions[0].centre in chosen


def test_one_parameter_makes_a_strip() -> None:
    content = sweep_picture(bowls("phi=40:110:10"), forms=[0])
    assert Image.open(io.BytesIO(content)).size[0] > 1000


def test_where_nothing_is_free_the_map_stands_alone() -> None:
    assert thumbnails(view(bowls("phi=30:50:10"))) == []
    assert len(sweep_picture(bowls("phi=30:50:10", "points.4.a=95:105:5"))) > 1000


def test_a_row_without_a_form_is_no_thumbnail() -> None:
    sweep = bowls("phi=170:190:10")
    with pytest.raises(CannotExplore, match=r"Row 2 \(phi = 190 deg\) is refused: it has no form"):
        sweep_picture(sweep, forms=[2])
    with pytest.raises(CannotExplore, match="13 thumbnails do not fit"):
        thumbnails(view(sweep), [0] * 13)


@pytest.fixture(scope="module")
def orders() -> Bowls:
    """A map with a count as axis, between whose values nothing lies."""
    return bowls("phi=60:110:2.5", "n=3:24:1")


def test_a_count_has_ticks_at_whole_numbers(orders: Bowls) -> None:
    said = b"".join(sweep_picture(orders, ".svg", [0]).split())
    ticks = [text for text in TEXTS.findall(said) if re.fullmatch(rb"[\d.]+", text)]
    assert {b"3", b"5", b"23"} <= set(ticks)
    assert not [tick for tick in ticks if b"." in tick and not tick.endswith(b".0")]


def test_forms_beside_a_map_over_a_count_are_far_apart(orders: Bowls) -> None:
    assert len(orders.regions) > 8
    places = np.stack(np.unravel_index(thumbnails(view(orders)), orders.grid.shape))
    places = places.T / np.array(orders.grid.shape)
    gaps = np.linalg.norm(places[:, None] - places, axis=2)
    assert len(gaps) == THUMBNAILS
    assert np.ptp(places, axis=0).min() > 0.7
    assert gaps[np.triu_indices(len(gaps), 1)].min() >= APART


def test_the_title_tells_the_preset_and_what_is_stated_beside_it() -> None:
    base = with_values(BOWL, BOWL.preset("crown-n6"), {"points.4.a": 87.5, "slit": True, "phi": 20})
    sweep = explore(BOWL, base, [Range.read("phi=80:90:10")], Local(1))
    assert stated(sweep) == "crown-n6, points.4.a = 87.5 mm, slit = true"
    assert b"crown-n6, points.4.a = 87.5 mm, slit = true" in sweep_picture(sweep, ".svg", [0])


def test_where_nothing_is_stated_the_title_tells_the_preset_alone(maps: Bowls) -> None:
    assert stated(maps) == "bowl-n8"


def test_where_nothing_is_like_a_preset_the_title_tells_a_few_and_how_many_more() -> None:
    moved = {f"points.{i}.a": 41.0 + 20 * i for i in range(1, 7)}
    base = with_values(BOWL, BOWL.preset("bowl-n8"), moved)
    told = stated(explore(BOWL, base, [Range.read("phi=80:90:10")], Local(1)))
    assert told.startswith("bowl-n8, points.1.a = 61 mm, ")
    assert told.endswith("and 2 more")
