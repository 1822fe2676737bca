"""A handle lets a page drag any point of any family, and keeps points away that are none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill import Design, InvalidParameters
from foldmill.handle import Handle
from foldmill_plugins.rotational import DESIGN as BOWL
from foldmill_plugins.six_crease import DESIGN as TUBE
from foldmill_plugins.tuck import DESIGN as STOOL

FAMILIES: tuple[Design[Any], ...] = (BOWL, TUBE, STOOL)
HANDLES = [
    pytest.param(design, handle, id=f"{design.slug}-{handle.name}")
    for design in FAMILIES
    for handle in design.run(design.params()).handles
]


@pytest.mark.parametrize(("design", "handle"), HANDLES)
def test_a_point_that_is_none_is_refused_by_every_handle(
    design: Design[Any], handle: Handle
) -> None:
    size, params = len(handle.position), design.params()
    for point in (
        np.full(size, np.nan),
        np.full(size, np.inf),
        np.zeros(size + 1),
        np.zeros(0),
        None,
        "here",
    ):
        with pytest.raises(InvalidParameters, match=f"handle {handle.name} is dragged to"):
            handle.drag(params, point)  # type: ignore[arg-type]


@pytest.mark.parametrize(("design", "handle"), HANDLES)
def test_a_point_far_away_gives_parameters_or_a_sentence(
    design: Design[Any], handle: Handle
) -> None:
    for far in (1e6, -1e6, 1e300):
        try:
            dragged = handle.drag(design.params(), handle.position + far)
        except InvalidParameters:
            continue
        assert design.validate(dragged.model_dump()) == dragged
