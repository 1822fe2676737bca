"""How parts lie on their blank, and the blank on its carrier."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.errors import DoesNotFit
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Placement, Sheet
from foldmill_fabricate.plan import blanks
from foldmill_fabricate.plan.grids import Block
from foldmill_fabricate.sheet import turned

Floats = NDArray[np.float64]


def lay_blank(
    machine: Machine,
    blank: tuple[float, float],
    carrier: tuple[float, float],
    block: Block,
) -> Sheet:
    """Centre the blank between the carrier's margins; block : what it is to hold.

    Raises DoesNotFit with the missing millimetres and the smallest blank that works.
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
            take = "" if name.startswith("blank") else "Take a smaller carrier. "
            raise DoesNotFit(
                f"The {name} {need:g} mm, but {machine.slug} has {room:g} mm there: "
                f"{need - room:g} mm too much. {take}"
                f"{blanks.advice(block, blank, carrier, machine)}."
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
    return lay_out(Block.of(points, clearance), sheet)[0]


def lay_out(
    block: Block, sheet: Sheet, advice: Callable[[], str] | None = None
) -> tuple[Placement, ...]:
    """Centre a block on the blank; return where each copy lies, row by row from the lower left.

    advice : which blank would work. Raises DoesNotFit with the missing millimetres, how many copies
    would fit, and that advice.
    """
    turn = block.best(sheet.width, sheet.height)
    if not turn.fits:
        size = (sheet.width, sheet.height)
        works = advice() if advice else _works(block, size)
        raise DoesNotFit(
            f"{_refusal(block, size, turn.missing)} {works}; or scale the design down."
        )
    spots = turned(block.hull, turn.angle)
    low = spots.min(axis=0)
    width, height = block.size(turn.grid, turn.angle)
    across, along = np.ptp(spots, axis=0) + block.clearance
    found = []
    for number in range(block.count):
        row, column = divmod(number, turn.grid.columns)
        x = float((sheet.width - width) / 2 - low[0]) + column * float(across)
        y = float((sheet.height - height) / 2 - low[1]) + row * float(along)
        found.append(Placement(angle=turn.angle, dx=round(x, 9), dy=round(y, 9)))
    return tuple(found)


def _works(block: Block, size: tuple[float, float]) -> str:
    width, height = blanks.smallest(block, like=size) or size
    return f"The smallest blank that works is {width:g} × {height:g} mm"


def _refusal(block: Block, size: tuple[float, float], missing: float) -> str:
    blank = f"on a {size[0]:g} × {size[1]:g} mm blank however"
    if block.count == 1:
        return f"The part does not fit {blank} it is turned: {missing:.1f} mm are missing."
    what = f"{block.count} copies of the part"
    if block.shape is not None:
        what += f" in a grid of {block.shape.columns} × {block.shape.rows}"
    fit = block.most(*size)
    could = f"{fit} would fit" if fit else "not even one fits"
    return f"{what} do not fit {blank} they are turned: {missing:.1f} mm are missing; {could}."
