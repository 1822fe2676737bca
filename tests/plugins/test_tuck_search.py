"""The automatic placement of flaps finds a place wherever there is one: a benchmark's sample."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Literal

import numpy as np
import pytest

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.rosette import HalfWedge
from foldmill.check import check
from foldmill.check.intersection import penetrations
from foldmill_plugins.tuck import DESIGN, blanks, clearance, corners, flaps, seams, search
from foldmill_plugins.tuck.generate import generate
from foldmill_plugins.tuck.params import Tuck, TuckParams


def _load() -> ModuleType:
    path = Path(__file__).parents[2] / "benchmarks" / "tucks.py"
    spec = importlib.util.spec_from_file_location("tucks_benchmark", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


TUCKS = _load()


@cache
def doubles() -> tuple[TuckParams, ...]:
    """Return edits with two points off one line; making them takes a while."""
    return tuple(TUCKS.double(25))


def surface(params: TuckParams) -> tuple[blanks.Blank, clearance.Surroundings]:
    solved = strip.solve(params.n, params.phi, dict(params.points))
    (blank,) = blanks.find(solved)
    form = rosette.assemble(HalfWedge.of(solved))
    return blank, clearance.Surroundings.of(params.n, form.spatial[form.faces])


def any_free(params: TuckParams, tries: int) -> bool:
    """Tell whether any of many flaps, spread over all shares and sides, is free."""
    blank, around = surface(params)
    k = len(blank.points)
    shares = np.random.default_rng(7).uniform(0, 1, (tries, k))
    for last in (1.0, -1.0):
        sides = np.ones((tries, k))
        sides[:, -1] = last
        found = corners.place(blank, shares, sides, [None] * k)
        found = found.chosen(seams.sides(blank, found) != seams.TORN)
        if (clearance.depths(blank, found, around) == 0).any():
            return True
    return False


def refused(edits: Iterator[TuckParams]) -> Iterator[tuple[TuckParams, str]]:
    for params in edits:
        try:
            generate(params)
        except ImpossibleGeometry as error:
            yield params, str(error)


def test_every_single_blank_with_a_free_place_is_solved() -> None:
    left = list(refused(TUCKS.single(60)))
    assert 60 - len(left) >= 25
    for params, reason in left:
        assert "too short" in reason or not any_free(params, 3000)


def test_every_blank_of_two_points_with_a_free_place_is_solved() -> None:
    left = list(refused(iter(doubles())))
    assert len(doubles()) - len(left) >= 5
    for params, reason in left:
        assert "too short" in reason or not any_free(params, 1500)


def test_what_is_found_is_a_sheet_without_a_finding() -> None:
    solved = 0
    for params in doubles():
        try:
            fold = generate(params)
        except ImpossibleGeometry:
            continue
        solved += 1
        assert not [str(finding) for finding in check(fold).findings]
    assert solved >= 5


def test_the_same_parameters_give_the_same_flaps() -> None:
    params = DESIGN.preset("basket-n10").model_copy(update={"tucks": ()})
    one, two = (generate(params) for _ in range(2))
    assert (one.pattern.vertices == two.pattern.vertices).all()


@pytest.mark.parametrize("seed", [0, 1])
def test_the_quick_screen_agrees_with_the_exact_rule(seed: int) -> None:
    rng = np.random.default_rng(seed)
    free = 0
    for params in (*TUCKS.single(6, seed=10 + seed), *doubles()[6 * seed : 6 * seed + 6]):
        try:
            blank, around = surface(params)
        except ImpossibleGeometry:
            continue
        half, made = flaps.add(
            HalfWedge.of(strip.solve(params.n, params.phi, dict(params.points))), [blank]
        )
        rose = rosette.assemble(half)
        k = len(blank.points)
        found = corners.place(blank, rng.uniform(0, 1, (20, k)), np.ones((20, k)), [None] * k)
        found = found.chosen(found.exists & (seams.sides(blank, found) != seams.TORN))
        for row, depth in enumerate(clearance.depths(blank, found, around)):
            placed = search.Placed(blank, found.chosen(np.array([row])), 1)
            form = flaps.put(rose, made, [placed])
            pairs = penetrations(form.spatial, form.edges, form.faces)
            assert (depth == 0) == (not len(pairs))
            free += depth == 0
    assert free > 10


@pytest.mark.parametrize("side", ["inside", "outside"])
def test_flaps_lie_where_they_are_asked_to_lie(side: Literal["inside", "outside"]) -> None:
    known = re.compile(f"too short|cannot lie {side}: the shape allows it|wherever its corner lies")
    solved = 0
    for params in TUCKS.single(40):
        wish = params.model_copy(update={"tucks": (Tuck(point=4, lies=side),)})
        try:
            (told,) = generate(wish).meta["tucks"]
        except ImpossibleGeometry as error:
            refusal = str(error)
        else:
            refusal, solved = "", solved + 1
            assert told["lies"] == side
        assert not refusal or known.search(refusal)
    assert solved > 0


def test_evenly_spread_shares_leave_no_large_gap() -> None:
    spread = search.evenly(1024, 2)
    cells = np.unique((spread * 16).astype(int), axis=0)
    assert len(cells) == 16 * 16
