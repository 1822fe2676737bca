"""How far the reverse may land beside the front, cause by cause, against half the thickness.

Each cause adds a distance at the scored point that is farthest from what holds the sheet. They are
independent of each other, so that likely they add up as the root of the sum of their squares; at
worst they all point the same way.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import fsum, hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Budget, Plan, Role, Share
from foldmill_fabricate.sheet import strokes

Floats = NDArray[np.float64]

USUAL_DRIFT = 5.0
"""°C between both passes, where nobody measured: a workshop over a day."""
BY_HAND = 2.0
"""mm. How well a sheet is laid again where nothing holds it."""
BAR_LENGTH, BAR_READING = 400.0, 0.1
"""mm. A machine's scale is known as well as a bar of that length is read."""

FLIP, HEAT, FRONT, REVERSE, SCALE = "flip", "temperature", "front pass", "reverse pass", "scale"


def reckon(plan: Plan) -> Budget | None:
    """Return the budget of a plan; None where the sheet is not turned over."""
    if len(plan.passes) < 2:
        return None
    reach = _reach(plan)
    machine = plan.machine.repeatability
    shares = (
        _flip(plan, reach),
        _heat(plan, reach),
        Share(name=FRONT, error=machine, because="how well the machine repeats a line"),
        Share(name=REVERSE, error=machine, because="how well the machine repeats a line"),
        Share(
            name=SCALE,
            error=reach * BAR_READING / BAR_LENGTH,
            because=f"{BAR_LENGTH:g} mm are known to {BAR_READING:g} mm; {reach:.0f} mm from the "
            f"middle of what holds the sheet",
        ),
    )
    errors = [share.error for share in shares]
    return Budget(
        shares=shares,
        likely=sqrt(fsum(each**2 for each in errors)),  # the same in every Python, as sum is not
        worst=fsum(errors),
        limit=plan.material.thickness / 2,
    )


def _held(plan: Plan) -> Floats:
    """Return what holds the sheet (n, 2), sheet coordinates: holes, marks, or the datum corner."""
    made = plan.registration
    spots = [(mark.x, mark.y) for mark in made.marks] or [(hole.x, hole.y) for hole in plan.holes]
    if spots:
        return np.array(spots, float)
    if made.kind == "edge":
        return np.zeros((1, 2))
    return np.array([[plan.sheet.width / 2, plan.sheet.height / 2]])


def _reach(plan: Plan) -> float:
    """Return how far the farthest scored point is from the middle of what holds the sheet, mm."""
    scores = strokes(plan, Role.SCORE)
    if not scores:
        return 0.0
    away = np.vstack(scores) - _held(plan).mean(axis=0)
    return float(np.hypot(*away.T).max())


def _flip(plan: Plan, reach: float) -> Share:
    marks, kind = plan.machine.marks, plan.registration.kind
    if kind in {"edge", "pins", "none"}:
        error, because = {
            "edge": (marks.edge_error, "how well a sheet lies against stops"),
            "pins": (marks.pin_error, "how well a sheet lies on pins"),
            "none": (BY_HAND, "nothing holds the sheet"),
        }[kind]
        return Share(name=FLIP, error=error, because=because)
    spots = _held(plan)
    each = marks.optical_error if kind == "l-marks" else marks.hole_error
    what = "marks are found" if kind == "l-marks" else "holes are measured"
    return Share(
        name=FLIP,
        error=each * _propagated(spots, reach),
        because=f"{len(spots)} {what} to {each:g} mm each",
    )


def _propagated(spots: Floats, reach: float) -> float:
    """Return what an error of 1 at every spot (n, 2) becomes that far from their middle.

    Of a rigid fit by least squares: the shift errs by 1/√n, the angle by 1/√Σr².
    """
    spread = float(((spots - spots.mean(axis=0)) ** 2).sum())
    return hypot(1 / sqrt(len(spots)), reach / sqrt(spread)) if spread else 1.0


def _heat(plan: Plan, reach: float) -> Share:
    given = plan.temperatures
    drift = USUAL_DRIFT if given is None else abs(given[1] - given[0])
    because = (
        f"{drift:g} °C between the passes, assumed"
        if given is None
        else f"{given[0]:g} °C at the front pass, {given[1]:g} °C at the reverse"
    )
    error = plan.material.expansion * 1e-6 * drift * reach
    return Share(name=HEAT, error=error, because=because)


def sentence(budget: Budget) -> str:
    """Return the budget in one sentence."""
    shares = ", ".join(f"{share.name} {share.error:.2f}" for share in budget.shares)
    return (
        f"The reverse likely lands within {budget.likely:.2f} mm of the front, at worst within "
        f"{budget.worst:.2f} mm ({shares}); half the thickness is {budget.limit:g} mm."
    )


def findings(plan: Plan) -> Iterator[Finding]:
    """Yield a warning where the likely error is above half the thickness."""
    budget = plan.budget
    if budget is None or budget.likely <= budget.limit:
        return
    largest = max(budget.shares, key=lambda share: share.error)
    told, remedy = sentence(budget), _remedy(largest)
    yield Finding("register-error", Severity.WARNING, "reverse pass", told, remedy)


def _remedy(largest: Share) -> str:
    return {
        FLIP: "Most comes from the flip: register by holes, measure all of them and send with "
        "--marks, or store what a coupon shows of the machine's two sides.",
        HEAT: "Most comes from temperature: do both passes in one session, and say the sheet's "
        "temperatures with --temperature.",
        SCALE: "Most comes from scale: calibrate the machine on bars as long as the sheet.",
    }.get(
        largest.name,
        "Most comes from the machine itself: take one that repeats better, or a thicker sheet.",
    )
