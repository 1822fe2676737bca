"""Many rosettes of a strip at once, all points on their lines: from columns to strips."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.many import Task, has_slivers
from foldmill.axisymmetric.rows import Rows
from foldmill.design import Params
from foldmill.kernels import Strips
from foldmill.kernels.tables import stretch, wheels
from foldmill.tolerances import ON_LINE, TURN_SURE

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

PLAIN = {"n", "phi", "points"}
"""The parameters that shape a rosette."""


def prepare(rows: Rows) -> Task | None:
    """Return the strips of rosettes; None where the model holds more than PLAIN and it is in use.

    The base has ``n``, ``phi`` (deg) and ``points`` (LinePoint by number), all in use.
    """
    if not _is_plain(rows):
        return None
    numbers = rows.within("points")
    a = rows.table([f"points.{i}.a" for i in numbers])
    a = np.hstack([np.zeros((len(a), 1)), a])
    orders, phi = rows.of("n").astype(np.int64), rows.of("phi")
    theta = (np.pi / orders)[:, None]
    paper = _paper(a, theta)
    is_inwards = (paper[..., 0] <= -ON_LINE * paper[..., 3]).any(axis=1)
    is_upright = (np.abs(paper[..., 1]) <= TURN_SURE * paper[..., 3]).any(axis=1)
    count = len(next(iter(rows.columns.values())))
    return Task(
        Strips(
            orders,
            np.array(np.broadcast_to(_start(a, phi), (count, 4))),
            paper,
            rows.table([f"points.{i}.branch" for i in numbers[1:]]),
            is_first_on_l2=True,
        ),
        refused=np.broadcast_to(is_inwards, count),
        # An upright point turns freely at 90°, and the motion that opens the form needs its γ.
        unsure=np.broadcast_to(is_upright | has_slivers(paper, a.max(axis=1)), count),
        sheet=_sheet(a, orders),
        first=0,
    )


def _is_plain(rows: Rows) -> bool:
    """Tell whether all other parameters are as they come without a wish."""
    base = rows.base
    others = set(type(base).model_fields) - PLAIN
    is_varied = any(name.split(".")[0] in others for name in rows.columns)
    return not is_varied and all(
        getattr(base, name) == _default(base, name) for name in sorted(others)
    )


def _default(base: Params, name: str) -> object:
    return type(base).model_fields[name].get_default(call_default_factory=True)


def _paper(a: Floats, theta: Floats) -> Floats:
    """Return d, c, h and size of every triangle, (n, T − 1, 4) or (1, …)."""
    on_l2 = np.arange(a.shape[1]) % 2 == 0
    farthest = a * np.where(on_l2, np.maximum(np.cos(theta), np.sin(theta)), 1.0)
    size = np.maximum.accumulate(farthest, axis=1)[:, 2:]
    middle = a[:, 1:-1]
    c, h = middle * np.cos(theta) - a[:, :-2], middle * np.sin(theta)
    return np.stack(np.broadcast_arrays(a[:, 2:] - a[:, :-2], c, h, size), axis=2)


def _start(a: Floats, phi: Floats) -> Floats:
    """Return P_0 and P_1 (n, 4) as r, z, r, z, mm; exact at 0, 90 and 180 degrees."""
    tilt = np.radians(phi)
    sine = np.where((phi == 0) | (phi == 180), 0.0, np.sin(tilt))
    cosine = np.where(phi == 90, 0.0, np.cos(tilt))
    spots = 0.0, 0.0, a[:, 1] * sine, a[:, 1] * cosine
    return np.stack(np.broadcast_arrays(*spots), axis=1)


def _sheet(a: Floats, orders: NDArray[np.int64]) -> Floats:
    kinds, kind = np.unique(orders, return_inverse=True)
    spin = wheels(kinds, is_first_on_l2=True)[kind.reshape(-1)]
    return stretch(np.stack([a, np.zeros_like(a)]), spin)[:, :2]
