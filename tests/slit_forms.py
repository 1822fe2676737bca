"""Rotational forms with and without a slit, made once per test process."""

from __future__ import annotations

from functools import cache

import numpy as np

from foldmill import Fold
from foldmill_plugins.rotational import DESIGN

PRESETS = tuple(DESIGN.presets)
FREE = ("lampshade-n12", "star-n6")
"""Those that fold flat along the arc."""


@cache
def form(name: str, *, slit: bool) -> Fold:
    return DESIGN.run(DESIGN.preset(name).model_dump() | {"slit": slit})


def space(fold: Fold) -> np.ndarray:
    assert fold.folded is not None
    return fold.folded.vertices
