"""Six-crease tubes of ten wedges and nine points, as made for the tests of tabs and overlaps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill import Fold
from foldmill_plugins.six_crease import DESIGN

WHOLE, FACES = 94, 140
"""Vertices and facets of such a tube with neither tabs nor an overlap."""
SHAPES = pytest.mark.parametrize("name", DESIGN.presets)


def closed_by(seam: str, name: str, width: float, taper: float = 30, **values: Any) -> Fold:
    """Return a preset with tabs or an overlap of this width, mm, and taper, degrees."""
    stated = {"tab": width, "taper": taper, "seam": seam, **values}
    return DESIGN.run(DESIGN.preset(name).model_dump() | stated)


def space(fold: Fold) -> np.ndarray:
    """Return where the vertices are in space."""
    assert fold.folded is not None
    return fold.folded.vertices
