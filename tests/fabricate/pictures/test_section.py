"""The section of a fold: on which side it is open, and what is left of the sheet."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point

from foldmill_fabricate import handbook
from foldmill_fabricate.materials import Material
from foldmill_fabricate.materials.processes import AnyScore
from foldmill_fabricate.pictures.section import REACH, section, section_picture

EVERY = [(m, score) for m in handbook.shipped_materials() for score in m.scores]
IDS = [f"{m.slug}-{score.kind}" for m, score in EVERY]
OUTSIDE, INSIDE = {"half-cut", "crease-wheel"}, {"v-score", "stylus"}


def scores(kind: str) -> list[tuple[AnyScore, float]]:
    return [(score, m.thickness) for m, score in EVERY if score.kind == kind]


@pytest.mark.parametrize(("material", "score"), EVERY, ids=IDS)
def test_the_groove_of_the_flat_sheet_is_on_the_face_the_preset_names(
    material: Material, score: AnyScore
) -> None:
    t = material.thickness
    flat = section(score, t, 0.0)
    below, above = (not flat.covers(Point(0, y)) for y in (t * 0.001, t * 0.999))
    through = score.kind == "perforation"
    assert above == (score.kind in OUTSIDE or through)
    assert below == (score.kind in INSIDE or through)
    if score.score_face != "either":
        assert above == (score.score_face == "outside")


@pytest.mark.parametrize(("material", "score"), EVERY, ids=IDS)
def test_what_is_left_under_a_groove_is_the_web_of_the_preset(
    material: Material, score: AnyScore
) -> None:
    import shapely

    t = material.thickness
    flat = section(score, t, 0.0)
    line = shapely.LineString([(0, -2 * t), (0, 2 * t)])
    left = flat.intersection(line).length
    wanted = {"perforation": 0.0, "pen": t, "crease-wheel": t}.get(score.kind)
    if wanted is None:
        depth = getattr(score, "depth_ratio")  # noqa: B009 - pens have none
        wanted = t * (1 - depth)
    assert left == pytest.approx(wanted, abs=0.02 * t)


@given(angle=st.floats(10, 120), number=st.integers(0, len(EVERY) - 1))
def test_a_slit_opens_on_the_outside_and_a_mitre_closes_on_the_inside(
    angle: float, number: int
) -> None:
    material, score = EVERY[number]
    t = material.thickness
    folded = section(score, t, angle)
    top = Point(0, t * 1.05)
    if score.kind == "half-cut":
        assert not folded.covers(Point(0, 0.98 * t)), "the slit gapes"
        assert folded.covers(Point(0, t * score.remains / 2)), "the web holds"
    if score.kind in {"stylus", "v-score", "pen"}:
        assert folded.covers(Point(0, 0.98 * t)), "the outside is whole"
    assert not folded.covers(top)


@given(angle=st.floats(0, 120))
def test_both_halves_of_a_fold_are_alike(angle: float) -> None:
    from shapely import affinity

    for material, score in EVERY:
        folded = section(score, material.thickness, angle)
        turned = affinity.scale(folded, -1, 1, origin=(0, 0))
        assert folded.symmetric_difference(turned).area < 1e-6 * material.thickness**2
        assert folded.area > REACH * material.thickness**2


def test_the_picture_is_the_same_every_time() -> None:
    material, score = EVERY[0]
    assert section_picture(material, score) == section_picture(material, score)
