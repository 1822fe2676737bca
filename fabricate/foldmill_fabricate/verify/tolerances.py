"""The tolerances of verification: unit and reason of each. Those of geometry are in core."""

from __future__ import annotations

from typing import Final

BLADE_MM: Final = 0.02
"""mm. What making up for a blade's offset may leave; added to one plotter step, and only where the
blade is modelled: a machine that makes up for it itself is told the plan's own points."""

SETTLED_MM: Final = 0.002
"""mm. How far apart tips may be after a lead-in that pointed variously before it: a tenth of what
making up for the offset may leave."""

SHARP_DEG: Final = 30.0
"""deg. Where the blade is to be lifted out for it, it is not turned by more in the material; five
degrees more are allowed, for rounding to steps."""

FACETTED: Final = 3.0
"""Offsets. A hole of a smaller radius is cut in facets, so that the blade can follow."""

LEAST_FACETS: Final = 6

PLAN_MM: Final = 1e-3
"""mm. A plan's lines lie on the pattern's within this: a 25th of the finest plotter step, and far
above what writing a number down and reading it again can change."""

UNEVEN_MM: Final = 0.01
"""mm. A stretch of a planned line shorter than this is neither missing nor doubled."""

SLACK_STEPS: Final = 4.0
"""Plotter steps. Shorter stretches of a stroke may be passed once more or less often than asked,
because both ends of every piece are rounded to steps."""

SLACK_BLADE: Final = 5.0
"""Times BLADE_MM. The same for a dragged blade, which goes to and fro a little at corners."""

ALONG_MM: Final = 0.1
"""mm. Two lines of a foreign drawing may run along each other for as long as this: where they cross
at a small angle."""

BESIDE_MM: Final = 1.0
"""mm. A line this near to a lost stroke is that stroke, moved: closer than creases lie together."""

STRAIGHT_DEG: Final = 1e-4
"""deg. Two creases this near to one straight line are one: above rounding, below any drawing."""

NEARLY_STRAIGHT_DEG: Final = 1.0
"""deg. Up to here a planner may take two creases for one straight line, or not."""

CORNER_DEG: Final = 5.0
"""deg. The outline has a corner where it turns by more."""

NEAR_PITCHES: Final = 0.25
"""Pitches of ties. Where a tie as asked for could be so near, none lies nearer to a corner."""

ROUND_MM: Final = 0.05
"""mm. How far the facets of a hole may leave its circle: a pin does not feel it."""

EXPLAINED: Final = 0.95
"""Share of points that one cause (a scale, a missing mirror) must explain to be named for all."""

MISFIT: Final = 0.05
"""Share of a program that must be missing or astray before a common cause is looked for."""

EVEN_SCALE: Final = 2e-4
"""Two scales that differ by no more are one: 0.1 mm over a sheet of 500 mm."""

WINDOW_MM: Final = 1.0
"""mm. The arms of optical marks may be cut as wide as this, where the machine has thinner lines: a
thinner strip does not come out of the sheet."""

MARK_EDGE_MM: Final = 10.0
"""mm. From an optical mark to the blank's edge at least."""

APART_MM: Final = 15.0
"""mm. A mark this far from where it is looked for is not found: it shows a sheet turned wrongly."""
