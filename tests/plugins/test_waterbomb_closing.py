"""Odd and even numbers of bases, what closes and what cannot, and depths that suit the bases."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill.check import check
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.build import DEPTH, Build
from foldmill_plugins.waterbomb.depths import OTHERS, settled
from foldmill_plugins.waterbomb.topology import Topology

TUBE = {
    "kind": "expression",
    "x": "cos(v)",
    "y": "u",
    "z": "sin(v)",
    "u_start": "-2",
    "u_end": "2",
    "v_start": "0",
    "v_end": "2*pi",
    "v_closes": True,
}
"""A tube that closes along v and is open along u."""


def torus(n_u: int, n_v: int, **values: Any) -> dict[str, Any]:
    return {"surface": {"kind": "torus"}, "n_u": n_u, "n_v": n_v, **values}


@pytest.mark.parametrize("n_v", [3, 4, 5, 6])
def test_the_last_ring_falls_on_the_first_only_after_an_even_number_of_strips(n_v: int) -> None:
    graph = Topology(5, n_v, is_u_closed=True)
    ring = np.where(graph.is_centre, -1, graph.j % n_v)
    place = np.where(graph.is_centre, np.arange(len(graph.k)), ring * graph.width + graph.k)
    facets = np.bincount(place[graph.faces].ravel())
    met = set(facets[: graph.width].tolist())
    assert met == ({6} if n_v % 2 == 0 else {4, 8})  # mids upon mids, corners upon corners


@pytest.mark.parametrize(("n_u", "n_v"), [(40, 8), (40, 9), (41, 8), (41, 9)])
def test_a_torus_of_any_parity_is_sound_and_is_open_where_strips_are_odd(
    n_u: int, n_v: int
) -> None:
    fold = DESIGN.run(torus(n_u, n_v))
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert not check(fold).has_errors
    assert fold.folded is not None
    along = (n_v + 1) + n_v // 2
    assert len(fold.folded.seams) == along + (0 if n_v % 2 else 2 * n_u)


@pytest.mark.parametrize("kind", ["catenoid", "sphere", "cylinder", "vase"])
@pytest.mark.parametrize(("more_u", "more_v"), [(0, 1), (1, 0), (1, 1)])
def test_a_target_that_closes_along_u_does_so_with_odd_and_even_numbers(
    kind: str, more_u: int, more_v: int
) -> None:
    preset = DESIGN.presets[kind]
    size = {"n_u": preset.n_u + more_u, "n_v": preset.n_v + more_v}
    fold = DESIGN.run({"surface": {"kind": kind}, **size})
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.folded is not None
    assert len(fold.folded.seams) == size["n_v"] + 1 + size["n_v"] // 2


@pytest.mark.parametrize(("n_u", "n_v"), [(7, 10), (8, 10), (7, 11), (8, 11)])
def test_a_tube_that_closes_along_v_alone_is_sound_with_any_numbers(n_u: int, n_v: int) -> None:
    fold = DESIGN.run({"surface": TUBE, "n_u": n_u, "n_v": n_v})
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.folded is not None
    assert len(fold.folded.seams) == (0 if n_v % 2 else 2 * n_u + 1)


def test_an_open_torus_of_30_by_9_bases_is_sound_as_deep_as_it_has_room_for() -> None:
    fold = DESIGN.run(torus(30, 9))
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.meta["depth"] < DEPTH
    deep = DESIGN.run(torus(30, 9, depth=DEPTH))
    assert "self-intersecting" in deep.meta["status"]["verdicts"]
    assert deep.meta["feasibility"]["crowding"] > 1 > fold.meta["feasibility"]["crowding"]
    (said,) = [each for each in check(deep).findings if each.code == "feasibility"]
    assert "times as deep as their cells are high down there" in said.message


@pytest.mark.parametrize(("n_u", "n_v", "deeper"), [(36, 10, False), (45, 5, True)])
def test_a_depth_that_nobody_stated_is_one_that_does(n_u: int, n_v: int, deeper: bool) -> None:
    build = settled(DESIGN.validate(torus(n_u, n_v)))
    assert build.params.depth in OTHERS
    assert (build.params.depth > DEPTH) == deeper
    assert DESIGN.run(torus(n_u, n_v)).meta["status"]["verdicts"] == ["ok"]


@pytest.mark.parametrize("name", list(DESIGN.presets))
def test_a_preset_has_the_usual_depth_and_room_for_it(name: str) -> None:
    params = DESIGN.presets[name]
    assert settled(params).params == params
    assert Build(params).crowding < 1


@pytest.mark.parametrize("values", [{"depth": 0.3}, {"start": "closed-form"}])
def test_a_depth_or_start_that_is_stated_is_kept(values: dict[str, Any]) -> None:
    params = DESIGN.validate(torus(30, 9, **values))
    assert settled(params).params == params


def test_bases_too_narrow_for_any_depth_are_told_what_they_lack() -> None:
    fold = DESIGN.run(torus(20, 9))
    assert "self-intersecting" in fold.meta["status"]["verdicts"]
    (said,) = [each for each in check(fold).findings if each.code == "feasibility"]
    assert "More bases along u, or fewer along v" in said.message


def test_a_flat_target_leaves_as_much_room_below_as_above() -> None:
    flat = {"kind": "expression", "x": "u", "y": "v", "z": "0"}
    build = Build(DESIGN.validate({"surface": flat, "n_u": 5, "n_v": 5, "depth": 0.4}))
    assert build.crowding == pytest.approx(build.promise.deepest)
