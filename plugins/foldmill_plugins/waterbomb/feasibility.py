"""Can a target be approximated at all? What the flat metric says, before anything is solved."""

from __future__ import annotations

from typing import Any

from foldmill.finding import Finding, Severity
from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.metric import MOST_LEFT
from foldmill_plugins.waterbomb.params import WaterbombParams


def report(params: WaterbombParams) -> dict[str, Any]:
    """Report whether a field of depths takes the target's curvature away; nothing is solved."""
    build = Build(params)
    return {**promised(build), "start": build.start, "advice": warned(build).strip() or "none"}


def promised(build: Build) -> dict[str, Any]:
    """Return the indicator: the deepest base wanted, its room, the curvature left, the verdict."""
    return {
        "deepest": build.promise.deepest,
        "crowding": build.crowding,
        "curvature_left": build.promise.left,
        "is_likely": build.promise.is_feasible and build.crowding < 1,
    }


def findings(build: Build) -> tuple[Finding, ...]:
    """Return the warning, where there is one, as a check tells it."""
    said = warned(build).strip()
    if not said:
        return ()
    remedy = "Take another n_u and n_v or another depth, and look closely at the result."
    return (Finding("feasibility", Severity.WARNING, "target", said, remedy),)


def warned(build: Build) -> str:
    """Return what the indicator warns of, as sentences, or nothing."""
    promise, said = build.promise, ""
    if promise.deepest >= 1:
        said += (
            f"To become flat, bases would have to be {promise.deepest:.3g} times as deep as their "
            "cells are high; less than 1 is possible. "
        )
    elif build.crowding >= 1:
        said += (
            "The target curves towards the pits, and bases would be "
            f"{build.crowding:.3g} times as deep as their cells are high down there; less than 1 "
            "is possible. More bases along u, or fewer along v, make them less deep. "
        )
    if promise.left >= MOST_LEFT:
        said += f"No depths take away {100 * promise.left:.3g} % of the target's curvature. "
    return said
