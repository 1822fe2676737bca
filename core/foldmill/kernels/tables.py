"""What goes into the kernels and what comes out: plain arrays, one row for each configuration."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidInput
from foldmill.tolerances import AXIS_SURE, PENETRATION, SNAP_EPSILONS, SNAP_SURE, TURN_SURE

Floats = NDArray[np.float64]


class CODES(IntEnum):
    """What a kernel says of a strip: the first four as in ``foldmill.batch.Outcome``."""

    FREE = 0
    PENETRATES = 1
    NO_CANDIDATE = 2
    CROSSES_AXIS = 3
    TURNS_FREELY = 4
    """Two circles are one, or nearly: a direction γ decides, which the kernels do not know."""
    UNSETTLED = 5
    """So near a border between outcomes that rounding may decide: ask generate and check."""


@dataclass(frozen=True, eq=False)
class Strips:
    """n strips of K points each: points 0 and 1 in space, and the paper of all later ones.

    Where all rows share one paper, order or choice of branches, the array has one row.
    """

    order: NDArray[np.int64]
    """(n,) or (1,) N."""
    start: Floats
    """(n, 4) the first two points as r, z, r, z; mm."""
    paper: Floats
    """(n, K − 2, 4) or (1, …) d, c, h and size of the triangles (k−2, k−1, k), k = 2 … K−1; mm."""
    branches: Floats
    """(n, K − 2) or (1, …) b = ±1."""
    is_first_on_l2: bool
    """Whether points 0, 2, 4 … are in plane Π2 (azimuth Θ), and the others in Π1 (azimuth 0)."""

    def __post_init__(self) -> None:
        rows, steps = len(self.start), self.paper.shape[1]
        shared = {
            "order": (self.order, ()),
            "paper": (self.paper, (steps, 4)),
            "branches": (self.branches, (steps,)),
        }
        for name, (array, rest) in shared.items():
            if array.shape[1:] != rest or len(array) not in {1, rows}:
                raise InvalidInput(
                    f"{name} has the shape {array.shape}; {rows} strips of {steps + 2} points "
                    f"need {(rows, *rest)} or {(1, *rest)}."
                )

    def __len__(self) -> int:
        return len(self.start)

    def take(self, rows: NDArray[np.intp]) -> Strips:
        """Return some of the strips."""
        shared = {name: getattr(self, name) for name in ("order", "paper", "branches")}
        picked = {name: one[rows] if len(one) > 1 else one for name, one in shared.items()}
        return replace(self, start=self.start[rows], **picked)


@dataclass(frozen=True, eq=False)
class Verdicts:
    """What becomes of n strips."""

    codes: NDArray[np.uint8]
    """(n,) values of CODES."""
    at: NDArray[np.int32]
    """(n,) the point k without a place, or at which it is unsettled; -1 elsewhere."""
    extents: Floats
    """(n, 3) x, y and z of the whole form's box, mm; NaN where there is no form."""

    @classmethod
    def empty(cls, count: int) -> Verdicts:
        """Return room for ``count`` rows."""
        at = np.full(count, -1, np.int32)
        return cls(np.zeros(count, np.uint8), at, np.full((count, 3), np.nan))


@dataclass(frozen=True)
class Limits:
    """The tolerances of a kernel. They are arguments: a compiled function would keep old ones."""

    penetration: float = PENETRATION
    snap: float = SNAP_EPSILONS * float(np.finfo(float).eps)
    snap_low: float = SNAP_SURE[0]
    """In ``snap``: a squared half-chord below it is 0, whatever rounding did."""
    snap_high: float = SNAP_SURE[1]
    """In ``snap``: one above it is not 0, whatever rounding did."""
    axis: float = AXIS_SURE
    turn: float = TURN_SURE

    def as_row(self) -> Floats:
        """Return them as the kernels take them."""
        snaps = (self.snap, self.snap_low, self.snap_high)
        return np.array((self.penetration, *snaps, self.axis, self.turn))


def wheels(orders: NDArray[np.int64], is_first_on_l2: bool) -> Floats:
    """Return (u, 10) for orders N (u,): cos and sin of Θ and of Θ/2, and how far copies reach.

    The last six: largest cos, smallest cos and largest sin among the azimuths of all copies of the
    points 0, 2, 4 …, then of the points 1, 3, 5 ….
    """
    rows = []
    for order in orders.tolist():
        theta = np.pi / order
        turns = 2 * theta * np.arange(order)
        reach = [
            (np.cos(a).max(), np.cos(a).min(), np.sin(a).max()) for a in (turns, turns + theta)
        ]
        first, second = reach[::-1] if is_first_on_l2 else reach
        half = theta / 2
        rows.append([np.cos(theta), np.sin(theta), np.cos(half), np.sin(half), *first, *second])
    return np.array(rows).reshape(-1, 10)


def stretch(spots: Floats, spin: Floats) -> Floats:
    """Return the box (n, 3) of all copies of points (2, m, K) as r and z, mm.

    spin : (k, 10) rows of wheels; n is the larger of m and k, the other may be 1.
    """
    r, z = spots
    reach = np.stack([spin[:, [4, 5, 6]], spin[:, [7, 8, 9]]], axis=1)
    reach = reach[:, np.arange(r.shape[1]) % 2]
    most, least, side = (r * reach[:, :, j] for j in range(3))
    x = np.maximum(most, least).max(axis=1) - np.minimum(most, least).min(axis=1)
    sides = x, 2 * np.abs(side).max(axis=1), np.ptp(z, axis=1)
    return np.stack(np.broadcast_arrays(*sides), axis=1)
