"""Where a drag knife is turned before each set-up: nobody knows how its blade points.

After loading, after a change of tool and after the flip the blade points anywhere. Each set-up
therefore begins with a short way in the waste that leaves it pointing one known way; so a program
can also be run by itself, or once more.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import XY, Pass, SetUp, Sheet
from foldmill_fabricate.plan.optical import box
from foldmill_fabricate.plan.registration import Registration, parts
from foldmill_fabricate.toolpath.knife import lead_in

Floats = NDArray[np.float64]

GRID = 1.0
"""mm between the places tried."""
COURSES = np.radians([0.0, 90.0, 180.0, 270.0])
"""Directions in which the blade may point at the end."""
_SPARE = 0.01
"""mm more than asked for, because round corners are reckoned as polygons."""
_CHUNK = 256
"""Places looked at together."""


def added(
    passes: tuple[Pass, ...],
    rims: Sequence[Floats],
    marks: Registration,
    sheet: Sheet,
    material: Material,
    machine: Machine,
) -> tuple[Pass, ...]:
    """Give each set-up a lead-in where programs make up for the blade's offset.

    rims : the parts' outlines (n, 2) on the sheet, mm. A lead-in keeps the material's
    ``part_clearance`` and the offset away from the parts, the blank's edges, the marks and other
    lead-ins, and lies as near to the first stroke as that allows. Raises CannotPlan where there is
    no place.
    """
    offset = machine.tools.host_offset
    if not offset:
        return passes
    room = material.part_clearance + offset + _SPARE
    free = _free(parts(rims), marks, sheet, room)
    done = []
    for work in passes:
        setups = []
        for setup in work.setups:
            way = _place(setup, free, sheet, offset)
            if way is None:
                clear = material.part_clearance
                raise CannotPlan(_no_place(setup, room, clear, sheet, machine))
            free = free.difference(_line(way).buffer(room + offset))
            setups.append(setup.model_copy(update={"lead_in": way}))
        done.append(work.model_copy(update={"setups": tuple(setups)}))
    return tuple(done)


def _free(part: Any, marks: Registration, sheet: Sheet, room: float) -> Any:
    """Return the area in which the holder may go."""
    import shapely

    blank = shapely.box(room, room, sheet.width - room, sheet.height - room)
    holes = [shapely.Point(h.x, h.y).buffer(h.diameter / 2 + room) for h in marks.holes]
    witness = [_line(stroke.points).buffer(room) for stroke in marks.witness]
    windows = [box(mark).buffer(room) for mark in marks.made.marks]
    taken = [part.buffer(room), *holes, *windows, *witness]
    return blank.difference(shapely.union_all(taken))


def _line(points: tuple[XY, ...]) -> Any:
    import shapely

    return shapely.LineString(points)


def _place(setup: SetUp, free: Any, sheet: Sheet, offset: float) -> tuple[XY, ...] | None:
    """Return the lead-in that begins nearest to the set-up's first stroke; None for none."""
    import shapely

    x, y = np.arange(GRID / 2, sheet.width, GRID), np.arange(GRID / 2, sheet.height, GRID)
    spots = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    shapely.prepare(free)
    spots = spots[shapely.contains_xy(free, *spots.T)]
    near = np.asarray(setup.operations[0].strokes[0].points[0])
    spots = spots[np.argsort(np.round(np.hypot(*(spots - near).T), 6), kind="stable")]
    shapes = np.array([lead_in((0.0, 0.0), offset, course) for course in COURSES])
    for first in range(0, len(spots), _CHUNK):
        ways = (spots[first : first + _CHUNK, None, None] + shapes).reshape(-1, 3, 2)
        fits = np.flatnonzero(shapely.contains_properly(free, shapely.linestrings(ways)))
        if len(fits):
            return tuple((float(x), float(y)) for x, y in np.round(ways[fits[0]], 6))
    return None


def strip(clearance: float, machine: Machine) -> float:
    """Return how much broader the waste on every side must be to hold any lead-in, mm.

    clearance : what there is already between part and edge, mm. 0 where none is needed.
    """
    offset = machine.tools.host_offset
    if not offset:
        return 0.0
    return 2 * (clearance + offset + _SPARE) + _leg(offset) + GRID - clearance


def _leg(offset: float) -> float:
    return float(np.abs(lead_in((0.0, 0.0), offset, 0.0)).max())


def _no_place(setup: SetUp, room: float, clearance: float, sheet: Sheet, machine: Machine) -> str:
    more = 2 * strip(clearance, machine)
    width, height = (np.ceil((side + more) * 10) / 10 for side in (sheet.width, sheet.height))
    return (
        f"There is no place in the waste for the lead-in of set-up {setup.number} "
        f'"{setup.name}": two legs of {_leg(machine.tools.host_offset):g} mm with {room:.2f} mm of '
        f"room round them. A blank of {width:g} × {height:g} mm has room for it; or let "
        f"{machine.slug} make up for its blade's offset itself."
    )
