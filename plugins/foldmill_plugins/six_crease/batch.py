"""Many tubes at once: from columns of parameters to strips for the kernels.

Only r_1 = L sin φ and β shape a form: L cos φ moves it along the axis, and where both L and φ vary
each (r_1, β) is computed once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.many import Task, has_slivers
from foldmill.axisymmetric.rows import Rows
from foldmill.batch import NOWHERE
from foldmill.kernels import Limits, Strips
from foldmill.tolerances import COINCIDENT_MM, ON_LINE
from foldmill_plugins.six_crease.params import SixCreaseParams

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

# Along the axis a strip starts at 0 here and at L cos φ there, so that rounding differs, and no
# squared half-chord is surely 0.
_LIMITS = Limits(snap_low=-1.0)


def prepare(rows: Rows) -> Task | None:
    """Return the strips of tubes without tabs; None where there are tabs."""
    base = rows.base
    assert isinstance(base, SixCreaseParams)
    if base.tab or rows.varies("tab"):
        return None
    numbers = list(base.points)
    y = rows.table([f"points.{i}.y" for i in numbers])
    first = _First.of(rows, y)
    paper = _paper(y, rows.of("w"))
    is_rising = (y[:, 2:] - y[:, :-2] > 2 * COINCIDENT_MM).all(axis=1)
    tall, wide = np.ptp(y, axis=1), 2 * rows.of("n") * rows.of("w")
    farthest = np.maximum(np.maximum(wide, np.abs(y).max(axis=1)), rows.of("L") + 2 * tall)
    start = first.start(np.radians(rows.of("beta")))
    count = len(next(iter(rows.columns.values())))
    return Task(
        Strips(
            rows.of("n").astype(np.int64),
            np.array(np.broadcast_to(start, (count, 4))),
            paper,
            rows.table([f"points.{i}.branch" for i in numbers[2:]]),
            is_first_on_l2=False,
        ),
        refused=np.broadcast_to(~is_rising, count),
        unsure=np.broadcast_to(has_slivers(paper, farthest) | first.is_at_bound, count),
        sheet=np.stack(np.broadcast_arrays(wide, tall), axis=1),
        first=1,
        shape=_shape(rows, first.r, count),
        limits=_LIMITS,
        lost=np.where(np.broadcast_to(first.is_too_long, count), 2, NOWHERE),
    )


@dataclass(frozen=True, eq=False)
class _First:
    """P_1, and the circle on which P_2 lies; one row for each configuration, or one for all."""

    r: Floats
    theta: Floats
    edge: Floats
    is_too_long: Flags
    is_at_bound: Flags

    @classmethod
    def of(cls, rows: Rows, y: Floats) -> _First:
        L, phi, theta = rows.of("L"), rows.of("phi"), np.pi / rows.of("n")
        sine = np.where((phi == 0) | (phi == 180), 0.0, np.sin(np.radians(phi)))
        edge = np.hypot(rows.of("w"), y[:, 1] - y[:, 0])
        with np.errstate(divide="ignore"):
            longest = edge / np.sin(theta) / sine  # L_b (Eq. 5.4)
        with np.errstate(invalid="ignore"):
            is_near = np.abs(longest - L) <= ON_LINE * L
        return cls(L * sine, theta, edge, longest < L, is_near & (L > 0))

    def start(self, beta: Floats) -> Floats:
        """Return P_1 and P_2 (n, 4) as r, z, r, z, mm, with P_1 at height 0."""
        s = self.r * np.sin(self.theta)
        radius = np.sqrt(np.maximum((self.edge - s) * (self.edge + s), 0.0))
        r = self.r * np.cos(self.theta) + radius * np.sin(beta)
        return np.stack(np.broadcast_arrays(self.r, 0.0, r, radius * np.cos(beta)), axis=1)


def _paper(y: Floats, w: Floats) -> Floats:
    """Return d, c, h and size of every triangle, (n, T − 2, 4) or (1, …)."""
    size = np.maximum(np.ptp(y, axis=1), w)[:, None]
    rises = y[:, 2:] - y[:, :-2], y[:, 1:-1] - y[:, :-2]
    return np.stack(np.broadcast_arrays(*rises, w[:, None], size), axis=2)


def _shape(rows: Rows, r: Floats, count: int) -> Floats | None:
    """Return what shapes the forms (n, k), where L and φ both vary."""
    if not (rows.varies("L") and rows.varies("phi")):
        return None
    others = [column for name, column in rows.columns.items() if name not in {"L", "phi", "taper"}]
    return np.stack([np.broadcast_to(each, count) for each in (r, *others)], axis=1)
