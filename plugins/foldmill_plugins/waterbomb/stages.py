"""From the target to the form, for pictures as Figs. 6.7 to 6.9: the target, the base mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill import Stage
from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.depths import settled
from foldmill_plugins.waterbomb.generate import from_zero, mm_per_unit
from foldmill_plugins.waterbomb.params import WaterbombParams

Floats = NDArray[np.float64]

FINE, LINES = 36, 12
"""Parts of the target along u and along v, and lines drawn upon it."""


def stages(params: WaterbombParams) -> tuple[Stage, ...]:
    """Return the target and the base mesh, as large and as turned as the form.

    Raises ImpossibleGeometry where there is no form.
    """
    build = settled(params)
    scale = mm_per_unit(build)
    faces = build.topology.faces
    is_drawn = np.ones(faces.shape, bool)
    base = Stage("base mesh", scale * from_zero(build, build.base), faces, is_drawn)
    return tuple(_front(build, stage) for stage in (_target(build, scale), base))


def _target(build: Build, scale: float) -> Stage:
    share = np.linspace(0, 1, FINE + 1)
    u, v = (low + share * (high - low) for low, high in (build.surface.u, build.surface.v))
    points = build.surface.points(np.repeat(u, FINE + 1), np.tile(v, FINE + 1))
    number = np.arange((FINE + 1) ** 2).reshape(FINE + 1, FINE + 1)
    a, b, c, d = (
        number[i : i + FINE, j : j + FINE].ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))
    )
    faces = np.vstack([np.column_stack([a, b, c]), np.column_stack([c, d, a])])
    row, column = (each.ravel() for each in np.indices((FINE, FINE)))
    step, none = FINE // LINES, np.zeros(len(a), bool)
    low = np.column_stack([column % step == 0, (row + 1) % step == 0, none])
    high = np.column_stack([(column + 1) % step == 0, row % step == 0, none])
    return Stage("target", scale * from_zero(build, points), faces, np.vstack([low, high]))


def _front(build: Build, stage: Stage) -> Stage:
    """Return a stage with the front where the form has it: opposite to the centres."""
    if build.side > 0:
        return stage
    drawn = stage.is_drawn[:, [1, 0, 2]]
    return Stage(stage.name, stage.vertices, stage.faces[:, ::-1], drawn)
