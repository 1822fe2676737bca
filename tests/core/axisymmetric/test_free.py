"""The opening angles at which a rotational form passes through nothing."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill.axisymmetric.free import free_intervals, is_free
from foldmill.check.intersection import penetrations
from foldmill_plugins.rotational import DESIGN, RotationalParams, _points


@pytest.mark.parametrize("name", DESIGN.presets)
def test_the_flat_sheet_and_the_preset_lie_in_one_free_interval(name: str) -> None:
    params = DESIGN.preset(name)
    spans = free_intervals(params.n, params.points)
    [own] = [span for span in spans if span[0] <= params.phi <= span[1]]
    assert own[0] <= 90 <= own[1]


def test_just_beyond_the_end_of_an_interval_the_whole_form_penetrates() -> None:
    params = DESIGN.preset("crown-n6")
    for span in free_intervals(params.n, params.points):
        for phi, outward in ((span[0], -0.02), (span[1], 0.02)):
            if not 0 < phi < 180:
                continue
            for angle, free in ((phi, True), (phi + outward, False)):
                fold = DESIGN.run(params.model_copy(update={"phi": angle}))
                assert fold.folded is not None
                edges, faces = fold.pattern.edges, fold.pattern.faces
                assert (not len(penetrations(fold.folded.vertices, edges, faces))) is free


def test_the_half_wedge_and_the_whole_form_agree_on_random_forms() -> None:
    rng = np.random.default_rng(5)
    verdicts: list[bool] = []
    while len(verdicts) < 40:
        a = np.sort(rng.uniform(15, 130, 5)) + np.arange(1, 6) * 4
        signs = rng.choice(["", "-"], 5)
        points = _points(" ".join(f"{x:.3f}{sign}" for x, sign in zip(a, signs, strict=True)))
        phi = float(rng.uniform(50, 130))
        fold = DESIGN.run(RotationalParams(n=7, phi=phi, points=points))
        assert fold.folded is not None
        whole = penetrations(fold.folded.vertices, fold.pattern.edges, fold.pattern.faces)
        verdicts.append(is_free(7, phi, points))
        assert verdicts[-1] is (not len(whole))
    assert 5 < sum(verdicts) < 35
