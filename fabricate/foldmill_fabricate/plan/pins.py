"""Two holes that go over pins on the carrier after the flip.

They are symmetric about the flip axis, so that the same two pins take a sheet of either face up,
and as far from the other centre line as they can be, so that a sheet turned the wrong way does not
go over them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.machines import Marks
from foldmill_fabricate.materials import Holes
from foldmill_fabricate.passes import XY, Flip, Hole, Sheet
from foldmill_fabricate.sheet import flipped, on_carrier

Floats = NDArray[np.float64]

STEP = 1.0
"""mm between the places tried."""
OFF_CENTRE = 10.0
"""mm from the other centre line at least: turned the wrong way they are off by twice that."""


def find(
    part: Any, sheet: Sheet, flip: Flip, rule: Holes, marks: Marks
) -> tuple[tuple[Hole, ...], tuple[Finding, ...]]:
    """Return the two holes, the left or lower one first, or none and by how much they do not fit.

    part : the area of all parts on the sheet.
    """
    k = 0 if flip.kind == "left-right" else 1
    length = sheet.height if k == 0 else sheet.width
    along = np.arange(STEP, length, STEP)
    along = along[np.abs(along - length / 2) >= OFF_CENTRE]
    across = np.full(len(along), flip.axis - marks.pin_spacing / 2)
    spots = np.column_stack([across, along] if k == 0 else [along, across])
    room = _room(spots, part, sheet, rule, marks.pin_diameter / 2)
    room = np.minimum(room, _room(flipped(spots, flip), part, sheet, rule, marks.pin_diameter / 2))
    if not len(along) or room.max() < 0:
        return (), (_no_room(marks, float(-room.max()) if len(along) else length),)
    away = np.where(room >= 0, np.abs(along - length / 2), -np.inf)
    spot = spots[int(np.argmax(away))]
    both = np.vstack([spot, flipped([spot], flip)])
    return tuple(Hole(x=float(x), y=float(y), diameter=marks.pin_diameter) for x, y in both), ()


def on_machine(holes: tuple[Hole, ...], sheet: Sheet, flip: Flip) -> tuple[XY, ...]:
    """Return where the pins stand on the carrier, mm, from the left."""
    spots = on_carrier(flipped([(hole.x, hole.y) for hole in holes], flip), sheet)
    return tuple(sorted((float(x), float(y)) for x, y in spots))


def _room(spots: Floats, part: Any, sheet: Sheet, rule: Holes, radius: float) -> Floats:
    """Return how much room holes at spots (n, 2) have beyond what is asked for, mm."""
    import shapely

    to_part = shapely.distance(part, shapely.points(spots)) - radius - rule.part_clearance
    size = np.array([sheet.width, sheet.height])
    to_edge = np.minimum(spots, size - spots).min(axis=1) - radius - rule.edge_clearance
    found: Floats = np.minimum(to_part, to_edge)
    return found


def _no_room(marks: Marks, short: float) -> Finding:
    return Finding(
        "no-registration-pins",
        Severity.WARNING,
        "waste",
        f"Holes for two pins of {marks.pin_diameter:g} mm that are {marks.pin_spacing:g} mm apart "
        f"do not fit beside the part: {short:.1f} mm short of the clearances.",
        "Lay both passes against the edge stops of the job sheet, or take a larger blank.",
    )
