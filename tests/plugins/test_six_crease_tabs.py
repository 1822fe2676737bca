"""Glue tabs of a six-crease tube: one at each seam edge, upon the facet across the seam."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from tubes import FACES, SHAPES, WHOLE, closed_by, space

from foldmill import Assignment, Fold
from foldmill.check import check
from foldmill.check.intersection import penetrations

CHOICES = pytest.mark.parametrize(("width", "taper"), [(2, 0), (3, 30), (1.2, 75), (5, 45)])


def with_tabs(name: str, width: float, taper: float = 30) -> Fold:
    return closed_by("tabs", name, width, taper)


@SHAPES
@CHOICES
def test_a_sheet_with_tabs_is_one_sheet_that_folds_through_nothing(
    name: str, width: float, taper: float
) -> None:
    fold = with_tabs(name, width, taper)
    assert not check(fold).findings
    assert len(fold.pattern.vertices) == WHOLE + 2 * fold.meta["tabs"] == WHOLE + 6
    assert len(fold.pattern.outline()) == 1
    assert not len(penetrations(space(fold), fold.pattern.edges, fold.pattern.faces))


@SHAPES
@CHOICES
def test_a_tab_lies_upon_the_facet_across_the_seam_and_inside_it(
    name: str, width: float, taper: float
) -> None:
    fold = with_tabs(name, width, taper)
    vertices, faces = space(fold), fold.pattern.faces
    assert fold.folded is not None
    partner = dict(fold.folded.seams[:, ::-1].tolist())
    for tab in (FACES, FACES + 2, FACES + 4):
        corners = sorted({*faces[tab].tolist(), *faces[tab + 1].tolist()})
        ends = {partner[vertex] for vertex in corners if vertex in partner}
        land = next(face for face in faces[:FACES].tolist() if ends <= set(face))
        a, b, c = vertices[land]
        for spot in vertices[[vertex for vertex in corners if vertex >= WHOLE]]:
            shares, off = np.linalg.lstsq(np.column_stack([b - a, c - a]), spot - a)[:2]
            assert off[0] < 1e-20
            assert min(*shares, 1 - shares.sum()) > -1e-12


@pytest.mark.parametrize("taper", [0, 20, 70])
def test_a_tab_has_the_width_and_the_taper_it_was_given(taper: float) -> None:
    fold = with_tabs("bud", 2.0, taper)
    outline = fold.pattern.vertices[WHOLE:]
    border = np.abs(fold.pattern.vertices[:WHOLE, 0]).max()
    assert np.abs(np.abs(outline[:, 0]) - border) == pytest.approx(np.full(6, 2.0))
    corners = fold.pattern.vertices[fold.pattern.faces[FACES:]].reshape(3, 6, 2)
    for six, (low, high) in zip(corners, outline.reshape(3, 2, 2), strict=True):
        on_seam = six[np.isclose(np.abs(six[:, 0]), border), 1]
        leans = np.degrees(np.arctan2([low[1] - on_seam.min(), on_seam.max() - high[1]], 2.0))
        # Where the facet across the seam is narrower, the end leans more.
        assert (leans >= taper - 1e-9).all()
        assert taper < 70 or leans == pytest.approx([taper, taper])


@SHAPES
def test_the_crease_of_a_tab_is_what_that_line_is_in_every_other_wedge(name: str) -> None:
    fold = with_tabs(name, 3.0)
    pattern = fold.pattern
    assert fold.folded is not None
    seam = fold.folded.seams[:, 1]
    middle = pattern.vertices[pattern.edges].mean(axis=1)
    for a, b in pairwise(seam):
        crease = int(np.flatnonzero((np.sort(pattern.edges, axis=1) == sorted((a, b))).all(1))[0])
        step = np.abs(middle - middle[crease])
        alike = np.flatnonzero((step[:, 1] < 1e-9) & (np.abs(step[:, 0] % 20 - 10) > 10 - 1e-9))
        inner = [e for e in alike if pattern.assignments[e] != Assignment.B]
        assert len(inner) == 10
        assert len({int(pattern.assignments[e]) for e in inner}) == 1
        assert np.ptp(pattern.fold_angles[inner]) < 1e-9
        assert pattern.assignments[crease] in {Assignment.M, Assignment.V}


def test_tabs_do_not_overlap_each_other_or_the_sheet() -> None:
    pattern = with_tabs("ball", 6.0, 0).pattern
    triangles = shapely.polygons(pattern.vertices[pattern.faces])
    area = shapely.area(shapely.union_all(triangles))
    assert area == pytest.approx(float(shapely.area(triangles).sum()), abs=1e-9)
