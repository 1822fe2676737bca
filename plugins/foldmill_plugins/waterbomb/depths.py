"""How deep bases are where nobody says so: as usual, or as deep as it takes.

A torus of 30 × 9 bases passes through itself at the usual depth and is sound at a lesser one; one
of 45 × 5 folds the wrong way at the usual depth and the right way at a greater one.
"""

from __future__ import annotations

from foldmill import ImpossibleGeometry
from foldmill_plugins.waterbomb.build import MANY, Build
from foldmill_plugins.waterbomb.contact import Clashes
from foldmill_plugins.waterbomb.hinge import Creases
from foldmill_plugins.waterbomb.params import WaterbombParams

OTHERS = (0.25, 0.4, 0.2, 0.5)
"""Depths tried in this order where the usual one does not do, the nearest to it first."""


def settled(params: WaterbombParams) -> Build:
    """Return the build of the parameters, with another depth where that is what it takes.

    Only where neither depth nor start is stated and the search ends in a form that folds the wrong
    way or passes through itself though flatness is possible; where no depth does, with the usual
    one. A search that fails and a large form without symmetry, whose trials take long, stay as they
    are.
    """
    build = Build(params)
    is_stated = params.depth is not None or params.start != "auto"
    is_large = params.n_u * params.n_v > MANY and not build.is_symmetric
    if is_stated or is_large or not build.promise.is_feasible:
        return build
    if not build.plain.is_converged or is_sound(build):
        return build
    others = (Build(params.model_copy(update={"depth": depth})) for depth in OTHERS)
    return next(filter(is_sound, others), build)


def is_sound(build: Build) -> bool:
    """Tell whether a search ends in a form that folds as a waterbomb, clear of itself."""
    try:
        found = build.plain
    except ImpossibleGeometry:
        return False
    if (
        not found.is_converged
        or Creases.of(build.topology, build.side).folds(found.points).min() <= 0
    ):
        return False
    clashes = Clashes.of(build.topology, is_symmetric=build.is_symmetric)
    return not len(clashes.pairs(found.points))
