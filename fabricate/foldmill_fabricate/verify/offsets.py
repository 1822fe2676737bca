"""Whether a wrong blade offset explains a program: left out, another blade's, or made up twice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Face, Fit
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.blade import tips
from foldmill_fabricate.verify.drawing import Drawing
from foldmill_fabricate.verify.suspects import Cause, explained
from foldmill_fabricate.verify.virtual_sheet import modelled_offset, on_carrier, to_carrier

Floats = NDArray[np.float64]

_REMEDY = "Write the program again, for the blade that is in the machine."


def wrong_offset(drawing: Drawing, face: Face, fit: Fit | None) -> Cause | None:
    """Return the wrong offset that explains a program that does not draw its strokes, or None."""
    plan = drawing.plan
    offset, step = modelled_offset(plan.machine), drawing.step
    holders = [on_carrier(line.run.points, plan.machine.axes) for line in drawing.lines]
    planned = [to_carrier(stroke.points, plan, face, fit) for stroke in drawing.strokes]
    if not holders or not planned:
        return None
    if offset and explained(planned, holders, step) >= tolerances.EXPLAINED:
        text = f"It leads the holder where the tip should go, which trails {offset:g} mm behind."
        return Cause("offset-left-out", text, _REMEDY)
    used, at_ends = _used(planned, holders, step)
    if used <= 3 * step or abs(used - offset) < step / 2:
        return None
    # a lead-in, which begins at no stroke's end, is no stroke
    ways = [way for way, own in zip(tips(holders, used), at_ends, strict=True) if own]
    if explained(planned, ways, 2 * step + tolerances.BLADE_MM) < tolerances.EXPLAINED:
        return None
    made_for = f"It makes up for a blade that trails {used:.2f} mm behind its holder"
    if offset:
        text = f"{made_for}; here it trails {offset:g} mm behind."
        return Cause("wrong-offset", text, _REMEDY)
    text = f"{made_for}, and the machine makes up for its blade itself: it would be done twice."
    return Cause("offset-twice", text, "Write the program for this machine.")


def _used(
    planned: Sequence[Floats], holders: Sequence[Floats], step: float
) -> tuple[float, list[bool]]:
    """Return how far from the ends of strokes the holder is set down, mm, and which ways are so."""
    from scipy.spatial import cKDTree

    ends = np.vstack([[line[0], line[-1]] for line in planned])
    starts = np.array([way[0] for way in holders])
    gaps = cKDTree(ends).query(starts)[0]
    near = np.abs(gaps - np.sort(gaps)[len(gaps) // 2]) <= 1.5 * step
    return float(gaps[near].mean()), near.tolist()
