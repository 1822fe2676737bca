"""Flaps too narrow to bend, and holes too tight for a knife that swivels."""

from __future__ import annotations

import numpy as np
import pytest
import stools

from foldmill import CreasePattern, Fold
from foldmill_fabricate import shelf
from foldmill_fabricate.plan import make
from foldmill_fabricate.plan.shapes import facets, flaps


def strip(width: float) -> Fold:
    """A sheet of 120 × 80 mm with a flap of that width on its right."""
    spots = [(0, 0), (120 - width, 0), (120, 0), (120, 80), (120 - width, 80), (0, 80)]
    lines = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)]
    return Fold(CreasePattern.from_lines(spots, lines, "BBBBBBV"))


@pytest.mark.parametrize("width", [7.9, 8.0, 8.1, 3.0])
def test_a_flap_narrower_than_the_material_bends_is_told_with_its_width(width: float) -> None:
    plan = make(strip(width), stools.material(), stools.machine())
    told = [finding for finding in plan.findings if finding.code == "narrow-flap"]
    assert bool(told) == (width < 8)
    if told:
        assert f"{width:.2f} mm free" in told[0].message


def test_triangles_joined_by_flat_edges_are_one_facet() -> None:
    pattern = strip(20.0).pattern
    assert len(pattern.faces) == 4
    assert len(set(facets(pattern).tolist())) == 2
    assert len(list(flaps(pattern, pattern.vertices))) == 2


def test_the_facets_of_the_stool_hold_all_its_area() -> None:
    pattern = stools.stool().pattern
    number = facets(pattern)
    corners = pattern.vertices[pattern.faces]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    sums = np.bincount(number, areas)
    assert len(sums) < len(pattern.faces)
    assert sums.sum() == pytest.approx(areas.sum())


def test_a_blade_with_much_offset_makes_no_round_holes() -> None:
    fold = strip(30.0)
    crossed = CreasePattern.from_lines(
        [*fold.pattern.vertices.tolist(), [50, 0], [50, 80]],
        [(0, 6), (6, 1), (1, 2), (2, 3), (3, 4), (4, 7), (7, 5), (5, 0), (1, 4), (6, 7)],
        "BBBBBBBBVM",
    )
    codes = []
    for slug in ("generic-hpgl-600", "grbl-drag-knife"):
        plan = make(Fold(crossed), stools.material(), shelf.machine(slug))
        assert plan.holes
        codes.append({finding.code for finding in plan.findings})
    assert "tight-hole" not in codes[0]
    assert "tight-hole" in codes[1]


def test_a_groove_deeper_than_usual_is_told_which_way_it_fails() -> None:
    material = stools.material()
    for ratio, word in ((0.7, "tear"), (0.4, "wander")):
        score = material.score.model_copy(update={"depth_ratio": ratio})
        changed = material.model_copy(update={"score": score})
        plan = make(strip(30.0), changed, stools.machine())
        [told] = [finding for finding in plan.findings if finding.code == "depth-range"]
        assert word in told.message
