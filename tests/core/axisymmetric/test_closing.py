"""The report on folding flat along the arc: verdicts, what is left out, what the way shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from six_crease_oracle import random_design

from foldmill import Design, ImpossibleGeometry, Params
from foldmill.check.intersection import penetrations
from foldmill_plugins.rotational import DESIGN as ROTATIONAL
from foldmill_plugins.six_crease import DESIGN as SIX_CREASE
from foldmill_plugins.six_crease.along_arc import find_reach

SEVEN = list(SIX_CREASE.presets)[:7]


def report(design: Design[Any], params: Params) -> dict[str, Any]:
    return dict(design.report("flat-foldability", params))


@pytest.mark.parametrize("name", SEVEN)
def test_a_shape_that_is_known_to_fold_flat_passes(name: str) -> None:
    said = report(SIX_CREASE, SIX_CREASE.preset(name))
    assert (said["verdict"], said["limit_rule"]) == ("folds flat", "passes")
    assert said["why"] == (
        "Kawasaki and Maekawa hold in the limit, at each of 5 inner points. "
        "No facet passes through another at the 101 places looked at on the way."
    )
    assert [row["point"] for row in said["points"]] == [3, 4, 5, 6, 7]
    assert all(abs(row["M_minus_V"]) == 2 for row in said["points"])
    assert all(row["kawasaki_deg"] < 1e-11 for row in said["points"])


def test_the_interrupted_vase_fails_by_the_rule_and_on_its_way() -> None:
    said = report(SIX_CREASE, SIX_CREASE.preset("vase-interrupted"))
    assert (said["verdict"], said["limit_rule"]) == ("does not fold flat", "fails")
    assert "At point 5 mountains less valleys are 0 in the limit, not 2 or −2" in said["why"]
    assert said["why"].endswith(
        "At a folding rate of 6 % the form lies on both sides of its axis (point 7)."
    )


@pytest.mark.parametrize("name", ROTATIONAL.presets)
def test_the_centre_and_the_rim_are_left_out_of_a_rotational_form(name: str) -> None:
    params = ROTATIONAL.preset(name)
    said = report(ROTATIONAL, params)
    assert [row["point"] for row in said["points"]] == list(range(1, len(params.points) - 1))
    assert [row["folded"] + row["flat"] for row in said["points"]][:2] == [4, 6]


def test_what_passes_through_nothing_on_its_way_never_fails_the_rule() -> None:
    free = failed = 0
    for seed in range(80):
        params = random_design(seed)
        try:
            said = report(SIX_CREASE, params)
        except ImpossibleGeometry:
            continue
        if said["way_is_free"]:
            assert (said["limit_rule"], said["verdict"]) == ("passes", "folds flat"), seed
            assert find_reach(params)[0] == 1
            free += 1
        failed += said["limit_rule"] == "fails"
    assert min(free, failed) >= 5, (free, failed)


def test_passing_the_rule_is_not_enough() -> None:
    """Some forms obey it at every vertex, and facets that share no vertex still meet."""
    for seed in range(600):
        params = random_design(seed)
        try:
            said = report(SIX_CREASE, params)
        except ImpossibleGeometry:
            continue
        if said["limit_rule"] == "passes" and "pass through each other" in said["why"]:
            break
    else:
        pytest.fail("no such form among them")
    assert said["verdict"] == "does not fold flat"
    rate = float(said["why"].split("rate of ")[1].split(" %")[0]) / 100
    fold = SIX_CREASE.run(params)
    motion = fold.motions["along-arc"]
    before, there = motion.at(max(rate - 0.01, 0)), motion.at(rate)
    pattern = fold.pattern
    assert len(penetrations(there, pattern.edges, pattern.faces))
    assert rate == 0 or not len(penetrations(before, pattern.edges, pattern.faces))


def test_a_point_that_turns_freely_stops_the_way_at_its_start() -> None:
    points = {i: {"y": y} for i, y in enumerate((0, 0, 30, 40), start=1)}
    points[3]["gamma"] = 120
    params = SIX_CREASE.validate(
        {"n": 6, "L": 10 / np.tan(np.pi / 6), "phi": 90, "beta": 90, "points": points}
    )
    said = report(SIX_CREASE, params)
    assert said["why"] == (
        "There is no inner vertex to judge. "
        "At a folding rate of 0 % point 3 has no place, or turns freely."
    )
