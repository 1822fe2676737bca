"""How many bases a waterbomb tessellation should have, for a distance or for a sheet."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill import InvalidParameters
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.density import Search, chosen
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.trial import tried


def wanting(kind: str, **wanted: Any) -> WaterbombParams:
    boundary = "fixed" if kind == "moebius" else "free"
    values = {"surface": {"kind": kind}, "boundary": boundary, "wanted": wanted}
    return DESIGN.validate(values)


@pytest.mark.parametrize(
    ("kind", "distance"), [("catenoid", 0.02), ("cylinder", 0.012), ("moebius", 0.013)]
)
def test_the_bases_told_come_as_close_as_wanted_and_one_less_along_u_does_not(
    kind: str, distance: float
) -> None:
    params = wanting(kind, distance=distance)
    told = DESIGN.report("density", params)
    finest = params.model_copy(update={"n_u": told["n_u"], "n_v": told["n_v"]})
    fold = DESIGN.run(finest)
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.meta["distance"]["mean"] <= distance
    assert fold.meta["distance"]["mean"] == pytest.approx(told["distance"], rel=1e-12)
    assert told["bases"] == told["n_u"] * told["n_v"]
    fewer = tried(params, told["n_u"] - 1, told["n_v"])
    assert not (fewer.is_sound and fewer.distance <= distance)


def test_the_closer_the_more_bases_about_by_the_square() -> None:
    far, near = (
        DESIGN.report("density", wanting("cylinder", distance=each))["bases"]
        for each in (0.018, 0.012)
    )
    assert 1.6 < near / far < 3.2  # (18 / 12)² = 2.25


def test_no_coarse_grid_of_any_aspect_does_with_fewer_bases() -> None:
    params = wanting("catenoid", distance=0.025)
    told = DESIGN.report("density", params)
    for n_v in range(1, 7):
        for n_u in range(3, (told["bases"] - 1) // n_v + 1):
            trial = tried(params, n_u, n_v)
            assert not (trial.is_sound and trial.distance <= 0.025), (n_u, n_v)


@pytest.mark.parametrize("height", [None, 300.0])
def test_facets_on_the_sheet_are_as_large_as_wanted(height: float | None) -> None:
    wanted = {"sheet_width": 500.0, "sheet_height": height, "smallest": 8.0}
    params = wanting("catenoid", **wanted)
    told = DESIGN.report("density", params)
    grid = {"n_u": told["n_u"], "n_v": told["n_v"]}
    fold = DESIGN.run(params.model_copy(update=grid))
    flat = fold.pattern.vertices
    wide, high = 500.0, height or 500.0
    w, h = np.ptp(flat, axis=0)
    scale = max(min(wide / w, high / h), min(wide / h, high / w))
    a, b, c = flat[fold.pattern.faces].transpose(1, 0, 2) * scale
    sides = [np.linalg.norm(x - y, axis=1) for x, y in ((a, b), (b, c), (c, a))]
    one, two = b - a, c - a
    doubled = np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    least = float((doubled / np.max(sides, axis=0)).min())
    assert least >= 8.0
    assert least == pytest.approx(told["smallest_mm"], rel=1e-6)
    more = tried(params, told["n_u"] + 1, told["n_v"])
    assert not (more.is_sound and more.smallest >= 8.0)


def test_a_smaller_sheet_takes_fewer_bases() -> None:
    small, large = (
        DESIGN.report("density", wanting("moebius", sheet_width=each, smallest=8.0))["bases"]
        for each in (250.0, 500.0)
    )
    assert 2 * small < large


def test_bases_along_a_closed_v_stay_even() -> None:
    search = Search(wanting("torus", distance=0.02, most_bases=100))
    chosen(search)
    assert len(search.made) >= 3
    assert all(n_v % 2 == 0 for _, n_v in search.made)


def test_what_cannot_be_had_is_said_with_the_closest_there_was() -> None:
    told = DESIGN.report("density", wanting("cylinder", distance=1e-3, most_bases=100))
    assert told["n_u"] is None
    assert "Nothing with 100 bases or fewer does" in told["advice"]
    assert "State wanted.distance" in DESIGN.report("density", wanting("cylinder"))["advice"]


def test_a_smallest_facet_without_a_sheet_is_refused() -> None:
    with pytest.raises(InvalidParameters, match="belong together"):
        wanting("cylinder", smallest=5.0)
