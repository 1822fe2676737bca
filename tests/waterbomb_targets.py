"""Targets for waterbomb tessellations that more than one test folds upon, as plain values."""

from __future__ import annotations

from typing import Any

PLAIN = {"start": "uniform", "boundary": "fixed", "rim": "outside"}
"""The thesis' own problem: a uniform base mesh, its boundary fixed, slid beyond the range of v."""
ROUND = {"u_start": 0, "u_end": "2*pi", "u_closes": True}
BALL = {
    "kind": "expression",
    "x": "cos(v)*cos(u)",
    "y": "cos(v)*sin(u)",
    "z": "sin(v)",
    **ROUND,
}
_STAIRS = {
    "kind": "expression",
    "x": "v*cos(u)",
    "y": "v*sin(u)",
    "z": "0.2*u",
    "u_start": 0,
    "u_end": "4*pi",
    "v_start": 0.3,
    "v_end": 1,
}
HELICOID: dict[str, Any] = {"surface": _STAIRS, "n_u": 60, "n_v": 6, "start": "uniform"}
"""Two turns of a helicoid: without fault in space, and its sheet lies upon itself."""
NARROW: dict[str, Any] = {"surface": {"kind": "catenoid"}, "n_u": 8, "n_v": 12, **PLAIN}
"""A catenoid whose waist is too narrow for its bases: it passes through itself."""


def flat(values: dict[str, Any]) -> dict[str, Any]:
    """Return values with those of the surface beside the others, as ``words`` types them."""
    return {**values.get("surface", {}), **{k: v for k, v in values.items() if k != "surface"}}
