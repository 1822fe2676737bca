"""From bars and verniers to what a machine is off: scale, skew, and the offset of its two sides.

A machine told to go to c on its carrier goes to A·c, A = [[a, a·tan φ], [0, b]]. The bars of a
coupon give A: with width w and height h, AB = a·w, AC² − BD² = 4·a²·tan φ·w·h,
AD² = h²·(a²·tan² φ + b²). Calibration C, of the same form, is applied before; to make A the
identity it becomes C·A⁻¹.

Where a vernier's lines meet, one that ought to be at p on the front and one that ought to be at q
on the reverse are in one place. With F the flip of the blank, which lies at s on the carrier, L how
the machine had been told to follow a flipped sheet, o how far it lies beside its place, and R by
how much it lies turned, which no vernier tells and the machine's own angle says,

    A·(p + s) − s = F(R⁻¹·(A·(L(F(q)) + s) − s − o))

along the vernier. A wrong scale shows as well, double, so that o is found only with A. Without the
turn o would hold where the verniers are and nowhere else: 0.05° are 0.4 mm over a blank of 500.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, degrees, hypot, radians, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidInput
from foldmill_fabricate.coupon.answers import Answers, number_range
from foldmill_fabricate.ladders import Bars, Coupon
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.sheet import flipped, laid_off, turned

Floats = NDArray[np.float64]

MOST_OFF = 0.03
"""Share by which a bar may be off: more is another bar, another unit or a slipped sheet."""
MISFIT = 1.0
"""mm by which the four bars may contradict each other."""
MOST_SKEW = 2.0
"""deg. A machine that leans more is broken."""


@dataclass(frozen=True)
class Found:
    """What a machine is off."""

    scale_x: float
    scale_y: float
    skew: float
    """deg; these three as the machine's profile wants them."""
    dx: float | None
    """mm by which a flipped sheet lies too far to the right; None where it was not read."""
    dy: float | None


def measure(plan: Plan, coupon: Coupon, answers: Answers) -> Found:
    """Return what a machine is off, from the bars and verniers of its coupon.

    Raises InvalidInput with a sentence for readings that cannot be right.
    """
    real = _real(coupon.bars, answers)
    axes = plan.machine.axes
    before = np.array([[axes.scale_x, axes.scale_x * tan(radians(axes.skew))], [0.0, axes.scale_y]])
    now = before @ np.linalg.inv(real)
    skew = degrees(atan(now[0, 1] / now[0, 0]))
    if abs(skew) > MOST_SKEW:
        raise InvalidInput(
            f"The diagonals say that the machine leans by {skew:.1f}°; {MOST_SKEW:g}° is more than "
            f"any machine that works. Measure A to C and B to D again."
        )
    return Found(
        round(float(now[0, 0]), 6),
        round(float(now[1, 1]), 6),
        round(skew, 5),
        *_offset(plan, coupon, answers, real),
    )


def _real(bars: Bars, answers: Answers) -> Floats:
    """Return A, as far as bars were measured; the identity where none was."""
    read, w, h = answers.bars, bars.width, bars.height
    across = hypot(w, h)
    for name, length, drawn in (
        ("A to B", read.ab, w),
        ("A to D", read.ad, h),
        ("A to C", read.ac, across),
        ("B to D", read.bd, across),
    ):
        if length is not None and abs(length / drawn - 1) > MOST_OFF:
            raise InvalidInput(
                f"{name} was read as {length:g} mm, and {drawn:.1f} mm were drawn: no machine is "
                f"{100 * abs(length / drawn - 1):.1f} % off. Measure again, from middle to middle "
                f"of the crosses, in mm."
            )
    if (read.ac is None) != (read.bd is None):
        given, missing = ("B to D", "A to C") if read.ac is None else ("A to C", "B to D")
        raise InvalidInput(
            f"{given} was read without {missing}: only both diagonals together show whether the "
            f"machine is square. Measure {missing} too, or leave both out."
        )
    a = read.ab / w if read.ab else 1.0
    lean = 0.0
    if read.ac and read.bd:
        _agree(answers)
        lean = (read.ac**2 - read.bd**2) / (4 * a * a * w * h)
    b = sqrt((read.ad / h) ** 2 - (a * lean) ** 2) if read.ad else 1.0
    return np.array([[a, a * lean], [0.0, b]])


def _agree(answers: Answers) -> None:
    """Raise where the four bars are those of no parallelogram: AC² + BD² = 2·(AB² + AD²)."""
    read = answers.bars
    if read.ab is None or read.ad is None or read.ac is None or read.bd is None:
        return
    wanted = sqrt(read.ab**2 + read.ad**2)
    given = sqrt((read.ac**2 + read.bd**2) / 2)
    if abs(given - wanted) > MISFIT:
        raise InvalidInput(
            f"The bars contradict each other: with A to B {read.ab:g} mm and A to D {read.ad:g} mm "
            f"the diagonals are {wanted:.1f} mm in the mean, and {given:.1f} mm were read. Measure "
            f"all four again."
        )


def _offset(
    plan: Plan, coupon: Coupon, answers: Answers, real: Floats
) -> tuple[float | None, float | None]:
    """Return how far along x and along y a flipped sheet lies beside its place, mm.

    Turned as far as the machine's own angle says, and along an axis that was not read where the
    machine had it before.
    """
    known = plan.machine.two_sides
    same = known.flip == plan.flip.kind
    back = turned(np.eye(2), known.angle * same)  # its rows are those of R⁻¹
    rows, sides, is_read = np.eye(2), np.array([known.dx, known.dy]) * same, [False, False]
    for axis in (0, 1):
        met = _meeting(plan, coupon, answers, real, axis)
        if met is not None:
            made, seen = met
            rows[axis], sides[axis] = back[axis], back[axis] @ made - seen[axis]
            is_read[axis] = True
    dx, dy = (round(float(each), 4) for each in np.linalg.solve(rows, sides))
    return dx if is_read[0] else None, dy if is_read[1] else None


def _meeting(
    plan: Plan, coupon: Coupon, answers: Answers, real: Floats, axis: int
) -> tuple[Floats, Floats] | None:
    """Return where a line of the reverse was made, and the front's line it meets was to lie: mm.

    Both of the flipped blank as the machine sees it; None where the vernier was not read.
    """
    name = "xy"[axis]
    read = answers.vernier.x if axis == 0 else answers.vernier.y
    if read is None:
        return None
    low, high = number_range(coupon, name)
    if not low <= read <= high:
        raise InvalidInput(
            f"The vernier along {name} was read as {read:g}; its numbers go from {low} to {high}. "
            f"Where no lines meet, record the bars alone, and make the coupon again."
        )
    spot = _where(coupon, name, read)
    behind = spot.copy()
    behind[axis] -= read / 10  # there the reverse's line ought to be
    corner = np.array([plan.sheet.dx, plan.sheet.dy])
    told = laid_off(flipped([behind], plan.flip), plan)[0] + corner
    front = real @ (spot + corner) - corner
    return real @ told - corner, flipped([front], plan.flip)[0]


def _where(coupon: Coupon, axis: str, read: float) -> Floats:
    """Return where the line with a number stands, mm on the sheet."""
    for vernier in (v for v in coupon.verniers if v.axis == axis):
        k = -round(10 * vernier.shift) - read
        if abs(k) <= vernier.each_way:
            along = vernier.front_pitch * k
            x, y = vernier.at
            return np.array([x + along, y] if axis == "x" else [x, y + along])
    return np.array(coupon.verniers[0].at)
