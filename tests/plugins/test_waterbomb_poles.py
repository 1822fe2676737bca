"""Poles, tips and edges of a target: found where they are, between samples too, and named."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from waterbomb_targets import BALL, ROUND

from foldmill import ImpossibleGeometry
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.base import Offsets, base_mesh
from foldmill_plugins.waterbomb.poles import PLACES, require_normals
from foldmill_plugins.waterbomb.surfaces import TABLE
from foldmill_plugins.waterbomb.topology import Topology

CONE = {"x": "v*cos(u)", "y": "v*sin(u)", "z": "v", **ROUND}
BRANCH = {"x": "u**2 - v**2", "y": "2*u*v", "z": "0.1*u"}
CUSP = {"x": "u**2", "y": "v", "z": "u**3"}
FOLDED = {"x": "u", "y": "(v - 0.3*u - 0.01)**2", "z": "0"}
ACROSS = {"x": "cos(u)*cos(v)", "y": "cos(u)*sin(v)", "z": "sin(u)"}


def over(given: dict[str, Any], u: tuple[float, float], v: tuple[float, float]) -> dict[str, Any]:
    spans = {"u_start": u[0], "u_end": u[1]} if "u_start" not in given else {}
    surface = {"kind": "expression", **given, **spans, "v_start": v[0], "v_end": v[1]}
    return {"surface": surface, "n_u": 12, "n_v": 6}


@pytest.mark.parametrize(
    ("values", "u", "v", "advice"),
    [
        (
            over(BALL, (0, 0), (-1.9, 1.1)),
            None,
            -np.pi / 2,
            "of v so that it stays clear of v = -1.5708",
        ),
        (
            over(BALL, (0, 0), (-1.2, 1.7)),
            None,
            np.pi / 2,
            "of v so that it stays clear of v = 1.5708",
        ),
        (over(CONE, (0, 0), (-0.71, 1.3)), None, 0, "clear of v = 0"),
        (over(ACROSS, (-1.9, 1.1), (0, 1)), -np.pi / 2, None, "clear of u = "),
        (over(BRANCH, (-1, 1.03), (-0.9, 1.07)), 0, 0, "range of u or of v"),
        (over(CUSP, (-1, 1.07), (-1, 1)), 0, None, "clear of u = "),
        (over(FOLDED, (-1, 1), (-1, 1)), None, None, "range of u or of v"),
    ],
)
def test_a_place_without_a_normal_between_samples_is_found_and_named(
    values: dict[str, Any], u: float | None, v: float | None, advice: str
) -> None:
    with pytest.raises(ImpossibleGeometry, match="the target shrinks to a point or a line") as told:
        DESIGN.run(values)
    found = re.match(r"At u = (\S+), v = (\S+) the target", str(told.value))
    assert found is not None
    for said, wanted in zip(found.groups(), (u, v), strict=True):
        if wanted is not None:
            assert float(said) == pytest.approx(wanted, abs=2e-3)
    assert "Shorten the range of" in str(told.value)
    assert advice in str(told.value)


def test_poles_that_were_told_as_self_intersections_lie_between_the_samples() -> None:
    share = np.linspace(-1.2, 1.7, PLACES)
    assert np.abs(share - np.pi / 2).min() > 0.01


@pytest.mark.parametrize(
    ("given", "u", "v"),
    [
        (BALL, (0, 0), (-1.5, 1.5)),
        (CONE, (0, 0), (0.05, 1.3)),
        (BRANCH, (0.1, 1), (0.1, 1)),
        (CUSP, (0.05, 1), (-1, 1)),
        ({"x": "u", "y": "v", "z": "0.3*sin(9*u)*cos(9*v)"}, (-1, 1), (-1, 1)),
    ],
)
def test_a_target_that_only_comes_near_to_such_a_place_is_taken(
    given: dict[str, Any], u: tuple[float, float], v: tuple[float, float]
) -> None:
    require_normals(DESIGN.validate(over(given, u, v)).surface.surface())


@pytest.mark.parametrize("kind", list(TABLE))
def test_the_seven_surfaces_have_a_normal_everywhere(kind: str) -> None:
    require_normals(TABLE[kind])


def test_a_rim_that_slides_beyond_a_pole_is_refused_and_one_before_it_is_not() -> None:
    sphere = {"surface": {"kind": "sphere"}, "n_u": 25, "start": "uniform", "rim": "outside"}
    with pytest.raises(ImpossibleGeometry, match=r"v = -1\.5708 the target shrinks"):
        DESIGN.run({**sphere, "n_v": 4})
    DESIGN.run({**sphere, "n_v": 10})
    DESIGN.run({**sphere, "n_v": 4, "rim": "inside", "n_u": 12})


def test_a_facet_whose_corners_lie_on_one_line_is_refused() -> None:
    flat, graph = TABLE["hyperbolic-paraboloid"], Topology(3, 3)
    with pytest.raises(ImpossibleGeometry, match="facet without area"):
        base_mesh(flat, graph, Offsets(0.0, 0.5))
