"""How much of a foreign drawing is read: what is more is refused, before it takes long."""

from __future__ import annotations

from typing import Final

BYTES: Final = 8_000_000
"""A drawing of a sheet 600 mm wide with a corner every millimetre has a tenth of that."""
INSTRUCTIONS: Final = 200_000
POINTS: Final = 100_000
"""Corners, those of flattened arcs included."""
STROKES: Final = 20_000
"""Lines, each between the pen's going down and its being lifted."""
NUMBER: Final = 24
"""Characters of a number."""
REACH_MM: Final = 20_000.0
"""Farthest from the origin: longer than any plotter's bed."""
TOLERANCE_MM: Final = 0.01
"""How far the chords of an arc leave it: less than half a plotter step of 0.025 mm."""
APART_MM: Final = 0.02
"""Corners nearer to the one before than this are left out: less than a plotter step of 0.025 mm."""
COARSE_DEG: Final = 15.0
"""A chord angle above this draws a polygon on purpose, and no circle."""
TOLD: Final = 8
"""Refusals that are told one by one."""
