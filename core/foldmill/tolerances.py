"""Every tolerance of foldmill: its unit and its reason. Nowhere else stands a small number."""

from __future__ import annotations

from typing import Final

FLAT_DEG: Final = 1e-4
"""deg. A crease that folds by no more is flat. Solved forms reach 1e-12; a plotter cannot tell
1e-2; so the value only separates noise from intent."""

CLOSED_DEG: Final = 1e-4
"""deg. Nearer to ±180 than this the sign of a fold angle is noise, and the family states it."""

NEARLY_CLOSED_DEG: Final = 1e-2
"""deg. How far φ is opened from 0 or 180 to see to which side a crease closes. A hundred times
CLOSED_DEG, so that the sign is no noise there; so little that no other crease changes its own."""

OFF_AXIS: Final = 1e-5
"""Share of the form's size by which a point on the axis is drawn out to see to which side a crease
closes. Five times what CLOSED_DEG is in rad, as the facet is never higher than the form."""

ANGLE_SUM_RAD: Final = 1e-11
"""rad. Largest deviation of an interior vertex's angle sum from 2π (solved patterns: 1e-14)."""

ISOMETRY: Final = 1e-12
"""Largest difference between an edge's flat and folded length, as a share of the sheet's size. Per
edge it would punish slivers: they reach 6e-11 of themselves at 3e-14 of the sheet."""

ANGLE_SUM_READ_RAD: Final = 1e-5
"""rad. As ANGLE_SUM_RAD, for a form read from a file. Coordinates of four decimals (0.1 µm) spread
over facets of a centimetre turn their angles by so much (measured: 8e-6); a hand cannot fold it."""

KAWASAKI_DEG: Final = 1e-3
"""deg. By how much every other sector angle at a vertex that folds flat may sum to another value
than 180. Solved patterns reach 1e-12; a hand cannot fold a thousandth."""

ISOMETRY_READ: Final = 1e-6
"""As ISOMETRY, for a form read from a file: four decimals of a sheet of 100 mm (measured: 5e-7)."""

FOLD_ANGLE_READ_DEG: Final = 1e-3
"""deg. Largest gap between stated and measured fold angle in a file (four decimals: 3.5e-4)."""

SEAM_READ_MM: Final = 1e-3
"""mm. Largest gap of a seam in a file; coordinates of four decimals leave 2e-4."""

PENETRATION: Final = 1e-7
"""Share of the form's size that two facets must pass through each other to penetrate. Verdicts on
1.2 million forms were the same from 1e-7 to 1e-13."""

SYMMETRY: Final = 1e-8
"""Share of the form's size by which a turned or mirrored vertex may miss its place. A tenth of
PENETRATION, so that no copy penetrates unseen; a file of six decimals keeps it (3e-9 of 300 mm)."""

COINCIDENT_MM: Final = 1e-6
"""mm. Two points nearer than this are one. A thousandth of the finest plotter step is 2.5e-5."""

HANDLE_GAP_MM: Final = 1e-3
"""mm. The nearest that a handle brings a point to what limits it: a neighbour on its line, an end
of a tuck's segment. A thousand times COINCIDENT_MM, so that what lies between has a length; no more
than a plotter can tell, so that a drag leaves out no value that could be typed in and cut."""

ON_LINE: Final = 1e-9
"""Share of the sheet's size within which a point lies on its symmetry line: then there is no blank
to tuck. Far above rounding (1e-15), far below any tuck a person could fold."""

SNAP_EPSILONS: Final = 64
"""Machine epsilons (times size) below which the squared half-chord of two circles is zero. Without
the snap φ = 90 drifts by 3e-5."""

SNAP_SURE: Final = (0.25, 2.0**20)
"""Between these multiples of the snap the order of the arithmetic may decide whether a squared
half-chord is zero, or shift a point by more than 1e-9 mm of 100; computing many forms at once asks
one by one there. A random form is there once in 1e8."""

TURN_SURE: Final = 1e-5
"""Share of the pattern's size below which the distance D of two circles leaves the direction from
one to the other to rounding (1e-16 of the size, over D)."""

AXIS_SURE: Final = 1e-5
"""Share of the form's size by which it must reach beyond its axis to be sure that facets penetrate
there by more than PENETRATION. Of 500 forms about to cross it, all did from 1.2e-7 on."""

SLIVER_SURE: Final = 2e-4
"""Share of the farthest coordinate above which the heights of all facets keep their angles exact to
ANGLE_SUM_RAD: 1e-16 of that coordinate, over the height, times the facets about a vertex."""

FIGURE: Final = 1e-9
"""mm, and share: how far two ways to compute one figure of a form may be apart. Rounding leaves
1e-12 of 100 mm; no shape that differs hides below it."""

DISH: Final = 1e-9
"""Share of the cubed size below which a form encloses no volume: a flat sheet has no outside."""
