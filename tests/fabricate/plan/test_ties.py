"""Ties hold the part on straight edges: never in a corner, never at a hole."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
import shapely
from stools import machine, material, stool

from foldmill import CreasePattern, Fold, installed
from foldmill_fabricate.materials import ThroughCut
from foldmill_fabricate.plan import make
from foldmill_fabricate.sheet import placed


def polygon(corners: int, radius: float, seed: int) -> Fold:
    """A part with sides of many lengths, some too short for a tie."""
    turns = np.sort(np.random.default_rng(seed).uniform(0, 2 * np.pi, corners - 3))
    turns = np.concatenate([turns, np.array([0.0, 2.1, 4.2])])
    rim = radius * np.column_stack([np.cos(np.sort(turns)), np.sin(np.sort(turns))])
    edges = [(k, (k + 1) % corners) for k in range(corners)]
    return Fold(CreasePattern.from_lines(rim.tolist(), edges, ["B"] * corners))


def preset(family: str, name: str) -> Fold:
    design = installed().design(family)
    return design.run(design.preset(name))


PARTS: dict[str, Callable[[], Fold]] = {
    "stool": stool,
    "rugby": lambda: preset("six-crease", "rugby"),
    **{f"polygon {seed}": partial(polygon, 9, 120.0, seed) for seed in range(6)},
}


@pytest.mark.parametrize("name", PARTS)
def test_ties_keep_away_from_corners_and_holes(name: str) -> None:
    fold = PARTS[name]()
    plan = make(fold, material(), machine())
    cut = plan.material.cut
    assert isinstance(cut, ThroughCut)
    rim = placed(fold.pattern.vertices, plan.placement)[fold.pattern.outline()[0]]
    before, after = rim - np.roll(rim, 1, axis=0), np.roll(rim, -1, axis=0) - rim
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    bends = np.degrees(np.arctan2(cross, (before * after).sum(axis=1)))
    corners = rim[np.abs(bends) > 0.01]
    assert len(plan.ties) >= 3
    for tie in plan.ties:
        gaps = np.hypot(*(corners - (tie.x, tie.y)).T) - tie.width / 2
        assert gaps.min() >= cut.tie_corner - 1e-6
        assert shapely.LinearRing(rim).distance(shapely.Point(tie.x, tie.y)) < 1e-6
        for hole in plan.holes:
            apart = math.dist((hole.x, hole.y), (tie.x, tie.y)) - hole.diameter / 2
            assert apart >= plan.material.holes.part_clearance - 1e-6
