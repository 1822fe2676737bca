"""The smallest blank that holds a part, or its copies, and what to say where there is none.

Smallest is the least area; no side of it can be a millimetre shorter.
"""

from __future__ import annotations

from math import ceil, floor

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plan.grids import Block
from foldmill_fabricate.plan.lead_ins import strip

Size = tuple[float, float]
"""Width and height, mm."""

_ENDLESS = (1e6, 1e6)


def smallest(block: Block, most: Size = _ENDLESS, like: Size = (1.0, 1.0)) -> Size | None:
    """Return the smallest blank for a block, to 0.1 mm above; None where ``most`` is too small.

    like : of two that are alike, the one that lies as this one does.
    """
    found = _least_area(block, most, like)
    if found is None:
        turn = block.best(*most)
        if not turn.fits:
            return None
        found = block.needs(turn.grid, turn.angle)
    width, height = _shrunk(block, found)
    return _up(width), _up(height)


def advice(block: Block, blank: Size, carrier: Size, machine: Machine) -> str:
    """Return which blank would work, on this carrier or on a larger one; without a full stop.

    Where programs lead a blade in the waste there must be some on every side: then the blank that
    is named works, and may not be the smallest.
    """
    bed = reach(machine)
    more = 2 * strip(block.clearance, machine)
    most = room(machine, (min(carrier[0], bed[0]), min(carrier[1], bed[1])))
    here = _with_waste(block, most, blank, more)
    what = "works" if block.count == 1 else f"works for {block.count}"
    what = f"A blank that {what} is" if more else f"The smallest blank that {what} is"
    if here is not None:
        return f"{what} {_words(here)}"
    there = _with_waste(block, room(machine, bed), blank, more)
    if there is not None:
        left, lead, right, trail = machine.bed.margins
        larger = (
            max(there[0] + left + right, min(carrier[0], bed[0])),
            max(there[1] + lead + trail, min(carrier[1], bed[1])),
        )
        return (
            f"{what} {_words(there)}, on a larger carrier (--carrier {larger[0]:g}x{larger[1]:g})"
        )
    any_size = _with_waste(block, _ENDLESS, blank, more) or _ENDLESS
    width, height = (floor(side * 10) / 10 for side in room(machine, bed))
    return (
        f"{what} {_words(any_size)}, and {machine.slug} takes "
        f"{_words((width, height))} at the most: take another machine"
    )


def _with_waste(block: Block, most: Size, like: Size, more: float) -> Size | None:
    """Return the smallest blank with so much more waste in all, across and along; None for none."""
    found = smallest(block, (most[0] - more, most[1] - more), like)
    return None if found is None else (_up(found[0] + more), _up(found[1] + more))


def room(machine: Machine, carrier: Size) -> Size:
    """Return the largest blank that a carrier holds between the machine's margins, mm."""
    left, lead, right, trail = machine.bed.margins
    return carrier[0] - left - right, carrier[1] - lead - trail


def reach(machine: Machine) -> Size:
    """Return the largest carrier, mm: the machine's bed, as far as it can be told a position."""
    bed, axes = machine.bed, machine.axes
    if machine.language != "hpgl":
        return bed.width, bed.length
    far = axes.highest / axes.units_per_mm
    return min(bed.width, far / axes.scale_x), min(bed.length, far / axes.scale_y)


def _least_area(block: Block, most: Size, like: Size) -> Size | None:
    """Try every grid at every turn that lays a side of the part along the blank's."""
    found: list[tuple[float, bool, Size]] = []
    for grid in block.grids:
        for angle in block.aligned.tolist():
            width, height = block.needs(grid, angle)
            if width <= most[0] and height <= most[1]:
                lies_otherwise = (width > height) != (like[0] > like[1])
                found.append((round(width * height, 3), lies_otherwise, (width, height)))
    return min(found)[2] if found else None


def _shrunk(block: Block, size: Size) -> Size:
    """Take a blank that is a millimetre shorter as long as one holds the block."""
    while True:
        for shorter in ((size[0] - 1, size[1]), (size[0], size[1] - 1)):
            turn = block.best(*shorter)
            if turn.fits:
                size = block.needs(turn.grid, turn.angle)
                break
        else:
            return size


def _up(length: float) -> float:
    return ceil(round(length * 10, 5)) / 10


def _words(size: Size) -> str:
    return f"{size[0]:g} × {size[1]:g} mm"
