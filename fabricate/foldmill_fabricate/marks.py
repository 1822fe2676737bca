"""Fit the reverse pass to where registration marks are really seen after the flip.

Terminology: the *targets* are the middles of holes or the outer corners of optical marks; a *turn*
is how the sheet came to lie. There are four: as planned; turned over the other way, which is the
planned way and then round by half a turn; not turned over; neither turned over nor left as it lay,
but turned round. Holes are symmetric about the flip axis, so that they look alike on a sheet that
was turned over and on one that was not: the witness mark tells those apart.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.passes import Face, Fit, Plan, Role
from foldmill_fabricate.sheet import NOMINAL, on_carrier, seen_by_machine, strokes, turned

Floats = NDArray[np.float64]

CATCH = 12.0
"""mm around an expected hole within which a measured mark is taken for it: far more than a sheet is
laid askew, less than half of what a sheet turned the wrong way is off."""
SCALE = 1e-3
"""Largest difference in scale that can be temperature; more is a wrong reading."""
LIKELY = 2.0
"""How many times the usual error of reading a result may be off by chance."""
DISTINCT = 2.0
"""A witness mark shows a turn where it would be this many times as far off after any other."""


@dataclass(frozen=True)
class MarkFit:
    """A fit, and how well it explains the marks."""

    fit: Fit
    scale: float
    """Measured distances over expected ones, about the middle of the marks; not applied."""
    residual: float
    """mm, of the worst mark"""

    def __str__(self) -> str:
        return (
            f"shift {self.fit.dx:+.2f}, {self.fit.dy:+.2f} mm, angle {self.fit.angle:+.3f}°, "
            f"scale {self.scale:.5f}, largest residual {self.residual:.2f} mm"
        )


def fit_marks(
    plan: Plan,
    measured: Sequence[tuple[float, float]],
    witness: tuple[float, float] | None = None,
) -> MarkFit:
    """Fit the flipped sheet to measured marks, carrier coordinates in mm, in any order.

    witness : where the middle of the witness mark is seen, on top or shining through. A rigid
    motion by least squares (Kabsch 1976). Raises CannotSend for a sheet that was turned wrongly or
    not at all, fewer than two marks, a mark where none is expected, a scale no temperature explains
    or a residual beyond the machine's tolerance.
    """
    if witness is not None:
        check_witness(plan, witness)
    seen = np.asarray(measured, float).reshape(-1, 2)
    goal = targets(plan)
    _refuse(seen, goal)
    turns = _turns(goal, plan)
    expected = _matched(turns.pop(RIGHT), seen)
    if expected is None:
        raise _unmatched(turns, seen, plan)
    found = _rigid(expected, seen)
    _believe(found, expected, plan)
    return found


RIGHT = "turned over as planned"
_OTHER = "turned over the wrong way, or round by 180° after the flip"
_NOT = "not turned over: the front is still up"
_ROUND = "not turned over but turned round by 180°: the front is still up"
REMEDIES = {
    _OTHER: "Turn it over {flip}, as the job sheet shows.",
    _NOT: "Turn it over {flip}.",
    _ROUND: "Lay it as it was for the front pass, and turn it over {flip}.",
}
"""What to do about each wrong turn."""


def targets(plan: Plan) -> Floats:
    """Return what can be measured on a flipped sheet, (n, 2) mm in sheet coordinates."""
    made = plan.registration.marks
    spots = [(mark.x, mark.y) for mark in made] or [(hole.x, hole.y) for hole in plan.holes]
    return np.array(spots, float).reshape(-1, 2)


def witness_middle(plan: Plan) -> Floats | None:
    """Return the middle (2,) of the witness mark on the sheet, mm; None where there is none."""
    made = strokes(plan, Role.WITNESS)
    if not made:
        return None
    spots = np.vstack(made)
    middle: Floats = (spots.min(axis=0) + spots.max(axis=0)) / 2
    return middle


def check_witness(plan: Plan, seen: tuple[float, float]) -> None:
    """Raise CannotSend where the witness mark is seen as after a wrong turn; carrier, mm."""
    middle = witness_middle(plan)
    if middle is None:
        raise CannotSend("This job has no witness mark; leave it out.")
    turns = _turns(middle.reshape(1, 2), plan)
    away = {turn: float(np.hypot(*(spots[0] - seen))) for turn, spots in turns.items()}
    nearest, second = sorted(away, key=lambda turn: away[turn])[:2]
    if away[nearest] > CATCH or away[second] < DISTINCT * away[nearest]:
        raise CannotSend(
            f"The witness mark cannot be at ({seen[0]:.1f}, {seen[1]:.1f}) mm; on a sheet that is "
            f"turned as planned it is {away[RIGHT]:.1f} mm from there. Measure its middle again."
        )
    if nearest != RIGHT:
        raise _wrong([nearest], plan)


def _turns(spots: Floats, plan: Plan) -> dict[str, Floats]:
    """Return where sheet points (n, 2) are seen on the carrier after each turn, mm."""
    over = seen_by_machine(plan, Face.REVERSE, spots, NOMINAL)
    same = on_carrier(spots, plan.sheet)
    corner = np.array([plan.sheet.dx, plan.sheet.dy])
    ends = 2 * corner + np.array([plan.sheet.width, plan.sheet.height])
    return {RIGHT: over, _OTHER: ends - over, _NOT: same, _ROUND: ends - same}


def _refuse(measured: Floats, goal: Floats) -> None:
    if not np.isfinite(measured).all():
        raise CannotSend("A mark is no number; measure it again.")
    if not len(goal):
        raise CannotSend(
            "This job has no registration holes or marks, so that measured ones mean nothing to it."
        )
    if len(measured) < 2:
        raise CannotSend("Measure at least two registration marks; one alone shows no angle.")


def _matched(expected: Floats, measured: Floats) -> Floats | None:
    """Return the expected spot of each measured mark; None where one is near none.

    Raises CannotSend for two marks at one spot: the same mark was measured twice.
    """
    away = np.hypot(*(measured[:, None] - expected[None]).transpose(2, 0, 1))
    if (away.min(axis=1) > CATCH).any():
        return None
    nearest = away.argmin(axis=1)
    if len(set(nearest.tolist())) < len(measured):
        raise CannotSend("Two marks were measured at the same spot; measure different ones.")
    found: Floats = expected[nearest]
    return found


def _rigid(expected: Floats, seen: Floats) -> MarkFit:
    middle, mean = expected.mean(axis=0), seen.mean(axis=0)
    a, b = expected - middle, seen - mean
    angle = float(np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum()))
    degrees = float(np.degrees(angle))
    shift = mean - turned([middle], degrees)[0]
    left = np.hypot(*(turned(expected, degrees) + shift - seen).T)
    return MarkFit(
        Fit(angle=degrees, dx=float(shift[0]), dy=float(shift[1])),
        float(np.sqrt((b**2).sum() / (a**2).sum())),
        float(left.max()),
    )


def _unmatched(turns: Mapping[str, Floats], seen: Floats, plan: Plan) -> CannotSend:
    """Return what marks say that are not where they should be: which wrong turns explain them."""
    like = []
    for turn, spots in turns.items():
        expected = _matched(spots, seen)
        if expected is not None and _rigid(expected, seen).residual <= plan.machine.mark_tolerance:
            like.append(turn)
    return _wrong(like, plan) if like else _astray(seen, plan)


def _wrong(turns: Sequence[str], plan: Plan) -> CannotSend:
    remedy = REMEDIES[turns[0]].format(flip=plan.flip.kind)
    if len(turns) > 1:
        remedy = f"Where the witness mark is seen tells which. {remedy}"
    return CannotSend(f"The sheet was {', or '.join(turns)}. {remedy}")


def _astray(seen: Floats, plan: Plan) -> CannotSend:
    expected = _turns(targets(plan), plan)[RIGHT]
    away = np.hypot(*(seen[:, None] - expected[None]).transpose(2, 0, 1)).min(axis=1)
    worst = int(np.argmax(away))
    return CannotSend(
        f"No mark is expected near ({seen[worst][0]:.1f}, {seen[worst][1]:.1f}) mm; the nearest is "
        f"{away[worst]:.1f} mm away. Is the sheet turned {plan.flip.kind}, and are the marks in "
        f"carrier coordinates?"
    )


def _believe(found: MarkFit, expected: Floats, plan: Plan) -> None:
    if abs(found.scale - 1) > SCALE:
        raise CannotSend(
            f"The marks are {100 * (found.scale - 1):+.2f} % off in scale ({found}); temperature "
            f"explains {100 * SCALE:g} %. {_how_scale_errs(found, expected, plan)}"
        )
    if found.residual > plan.machine.mark_tolerance:
        raise CannotSend(
            f"The marks do not fit a rigid sheet: {found}, and {plan.machine.slug} allows "
            f"{plan.machine.mark_tolerance:g} mm. Measure them again, or lay the sheet anew."
        )


def _how_scale_errs(found: MarkFit, expected: Floats, plan: Plan) -> str:
    """Say what can be done about a wrong scale: readings alone make one where marks lie close.

    Of n marks whose distances from their middle are r, read to e each, the scale errs by e/√Σr².
    """
    marks = plan.machine.marks
    each = marks.optical_error if plan.registration.kind == "l-marks" else marks.hole_error
    spread = float(np.sqrt(((expected - expected.mean(axis=0)) ** 2).sum()))
    if abs(found.scale - 1) > LIKELY * each / spread:
        return "Measure them again; if they stay, calibrate the machine's scale with a coupon."
    return (
        f"These {len(expected)} marks lie so close together that reading each to {each:g} mm "
        f"alone makes {100 * each / spread:.2f} % of it: measure all marks, those far apart first, "
        f"to {SCALE * spread / LIKELY:.2f} mm."
    )
