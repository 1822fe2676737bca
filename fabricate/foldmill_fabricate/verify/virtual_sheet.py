"""The virtual sheet: what the programs draw, carried back from machine steps to the sheet.

The way there, for each point of the sheet (mm, front view): turned over with the sheet when it lies
face down, then turned and shifted by what the machine's two sides are apart, shifted by where the
blank lies on its carrier, leant and scaled as the machine was calibrated, and last multiplied by
the steps per mm. A fitted reverse is turned and shifted as the sheet was found to lie, on the
carrier, in place of what the machine has stored. Derived here once more.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.machines import Axes, Machine
from foldmill_fabricate.passes import Face, Fit, Flip, Plan
from foldmill_fabricate.verify.interpreter import Run

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Line:
    """What the tip drew between going down and being lifted, as it lies on the sheet."""

    points: Floats
    """(n, 2) mm, sheet coordinates seen from the front."""
    face: Face
    program: str
    run: Run
    """What the program said."""


def modelled_offset(machine: Machine) -> float:
    """Return the distance from blade axis to tip, mm; 0 where the machine makes up for it.

    A pen or a laser has none.
    """
    tools = machine.tools
    return 0.0 if tools.firmware_offset or not tools.trails else tools.blade_offset


def on_carrier(steps: ArrayLike, axes: Axes) -> Floats:
    """Turn machine steps (n, 2) into carrier coordinates, mm: its calibration undone."""
    mm = np.asarray(steps, float) / axes.units_per_mm
    seen = mm[:, ::-1] if axes.swap else mm
    upright = seen / (axes.scale_x, axes.scale_y)
    if axes.top is not None:
        upright[:, 1] = axes.top - upright[:, 1]
    upright[:, 0] -= np.tan(np.radians(axes.skew)) * upright[:, 1]
    return upright


def on_sheet(carrier: ArrayLike, plan: Plan, face: Face, fit: Fit | None) -> Floats:
    """Turn carrier coordinates (n, 2) of a pass into sheet coordinates, mm."""
    seen = np.asarray(carrier, float)
    corner = np.array([plan.sheet.dx, plan.sheet.dy])
    if face is Face.FRONT:
        front: Floats = seen - corner
        return front
    if fit is not None:
        seen = (seen - (fit.dx, fit.dy)) @ rotation(-fit.angle).T
    turn, shift = stored_offset(plan) if fit is None else (np.eye(2), np.zeros(2))
    return turned_over((seen - corner - shift) @ turn, plan.flip)


def to_carrier(sheet: ArrayLike, plan: Plan, face: Face, fit: Fit | None) -> Floats:
    """Turn sheet coordinates (n, 2) into the carrier coordinates of a pass, mm."""
    seen = np.asarray(sheet, float)
    corner = np.array([plan.sheet.dx, plan.sheet.dy])
    if face is Face.FRONT:
        front: Floats = seen + corner
        return front
    seen = turned_over(seen, plan.flip)
    if fit is None:
        turn, shift = stored_offset(plan)
        stored: Floats = seen @ turn.T + shift + corner
        return stored
    found: Floats = (seen + corner) @ rotation(fit.angle).T + np.array([fit.dx, fit.dy])
    return found


def stored_offset(plan: Plan) -> tuple[Floats, Floats]:
    """Return how a flipped sheet lies on this machine: a matrix (2, 2) and a shift (2,), mm.

    Nothing where it was measured of sheets that were turned the other way, and nothing where a
    sensor finds the sheet by its marks.
    """
    stored = plan.machine.two_sides
    if stored.flip == plan.flip.kind and plan.registration.kind != "l-marks":
        return rotation(stored.angle), np.array([stored.dx, stored.dy])
    return np.eye(2), np.zeros(2)


def turned_over(points: Floats, flip: Flip) -> Floats:
    """Reflect sheet points (n, 2) in the flip's axis."""
    sign = np.array([-1.0, 1.0] if flip.kind == "left-right" else [1.0, -1.0])
    offset = np.where(sign < 0, 2 * flip.axis, 0.0)
    over: Floats = points * sign + offset
    return over


def rotation(degrees: float) -> Floats:
    """Return the matrix (2, 2) that turns a column counter-clockwise."""
    angle = np.radians(degrees)
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def drawn_length(drawn: Iterable[Line]) -> float:
    """Return the length of lines with the tool down, repeats included, mm."""
    return float(sum(np.hypot(*np.diff(line.points, axis=0).T).sum() for line in drawn))
