"""Many configurations of one design at once: what becomes of each, in columns.

A design may offer ``batch`` beside ``generate``: a pure function from a base model and columns of
parameters to the outcomes of all rows. It must say of each row what generate and check would say.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidInput

Column = NDArray[np.float64]
"""(n,) values of one parameter, in the unit of its field; ``points.3.b`` is a column like any."""
TABLE = ("row", "outcome", "point", "region")
"""What stands beside the figures in a table of outcomes: no figure has such a name."""
NOWHERE = -1
"""In ``Outcomes.at``: the outcome has no point of its own."""


class Outcome(IntEnum):
    """What becomes of one configuration."""

    FREE = 0
    """It folds, and no facet passes through another."""
    PENETRATES = 1
    """It folds, but facets pass through each other on one side of the axis."""
    NO_CANDIDATE = 2
    """A point has no place in space: its circles do not meet."""
    CROSSES_AXIS = 3
    """Its radii have both signs: facets meet across the axis."""
    REFUSED = 4
    """The design refuses it for another reason: out of bounds, a gap too short, no free place."""


@dataclass(frozen=True, eq=False)
class Outcomes:
    """Outcomes of n configurations, row by row."""

    codes: NDArray[np.uint8]
    """(n,) values of Outcome."""
    at: NDArray[np.int32]
    """(n,) number i of the point that has no candidate; NOWHERE in all other rows."""
    figures: Mapping[str, Column] = field(default_factory=dict)
    """(n,) each, by names with a unit (``height_mm``); NaN where there is no folded form."""
    alone: int = 0
    """How many rows were generated and checked one by one: those take 10 ms each, others 1 µs."""

    def __post_init__(self) -> None:
        shapes = {"at": self.at.shape} | {name: one.shape for name, one in self.figures.items()}
        for name, shape in shapes.items():
            if shape != self.codes.shape:
                raise InvalidInput(
                    f"The column {name!r} has shape {shape}, the outcomes "
                    f"{self.codes.shape}: every column needs one value for each row."
                )

    def __len__(self) -> int:
        return len(self.codes)


def breaches(found: object, rows: int, taken: Iterable[str]) -> Iterator[str]:
    """Yield what a batch must not return for so many rows: "it returns list, not Outcomes".

    taken : names that no figure may have, beside those of TABLE.
    """
    if not isinstance(found, Outcomes):
        yield f"it returns {type(found).__name__}, not Outcomes"
        return
    if found.codes.shape != (rows,):
        yield f"it returns outcomes of shape {found.codes.shape} for {rows} rows"
        return
    yield from _wrong_types(found)
    unknown = np.flatnonzero(~np.isin(found.codes, list(Outcome)))
    if len(unknown):
        yield f"it gives row {unknown[0]} the code {found.codes[unknown[0]]}, which is no Outcome"
    for name in sorted({*TABLE, *taken} & set(found.figures)):
        yield f"it calls a figure {name!r}, which is the name of another column"


def _wrong_types(found: Outcomes) -> Iterator[str]:
    kinds = {"codes": (found.codes.dtype, "uint8"), "at": (found.at.dtype, "int32")}
    figures = {f"figure {name!r}": (one.dtype, "float64") for name, one in found.figures.items()}
    for name, (kind, wanted) in (kinds | figures).items():
        if kind != wanted:
            yield f"its {name} must be {wanted}, not {kind}"
