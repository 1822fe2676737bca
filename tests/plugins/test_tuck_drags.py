"""However little a point is moved, paper keeps its lengths."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import FoldmillError
from foldmill.check import isometry
from foldmill.handle import Space
from foldmill_plugins.tuck import DESIGN


@pytest.mark.parametrize("preset", ["stool-n4", "stool-n6", "stool-n8"])
def test_a_hair_of_a_drag_makes_no_paper_longer(preset: str) -> None:
    params, rng, tried = DESIGN.preset(preset), np.random.default_rng(7), 0
    for handle in DESIGN.run(params).handles:
        if handle.space is not Space.FOLDED:
            continue
        for size in np.repeat([1e-4, 1e-2, 1.0], 3):
            step = size * rng.normal(size=3)
            try:
                fold = DESIGN.run(handle.drag(params, handle.position + step))
            except FoldmillError:
                continue
            tried += 1
            assert isometry(fold).findings == (), (handle.name, step)
    assert tried > 20
