"""A pattern family of your own: an accordion of parallel pleats, half of them mountains."""

import numpy as np
from pydantic import Field

from foldmill import Count, CreasePattern, Design, Fold, Length, Params, hookimpl


class AccordionParams(Params):
    pleats: Count = Field(6, ge=2, le=100)
    """How many panels lie side by side."""
    width: Length = Field(25.0, ge=5, le=500)
    """Width of one panel."""
    height: Length = Field(180.0, ge=10, le=2000)
    """Length of every crease."""


def accordion(p: AccordionParams) -> Fold:
    x, n = np.arange(p.pleats + 1) * p.width, p.pleats + 1
    points = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + p.height])])
    rims = [[k + j, k + j + 1] for j in (0, n) for k in range(p.pleats)]
    letters = "B" * (2 * p.pleats + 1) + ("MV" * n)[: p.pleats - 1] + "B"
    return Fold(CreasePattern.from_lines(points, rims + [[k, k + n] for k in range(n)], letters))


@hookimpl
def foldmill_designs() -> list[Design[AccordionParams]]:
    return [Design("accordion", "Accordion of parallel pleats", AccordionParams, accordion)]
