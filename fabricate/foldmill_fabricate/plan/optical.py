"""Marks that a machine's own sensor finds after the flip: windows cut through on the front pass.

A sensor reads the face that is up. A mark drawn on the front is underneath when it is needed, and
one drawn on the reverse beforehand has no known place on the front. So marks go through the sheet:
they are cut, and dark tape on the front face makes them dark windows on the reverse. They are laid
out as the machine looks for them on the reverse, so that on the front they are mirrored.

Terminology: the *view* is the reverse as the machine sees it; an *inset* is the distance of a
mark's outer corner from the blank's edge; a mark's *box* is the square its arms span.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.machines import Marks
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Flip, Mark, Sheet, Stroke
from foldmill_fabricate.sheet import flipped

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

EDGE = 10.0
"""mm from a mark to the blank's edge: sensors are made for that much."""
LEAST_WINDOW = 1.0
"""mm. A narrower strip does not come out of its cut; nor does one narrower than it is thick."""
ASYMMETRY = 20.0
"""mm by which opposite insets differ, so that a sheet turned any wrong way shows its marks
elsewhere."""
STEP = 2.5
"""mm between the insets tried."""
DEEPEST = 100.0
"""mm. The deepest inset tried."""


class _Corner(NamedTuple):
    """One corner of the rectangle of marks in the view: which way the sheet lies from it."""

    across: int
    upward: int
    shape: str


def _corners(marks: Marks) -> list[_Corner]:
    """Return the corners that carry a mark: with three, the upper left one is a square."""
    lower = _Corner(1, 1, "ell")
    if "l-marks-4" in marks.kinds:
        return [lower, _Corner(-1, 1, "ell"), _Corner(1, -1, "ell"), _Corner(-1, -1, "ell")]
    return [lower, _Corner(1, -1, "square"), _Corner(-1, -1, "ell")]


def line_width(marks: Marks, material: Material) -> float:
    """Return how wide the arms are cut, mm: as the machine has them, or as can be cut at all."""
    return max(marks.line_width, LEAST_WINDOW, material.thickness)


def find(
    part: Any, sheet: Sheet, flip: Flip, material: Material, marks: Marks
) -> tuple[tuple[Mark, ...], tuple[Finding, ...]]:
    """Return the marks in sheet coordinates, or none and by how much they do not fit.

    part : the area of all parts on the sheet.
    """
    import shapely

    clear = part.buffer(material.holes.part_clearance)
    taken = shapely.transform(clear, lambda xy: flipped(xy, flip))
    insets = _insets(taken, sheet, marks, marks.arm)
    if insets is None:
        return (), (_no_room(taken, sheet, marks),)
    width = line_width(marks, material)
    return tuple(_marks(insets, sheet, flip, marks, width)), _wider(marks, width)


def _insets(taken: Any, sheet: Sheet, marks: Marks, arm: float) -> Floats | None:
    """Return the insets on the left, bottom, right and top (4,) mm, outermost first; or None."""
    depth = min(DEEPEST, (min(sheet.width, sheet.height) - arm) / 2)
    tried = np.arange(EDGE, depth, STEP)
    free: Flags = np.ones((len(tried),) * 4, bool)
    for corner in _corners(marks):
        own = _free(taken, sheet, corner, tried, arm)  # by inset from the side, then along
        side, along = (0 if corner.across > 0 else 2), (1 if corner.upward > 0 else 3)
        shape = [len(tried) if k in {side, along} else 1 for k in range(4)]
        free &= (own if side < along else own.T).reshape(shape)
    left, bottom, right, top = np.meshgrid(tried, tried, tried, tried, indexing="ij", sparse=True)
    free &= (np.abs(left - right) >= ASYMMETRY) & (np.abs(bottom - top) >= ASYMMETRY)
    if not free.any():
        return None
    cost = np.where(free, left + bottom + right + top, np.inf)
    best: Floats = tried[list(np.unravel_index(int(np.argmin(cost)), cost.shape))]
    return best


def _free(taken: Any, sheet: Sheet, corner: _Corner, tried: Floats, arm: float) -> Flags:
    """Tell at which insets (n, n) from the side and along a corner's box is free."""
    import shapely

    x = tried if corner.across > 0 else sheet.width - tried - arm
    y = tried if corner.upward > 0 else sheet.height - tried - arm
    low, high = np.meshgrid(x, y, indexing="ij")
    shapely.prepare(taken)
    found: Flags = ~shapely.intersects(taken, shapely.box(low, high, low + arm, high + arm))
    return found


def _marks(insets: Floats, sheet: Sheet, flip: Flip, marks: Marks, width: float) -> Iterator[Mark]:
    left, bottom, right, top = insets.tolist()
    across, upward = (-1, 1) if flip.kind == "left-right" else (1, -1)
    for corner in _corners(marks):
        x = left if corner.across > 0 else sheet.width - right
        y = bottom if corner.upward > 0 else sheet.height - top
        spot = flipped([(x, y)], flip)[0]
        yield Mark.model_validate(
            {
                "shape": corner.shape,
                "x": float(spot[0]),
                "y": float(spot[1]),
                "across": corner.across * across,
                "upward": corner.upward * upward,
                "size": marks.square if corner.shape == "square" else marks.arm,
                "width": marks.square if corner.shape == "square" else width,
            }
        )


def window(mark: Mark) -> Stroke:
    """Return a mark's rim as a closed stroke that begins at its outer corner."""
    s, w = mark.size, mark.width
    square = [(0, 0), (s, 0), (s, s), (0, s)]
    ell = [(0, 0), (s, 0), (s, w), (w, w), (w, s), (0, s)]
    rim = [
        (mark.x + mark.across * x, mark.y + mark.upward * y)
        for x, y in (square if mark.shape == "square" else ell)
    ]
    return Stroke(points=(*rim, rim[0]))


def box(mark: Mark) -> Any:
    """Return the square that a mark's arms span: nothing else may be in it."""
    import shapely

    ends = (
        sorted((mark.x, mark.x + mark.across * mark.size)),
        sorted((mark.y, mark.y + mark.upward * mark.size)),
    )
    return shapely.box(ends[0][0], ends[1][0], ends[0][1], ends[1][1])


def _wider(marks: Marks, width: float) -> tuple[Finding, ...]:
    if width <= marks.line_width:
        return ()
    return (
        Finding(
            "marks-wider",
            Severity.INFO,
            "registration marks",
            f"Their arms are cut {width:g} mm wide, for a strip of {marks.line_width:g} mm does "
            f"not come out of the sheet.",
            f"Set the line width of marks on the machine to {width:g} mm.",
        ),
    )


def _no_room(taken: Any, sheet: Sheet, marks: Marks) -> Finding:
    sizes = np.arange(marks.arm - 1, 0, -1)
    fits = next((size for size in sizes if _insets(taken, sheet, marks, size) is not None), 0.0)
    held = f"arms of {fits:g} mm would fit" if fits else "no size of them would fit"
    return Finding(
        "no-registration-marks",
        Severity.WARNING,
        "waste",
        f"The machine's L marks do not fit beside the part: their arms are {marks.arm:g} mm long, "
        f"and {held} ({marks.arm - fits:g} mm short).",
        "Lay both passes against the edge stops of the job sheet, or take a larger blank.",
    )
