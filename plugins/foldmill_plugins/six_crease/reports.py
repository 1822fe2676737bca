"""Longer analyses of a tube, made when asked for: its freedoms, and whether it folds flat."""

from __future__ import annotations

from functools import partial
from typing import Any

from foldmill.axisymmetric import closing, tube
from foldmill.axisymmetric.tube import Sheet
from foldmill_plugins.six_crease import freedoms, solve
from foldmill_plugins.six_crease.along_arc import find_reach
from foldmill_plugins.six_crease.params import SixCreaseParams


def flat_foldability(params: SixCreaseParams) -> dict[str, Any]:
    """Report whether the open sheet folds flat along the arc; raises ImpossibleGeometry."""
    half = tube.half_wedge(params.n, solve.flat(params), solve.meridian(params))
    whole = tube.assemble(half)
    branches = {i - 1: point.branch for i, point in params.points.items() if i >= 3}
    places = partial(solve.meridians, params)
    front = -1 if Sheet.of(whole).is_inside_out else 1
    return closing.report(closing.Closing(whole, branches, places, 1, front))


def freedoms_of(params: SixCreaseParams) -> dict[str, Any]:
    """Report how freely sheet and tube move, how far P_1 may be, and how far the motion goes.

    Raises ImpossibleGeometry where the tube has no form.
    """
    solve.meridian(params)
    count, reach = len(params.points), find_reach(params)
    bound = solve.longest(params)
    return {
        "N": params.n,
        "T": count,
        "freedoms_open_sheet": freedoms.of_sheet(params.n, count),
        "freedoms_glued_tube": freedoms.of_tube(params.n),
        "r1_mm": params.L * solve.sine_of(params.phi),
        "L_mm": params.L,
        "L_b_mm": bound if bound < float("inf") else "none: point 1 is on the axis",
        "folding_rate_percent": 100 * reach[0],
        "stops": reach[1] or "nowhere: it folds flat",
    }


REPORTS = {"flat-foldability": flat_foldability, "freedoms": freedoms_of}
