"""What a fit changed: every measure of closeness before and after it, and the folds it left."""

from __future__ import annotations

from typing import Any

import numpy as np

from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.closeness import measures
from foldmill_plugins.waterbomb.depths import settled
from foldmill_plugins.waterbomb.fit import went
from foldmill_plugins.waterbomb.hinge import Creases
from foldmill_plugins.waterbomb.params import WaterbombParams


def report(params: WaterbombParams) -> dict[str, Any]:
    """Report the form before and after a fit, made even where the parameters leave it off.

    Raises ImpossibleGeometry where there is no base mesh.
    """
    build = settled(params.model_copy(update={"fit": params.fit.model_copy(update={"on": True})}))
    before = measures(build, build.plain.points)
    after = measures(build, build.developed.points)
    return {
        "before": before,
        "after": after,
        "d_ratio": after["vertices_mean"] / before["vertices_mean"],
        "reverse_ratio": after["reverse_mean"] / before["reverse_mean"],
        "folds_before_deg": _folds(build, build.plain.points),
        "folds_after_deg": _folds(build, build.developed.points),
        "e_total_deg": build.developed.error,
        **({} if build.fit is None else went(build.fit)),
    }


def _folds(build: Build, points: Any) -> list[float]:
    """Return the least and the greatest fold, deg; negative where a crease folds wrongly."""
    folds = np.degrees(Creases.of(build.topology, build.side).folds(points))
    return [float(folds.min()), float(folds.max())]
