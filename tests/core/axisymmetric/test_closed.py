"""Creases closed to ±180 have the sign they had just before, in every family of this kind."""

from __future__ import annotations

import numpy as np
import pytest
from six_crease_oracle import random_design

from foldmill import Fold, ImpossibleGeometry
from foldmill.axisymmetric import strip
from foldmill.check import assignment, check
from foldmill.check.intersection import penetrations
from foldmill_plugins.rotational import DESIGN as ROTATIONAL
from foldmill_plugins.six_crease import DESIGN as SIX_CREASE
from foldmill_plugins.six_crease.params import SixCreaseParams
from foldmill_plugins.tuck import DESIGN as TUCK

AJAR = 0.02
"""deg"""


def on_axis(seed: int, beta: float) -> SixCreaseParams:
    """Return a random tube with P_1, and at β = 0 or 180 P_2 as well, on the axis."""
    params = random_design(seed)
    return params.model_copy(update={"L": 0.0, "beta": beta})


def run(params: SixCreaseParams) -> Fold | None:
    try:
        fold = SIX_CREASE.run(params)
    except ImpossibleGeometry:
        return None
    return fold if fold.symmetry is not None and fold.symmetry.one_sided else None


@pytest.mark.parametrize("tab", [0.0, 0.02])
def test_a_tube_with_a_point_on_its_axis_is_signed_as_its_neighbour_off_the_axis(
    tab: float,
) -> None:
    signed = 0
    for seed in range(60):
        for beta in (0.0, 180.0):
            shut = on_axis(seed, beta)
            fold = run(shut)
            if fold is None:
                continue
            neighbours = [run(shut.model_copy(update={"beta": b})) for b in (AJAR, 180 - AJAR)]
            ajar = neighbours[int(beta == 180)]
            if ajar is None:  # the form is on the other side of its axis
                other = -AJAR if beta == 0 else 180 + AJAR
                ajar = run(shut.model_copy(update={"beta": other}))
            assert ajar is not None
            if np.abs(fold.pattern.fold_angles).max() < 180:
                continue
            assert fold.pattern.letters() == ajar.pattern.letters()
            if tab:
                fold = SIX_CREASE.run(shut.model_copy(update={"tab": tab * shut.w}))
                assert "U" not in fold.pattern.letters()
            assert not assignment(fold).findings
            signed += 1
    assert signed >= 8


@pytest.mark.parametrize("seed", [5, 65, 123, 297])
def test_a_tube_on_both_sides_of_its_axis_states_no_sign_and_penetrates(seed: int) -> None:
    fold = SIX_CREASE.run(on_axis(seed, 0.0))
    assert fold.folded is not None
    assert fold.symmetry is not None
    assert not fold.symmetry.one_sided
    assert {finding.code for finding in assignment(fold).findings} == {"closed-sign"}
    pattern = fold.pattern
    assert len(penetrations(fold.folded.vertices, pattern.edges, pattern.faces))


def test_a_tube_all_beyond_its_axis_is_signed_as_well() -> None:
    rugby = SIX_CREASE.run(SIX_CREASE.preset("rugby").model_copy(update={"L": 0.0, "beta": 180.0}))
    assert rugby.symmetry is not None
    assert rugby.symmetry.one_sided
    assert np.abs(rugby.pattern.fold_angles).max() == 180
    assert not check(rugby).findings


@pytest.mark.parametrize(("i", "shift"), [(2, (-2, 0)), (3, (6, 0)), (3, (0, -6))])
def test_a_tucked_form_that_phi_closes_keeps_the_signs_it_had_before(
    i: int, shift: tuple[float, float]
) -> None:
    params = ROTATIONAL.preset("bowl-n8")
    points = {k: point.model_dump() for k, point in params.points.items()}
    r, z = strip.solve(8, 180, params.points).meridian[i] + shift
    points[i] = {"r": float(r), "z": float(z)}
    shut, ajar = (TUCK.run({"n": 8, "phi": phi, "points": points}) for phi in (180, 180 - AJAR))
    assert len(shut.meta["tucks"]) == 1
    assert shut.pattern.letters() == ajar.pattern.letters()
    assert "U" not in shut.pattern.letters()
    assert not {finding.code for finding in check(shut).findings} & {"closed-sign", "unassigned"}


@pytest.mark.parametrize("phi", [0.0, 180.0])
@pytest.mark.parametrize("name", ROTATIONAL.presets)
def test_without_free_points_a_tucked_form_is_signed_as_a_rotational_one(
    name: str, phi: float
) -> None:
    params = ROTATIONAL.preset(name).model_copy(update={"phi": phi})
    points = {k: point.model_dump() for k, point in params.points.items()}
    tucked = TUCK.run({"n": params.n, "phi": phi, "points": points})
    assert tucked.pattern.letters() == ROTATIONAL.run(params).pattern.letters()
