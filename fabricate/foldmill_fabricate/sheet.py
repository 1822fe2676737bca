"""The sheet on its carrier: placing a pattern, turning the sheet over, and how it really lies."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.machines import Axes, Machine
from foldmill_fabricate.passes import Face, Fit, Flip, Placement, Plan, Role, Sheet

Floats = NDArray[np.float64]


NOMINAL = Fit(angle=0.0, dx=0.0, dy=0.0)
"""A flipped sheet that lies where it ought to, whatever its machine has stored."""


def turned(points: ArrayLike, degrees: float) -> Floats:
    """Turn points (n, 2) about the origin, counter-clockwise."""
    angle = np.radians(degrees)
    cos, sin = np.cos(angle), np.sin(angle)
    xy = np.asarray(points, float)
    return np.column_stack([cos * xy[:, 0] - sin * xy[:, 1], sin * xy[:, 0] + cos * xy[:, 1]])


def placed(points: ArrayLike, placement: Placement) -> Floats:
    """Bring pattern coordinates (n, 2) onto the sheet, mm."""
    moved: Floats = turned(points, placement.angle) + np.array([placement.dx, placement.dy])
    return moved


def flipped(points: ArrayLike, flip: Flip) -> Floats:
    """Turn the sheet over: its reverse, as one looks at it then. Its own inverse."""
    xy = np.array(points, float)
    k = 0 if flip.kind == "left-right" else 1
    xy[:, k] = 2 * flip.axis - xy[:, k]
    return xy


def on_carrier(points: ArrayLike, sheet: Sheet) -> Floats:
    """Shift sheet coordinates (n, 2) by where the blank lies on its carrier, mm."""
    moved: Floats = np.asarray(points, float) + np.array([sheet.dx, sheet.dy])
    return moved


def laid_off(points: ArrayLike, plan: Plan) -> Floats:
    """Move points (n, 2) of the flipped sheet, mm, to where this machine is known to find them.

    Nothing moves where the offset was measured with the other flip, nor where the machine's own
    sensor finds the sheet.
    """
    off = plan.machine.two_sides
    if off.flip != plan.flip.kind or plan.registration.kind == "l-marks":
        return np.asarray(points, float)
    moved: Floats = turned(points, off.angle) + np.array([off.dx, off.dy])
    return moved


def seated(machine: Machine, sheet: Sheet) -> Machine:
    """Return a machine that counts y from the upper edge of this sheet's carrier, if it does so."""
    if machine.axes.top is None:
        return machine
    axes = machine.axes.model_copy(update={"top": sheet.carrier_height})
    return machine.model_copy(update={"axes": axes})


def in_steps(points: ArrayLike, axes: Axes) -> Floats:
    """Turn carrier coordinates (n, 2) mm into machine steps (n, 2), calibrated and not rounded."""
    x, y = np.asarray(points, float).T
    up = y if axes.top is None else axes.top - y
    xy = np.column_stack(
        [axes.scale_x * (x + y * np.tan(np.radians(axes.skew))), axes.scale_y * up]
    )
    found: Floats = (xy[:, ::-1] if axes.swap else xy) * axes.units_per_mm
    return found


def seen_by_machine(plan: Plan, face: Face, points: ArrayLike, fit: Fit | None = None) -> Floats:
    """Return where the machine finds sheet points (n, 2) of a pass: carrier coordinates, mm.

    fit : how this very sheet was found to lie; without it the reverse lies as the machine's stored
    offset of the two sides says.
    """
    if face is Face.FRONT:
        return on_carrier(points, plan.sheet)
    seen = flipped(points, plan.flip)
    if fit is None:
        return on_carrier(laid_off(seen, plan), plan.sheet)
    found: Floats = turned(on_carrier(seen, plan.sheet), fit.angle) + np.array([fit.dx, fit.dy])
    return found


def strokes(plan: Plan, role: Role, face: Face | None = None) -> list[Floats]:
    """Return the strokes of a role, (n, 2) mm each on the sheet, of one face or of both."""
    return [
        np.asarray(stroke.points, float)
        for work in plan.passes
        if face is None or work.face is face
        for setup in work.setups
        for operation in setup.operations
        if operation.role is role
        for stroke in operation.strokes
    ]
