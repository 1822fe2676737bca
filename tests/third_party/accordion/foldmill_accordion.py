"""An accordion of parallel pleats, by somebody who has only the public face of foldmill."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from foldmill import Count, CreasePattern, Design, Fold, Length, Params, hookimpl


class AccordionParams(Params):
    """Panels side by side."""

    pleats: Count = Field(6, ge=2, le=100)
    """How many panels lie side by side."""
    width: Length = Field(25.0, ge=5, le=500)
    """Width of one panel."""
    height: Length = Field(180.0, ge=10, le=2000)
    """Length of every crease."""


def accordion(params: AccordionParams) -> Fold:
    """Return mountains and valleys in turn."""
    x, n = np.arange(params.pleats + 1) * params.width, params.pleats + 1
    low, high = np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + params.height])
    rims = [[k + j, k + j + 1] for j in (0, n) for k in range(params.pleats)]
    letters = "B" * (2 * params.pleats + 1) + ("MV" * n)[: params.pleats - 1] + "B"
    across = [[k, k + n] for k in range(n)]
    return Fold(CreasePattern.from_lines(np.vstack([low, high]), rims + across, letters))


DESIGN = Design(
    slug="accordion",
    title="Accordion of parallel pleats",
    params=AccordionParams,
    generate=accordion,
    presets={"fan": AccordionParams(pleats=12, width=12)},
)


@hookimpl
def foldmill_designs() -> list[Design[AccordionParams]]:
    """Offer the family."""
    return [DESIGN]
