"""How the part lies on its blank, and the blank on its carrier."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.spatial import ConvexHull

from foldmill_fabricate.errors import DoesNotFit
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Placement, Sheet
from foldmill_fabricate.sheet import turned

Floats = NDArray[np.float64]

_STEP = 0.5
"""deg between the rotations tried first; the best of them is then refined."""
ROOMY = 30.0
"""mm beside the part on every side that leave room for holes and hands: then it is not turned."""


def lay_blank(machine: Machine, blank: tuple[float, float], carrier: tuple[float, float]) -> Sheet:
    """Centre the blank between the carrier's margins.

    Raises DoesNotFit with the missing millimetres.
    """
    (width, height), (across, along) = blank, carrier
    bed = machine.bed
    left, lead, right, trail = bed.margins
    for name, need, room in (
        ("carrier is", across, bed.width),
        ("carrier is", along, bed.length),
        ("blank and the margins are", width + left + right, across),
        ("blank and the margins are", height + lead + trail, along),
    ):
        if need > room:
            raise DoesNotFit(
                f"The {name} {need:g} mm, but {machine.slug} has {room:g} mm there: "
                f"{need - room:g} mm too much. Take a smaller blank or another machine."
            )
    return Sheet(
        width=width,
        height=height,
        carrier_width=across,
        carrier_height=along,
        dx=left + (across - left - right - width) / 2,
        dy=lead + (along - lead - trail - height) / 2,
    )


def place(points: Floats, sheet: Sheet, clearance: float) -> Placement:
    """Centre the part (n, 2) mm on the blank, turned where that is needed to give it room.

    Raises DoesNotFit with the missing millimetres and the smallest blank that works.
    """
    hull = points[ConvexHull(points).vertices]

    def excess(degrees: float) -> float:
        width, height = np.ptp(turned(hull, degrees), axis=0)
        return float(max(width - sheet.width, height - sheet.height))

    angle = 0.0 if excess(0.0) <= -2 * ROOMY else _best_angle(excess)
    missing = excess(angle) + 2 * clearance
    spots = turned(hull, angle)
    width, height = np.ptp(spots, axis=0)
    if missing > 0:
        need = [float(np.ceil((side + 2 * clearance) * 10) / 10) for side in (width, height)]
        raise DoesNotFit(
            f"The part does not fit on a {sheet.width:g} × {sheet.height:g} mm blank however it is "
            f"turned: {missing:.1f} mm are missing. The smallest blank that works is "
            f"{need[0]:g} × {need[1]:g} mm; or scale the design down."
        )
    low = spots.min(axis=0)
    return Placement(
        angle=angle,
        dx=round(float((sheet.width - width) / 2 - low[0]), 9),
        dy=round(float((sheet.height - height) / 2 - low[1]), 9),
    )


def _best_angle(excess: Callable[[float], float]) -> float:
    tried = np.arange(0.0, 180.0, _STEP)
    values = np.array([excess(angle) for angle in tried])
    best = float(tried[int(np.argmin(np.round(values, 6)))])
    found = minimize_scalar(
        excess, bounds=(best - _STEP, best + _STEP), method="bounded", options={"xatol": 1e-9}
    )
    fine = float(found.x) if found.fun < excess(best) - 1e-6 else best
    # A round number reads better on the job sheet; take it where it costs nothing.
    neat = round(fine, 3)
    return neat if excess(neat) <= excess(fine) + 1e-6 else fine
