"""The force that a machine is set to, derived without asking its profile's own rule."""

from __future__ import annotations

from foldmill_fabricate.machines import Tools


def settable(wanted: float, tools: Tools) -> float:
    """Return the nearest force to a wanted one that can be set, gf; 0 where none is set at all."""
    if tools.max_force is None:
        return 0.0
    return sorted([tools.min_force, wanted, tools.max_force])[1]
