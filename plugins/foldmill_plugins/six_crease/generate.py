"""From parameters to a fold: solve the strip, set it side by side, put tabs on its seam."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold, Symmetry
from foldmill.axisymmetric import closed, overlap, tabs, tube
from foldmill.axisymmetric.overlap import Overlap
from foldmill.axisymmetric.tabs import Tabs
from foldmill.axisymmetric.tube import Glued, Sheet, Tube
from foldmill.motion import Motion
from foldmill_plugins.six_crease import freedoms, solve
from foldmill_plugins.six_crease.along_arc import along_arc
from foldmill_plugins.six_crease.handles import handles
from foldmill_plugins.six_crease.params import SixCreaseParams


def generate(params: SixCreaseParams) -> Fold:
    """Return the fold; raises ImpossibleGeometry where a point or a tab has no place."""
    places = solve.meridian(params)
    half = tube.half_wedge(params.n, solve.flat(params), places)
    whole = tube.assemble(half)
    glued = _glued(params, whole)
    sheet = glued.sheet if glued else Sheet.of(whole)
    pattern, form = sheet.finish(_closed_signs(whole))
    motion = along_arc(params, whole, glued)
    # Tabs are at one seam only, so that a form with tabs is not the same when it is turned.
    symmetry = Symmetry(params.n, np.arange(len(half.faces)), half.one_sided)
    return Fold(
        pattern,
        form,
        None if glued else symmetry,
        {motion.name: motion},
        handles(params, places, sheet.is_inside_out),
        _facts(params, motion, glued),
    )


def _glued(params: SixCreaseParams, whole: Tube) -> Glued | None:
    if not params.tab:
        return None
    if params.seam == "overlap":
        return overlap.add(whole, params.tab, params.taper)
    return tabs.add(Sheet.of(whole), params.tab, params.taper)


def _closed_signs(whole: Tube) -> NDArray[np.intp]:
    """Return the signs of the tube's edges that close to ±180 as a point reaches the axis."""
    stated = closed.off_axis(whole)
    return np.array([stated.get((int(a), int(b)), 0) for a, b in whole.edge_origins], np.intp)


def _facts(params: SixCreaseParams, motion: Motion, glued: Glued | None) -> dict[str, Any]:
    return {
        "freedoms": {
            "open sheet": freedoms.of_sheet(params.n, len(params.points)),
            "glued tube": freedoms.of_tube(params.n),
        },
        "along-arc": {"folding_rate": 100 * motion.reach, "stops": motion.reason},
        "tabs": len(glued.hosts) // 2 if isinstance(glued, Tabs) else 0,
        "overlap": params.tab if isinstance(glued, Overlap) else 0.0,
    }
