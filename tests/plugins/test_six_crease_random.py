"""Random six-crease tubes, with and without glue tabs, are sheets that fold without stretching."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import EntryPoint

import numpy as np
import pytest
from six_crease_oracle import random_design

from foldmill import ImpossibleGeometry, registry
from foldmill.check import assignment, developability, isometry, planarity
from foldmill.check.intersection import penetrations
from foldmill_plugins.six_crease import DESIGN, solve
from foldmill_plugins.six_crease.params import SixCreaseParams

RULES = (planarity, developability, isometry, assignment)


def with_tabs(params: SixCreaseParams) -> SixCreaseParams:
    """Return the parameters with narrow tabs."""
    return params.model_copy(update={"tab": 0.02 * params.w, "taper": 20.0})


def tubes(seeds: range) -> Iterator[SixCreaseParams]:
    """Yield the random designs that have a form, each without tabs and with them."""
    for seed in seeds:
        params = random_design(seed)
        try:
            solve.meridian(params)
        except ImpossibleGeometry:
            continue
        yield from (params, with_tabs(params))


@pytest.mark.parametrize("block", range(4))
def test_a_random_tube_is_one_sheet_that_does_not_stretch(block: int) -> None:
    made, turned_over = 0, 0
    for params in tubes(range(block * 50, (block + 1) * 50)):
        fold = DESIGN.run(params)
        findings = [finding for rule in RULES for finding in rule(fold).findings]
        assert not findings, (params, findings)
        assert fold.folded is not None
        ends = fold.folded.vertices[fold.folded.seams]
        gap = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max()
        assert gap <= 4e-15 * params.n * np.abs(fold.folded.vertices).max()
        # The first seam is at x = −w; in a sheet that was turned over, at +w.
        turned_over += bool(fold.pattern.vertices[:, 0].min() < -1.5 * params.w)
        made += 1
    assert made > 30
    assert 0 < turned_over < made


def test_half_a_wedge_decides_for_the_tube_where_no_radius_changes_its_sign() -> None:
    free, blocked, crossing, whole = 0, 0, 0, 0
    for params in tubes(range(200, 330)):
        fold = DESIGN.run(params)
        assert fold.folded is not None
        space, pattern = fold.folded.vertices, fold.pattern
        if fold.symmetry is None:  # the tabs of the tube before, which touch and do not penetrate
            assert params.tab
            assert bool(len(penetrations(space, pattern.edges, pattern.faces))) == bool(whole)
            continue
        whole = len(penetrations(space, pattern.edges, pattern.faces))
        wedge = len(penetrations(space, pattern.edges, pattern.faces[fold.symmetry.wedge]))
        if fold.symmetry.one_sided:
            assert bool(whole) == bool(wedge)
            free, blocked = free + (not whole), blocked + bool(whole)
        else:
            assert whole
            crossing += 1
    assert min(free, blocked, crossing) > 3, (free, blocked, crossing)


def test_the_family_is_offered_by_its_entry_point() -> None:
    entry = EntryPoint("six-crease", "foldmill_plugins.six_crease", "foldmill")
    offered = registry.load([entry])
    assert offered.design("six-crease") is DESIGN
    assert not offered.broken
