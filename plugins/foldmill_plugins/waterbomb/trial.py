"""One number of bases tried: how close it comes, how small its facets are, whether it is sound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry
from foldmill_plugins.waterbomb.barrier import altitudes
from foldmill_plugins.waterbomb.contact import Clashes
from foldmill_plugins.waterbomb.depths import settled
from foldmill_plugins.waterbomb.distance import Target
from foldmill_plugins.waterbomb.hinge import Creases
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.simple import is_simple
from foldmill_plugins.waterbomb.unfold import unfold

Floats = NDArray[np.float64]

SLIVER = 10.0
"""Longest edge in shortest ones from which a form has slivers: many narrow bases come close to a
target and cannot be cut."""


@dataclass(frozen=True)
class Trial:
    """A tessellation of n_u × n_v bases."""

    n_u: int
    n_v: int
    distance: float
    """Mean distance of the vertices, as a share of the target's diagonal."""
    smallest: float
    """mm. Least altitude of a facet on the sheet that is wanted; without one, in target units."""
    is_sound: bool
    """Developable, folded as a waterbomb, free of slivers, not passing through itself, and simple
    when flat."""

    @property
    def bases(self) -> int:
        """How many there are."""
        return self.n_u * self.n_v


def tried(params: WaterbombParams, n_u: int, n_v: int) -> Trial:
    """Return what becomes of the parameters with n_u × n_v bases; a failure is not sound."""
    build = settled(params.model_copy(update={"n_u": n_u, "n_v": n_v}))
    try:
        found = build.developed
    except ImpossibleGeometry:
        return Trial(n_u, n_v, np.inf, 0.0, False)
    if not found.is_converged:
        return Trial(n_u, n_v, np.inf, 0.0, False)
    points, target = found.points, Target.of(build.surface)
    cut = build.topology.opened()
    flat = unfold(cut, points[build.topology.origin])
    ends = points[build.topology.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    folds = Creases.of(build.topology, build.side).folds(points)
    clashes = Clashes.of(build.topology, is_symmetric=build.is_symmetric).pairs(points)
    return Trial(
        n_u,
        n_v,
        float(target.distances(points).mean() / target.diagonal),
        float(altitudes(points, build.topology.faces)[0].min()) * scale_on(params, flat),
        bool(folds.min() > 0)
        and bool(lengths.max() <= SLIVER * lengths.min())
        and not len(clashes)
        and is_simple(cut, flat),
    )


def scale_on(params: WaterbombParams, flat: Floats) -> float:
    """Return mm per unit at which flat places (V, 2) fill the wanted sheet, either way round."""
    wide = params.wanted.sheet_width
    if wide is None:
        return 1.0
    high = params.wanted.sheet_height or wide
    width, height = np.ptp(flat, axis=0)
    return float(max(min(wide / width, high / height), min(high / width, wide / height)))
