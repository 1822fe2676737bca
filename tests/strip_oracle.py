"""A slow second way to solve a strip with points on lines, points by hand, and tucks.

Spheres, planes and circles, to forty digits, by plain geometry; nothing is shared with the solver
under test, so that a difference is the other one's rounding. Random designs to try come with it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, getcontext
from functools import cache

import mpmath
import numpy as np

from foldmill import InvalidInput
from foldmill.axisymmetric import strip
from foldmill.axisymmetric.points import FreePoint, LinePoint

DIGITS = 40
getcontext().prec = max(getcontext().prec, DIGITS)
Spot = tuple[Decimal, ...]
ZERO = Decimal(0)
Points = Mapping[int, LinePoint | FreePoint]


@dataclass(frozen=True)
class Form:
    """Points p_0 … p_T in the pattern and P_0 … P_T in space."""

    order: int
    flat: list[Spot]
    spatial: list[Spot]

    def meridian(self) -> np.ndarray:
        """Return (T+1, 2) P_0 … P_T as (r, z), r signed."""
        rows = [
            (_dot(spot, _outward(i, self.order)), spot[2]) for i, spot in enumerate(self.spatial)
        ]
        return np.array(rows, float)

    def pattern(self) -> np.ndarray:
        """Return (T+1, 2) p_0 … p_T."""
        return np.array(self.flat, float)


def solve(order: int, phi: float, points: Points) -> Form:
    """Return the form; raises ValueError where a point has no place."""
    first = points[1]
    assert isinstance(first, LinePoint)
    a, (up, outwards) = Decimal(first.a), _turn(phi)
    flat: list[Spot] = [(ZERO, ZERO), (a, ZERO)]
    space: list[Spot] = [(ZERO,) * 3, (a * outwards, ZERO, a * up)]
    for i in range(2, len(points) + 1):
        point, out = points[i], _outward(i, order)
        if isinstance(point, LinePoint):
            flat.append(_scaled(out[:2], Decimal(point.a)))
            radii = [_away(flat[i], flat[k]) for k in (i - 2, i - 1)]
            space.append(_on_plane(space[i - 2 :], radii, out, point.branch))
        else:
            space.append(_plus(_scaled(out, Decimal(point.r)), (ZERO, ZERO, Decimal(point.z))))
            radii = [_away(space[i], space[k]) for k in (i - 2, i - 1)]
            flat.append(_in_pattern(flat[i - 2 :], radii, 1 if i % 2 == 0 else -1))
    return Form(order, flat, space)


def corner(
    form: Form, chain: Sequence[int], t: Sequence[float], sides: Sequence[int]
) -> list[np.ndarray]:
    """Return the corners (3,) of a closed blank's flap, each where three spheres meet.

    chain : A, the points off the line, B; t : mm from the centre, one for each point off the line.
    """
    out = _outward(chain[0], form.order)
    here, place = form.spatial[chain[0]], _dot(form.flat[chain[0]], out[:2])
    found = []
    for j, (each, side) in enumerate(zip(t, sides, strict=True)):
        tip = _scaled(out[:2], Decimal(each))
        ends = chain[j + 1 : j + 3]
        centres = [here, *(form.spatial[k] for k in ends)]
        radii = [abs(Decimal(each) - place), *(_away(form.flat[k], tip) for k in ends)]
        across = (-out[1], out[0], ZERO) if j == 0 else None
        here, place = _three_spheres(centres, radii, side, across), Decimal(each)
        found.append(np.array(here, float))
    return found


def _three_spheres(
    centres: list[Spot], radii: list[Decimal], side: int, across: Spot | None
) -> Spot:
    """Return the spot on the side of ``across``, or from which the centres run anticlockwise."""
    origin = centres[0]
    one, two = (_minus(centre, origin) for centre in centres[1:])
    normal = _cross(one, two)
    if across is not None and _dot(normal, across) < 0:
        normal = _scaled(normal, Decimal(-1))
    # X·one and X·two follow from the spheres; X = a·one + b·two + c·normal.
    sums = [
        (radii[0] ** 2 - radii[k + 1] ** 2 + _dot(step, step)) / 2
        for k, step in enumerate((one, two))
    ]
    square, shared, other = _dot(one, one), _dot(one, two), _dot(two, two)
    area = square * other - shared**2
    a = (sums[0] * other - sums[1] * shared) / area
    b = (sums[1] * square - sums[0] * shared) / area
    spot = _plus(_scaled(one, a), _scaled(two, b))
    left = radii[0] ** 2 - _dot(spot, spot)
    if left < 0:
        raise ValueError("the three spheres do not meet")
    rise = side * (left / _dot(normal, normal)).sqrt()
    return _plus(origin, _plus(spot, _scaled(normal, rise)))


def _on_plane(centres: list[Spot], radii: list[Decimal], out: Spot, branch: int) -> Spot:
    """Return where spheres about two centres meet the plane through the axis along ``out``."""
    base, other = centres
    step = _minus(other, base)
    height = (_dot(step, step) + radii[0] ** 2 - radii[1] ** 2) / 2
    across, up = _dot(step, out), step[2]
    size = across**2 + up**2
    left = radii[0] ** 2 - height**2 / size
    if left < 0:
        raise ValueError("the spheres do not meet the plane")
    swing = branch * (left / size).sqrt()
    alpha, rise = height * across / size - swing * up, height * up / size + swing * across
    return _plus(base, _plus(_scaled(out, alpha), (ZERO,) * 2 + (rise,)))


def _in_pattern(centres: list[Spot], radii: list[Decimal], turn: int) -> Spot:
    """Return where two circles of the plane meet, left of the line between for turn 1."""
    base, other = centres
    step = _minus(other, base)
    length = (_dot(step, step)).sqrt()
    along = (length**2 + radii[0] ** 2 - radii[1] ** 2) / (2 * length)
    left = radii[0] ** 2 - along**2
    if left < 0:
        raise ValueError("the circles do not meet")
    aside = turn * (left).sqrt()
    x, y = (part / length for part in step)
    return _plus(base, (along * x - aside * y, along * y + aside * x))


def _outward(i: int, order: int) -> Spot:
    """Return the unit vector (3,) of the plane of P_i, away from the axis."""
    return (Decimal(1), ZERO, ZERO) if i % 2 else (*_turn(Decimal(180) / order), ZERO)


@cache
def _turn(degrees: float | Decimal) -> tuple[Decimal, Decimal]:
    """Return cosine and sine of an angle."""
    with mpmath.workdps(DIGITS + 10):
        angle = mpmath.mpf(str(Decimal(degrees))) * mpmath.pi / 180
        cosine, sine = (Decimal(str(f(angle))) for f in (mpmath.cos, mpmath.sin))
    return cosine, sine


def _plus(a: Spot, b: Spot) -> Spot:
    return tuple(x + y for x, y in zip(a, b, strict=True))


def _minus(a: Spot, b: Spot) -> Spot:
    return tuple(x - y for x, y in zip(a, b, strict=True))


def _scaled(a: Spot, by: Decimal) -> Spot:
    return tuple(by * x for x in a)


def _dot(a: Spot, b: Spot) -> Decimal:
    return sum((x * y for x, y in zip(a, b, strict=True)), ZERO)


def _away(a: Spot, b: Spot) -> Decimal:
    step = _minus(a, b)
    return (_dot(step, step)).sqrt()


def _cross(a: Spot, b: Spot) -> Spot:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def random_lines(seed: int) -> tuple[int, float, dict[int, LinePoint]]:
    """Return N, φ and points that always have a place: all on their lines, a_i > a_{i-2}."""
    rng = np.random.default_rng(seed)
    reach = [0.0, float(rng.uniform(20, 60))]
    for _ in range(int(rng.integers(1, 8))):
        reach.append(reach[-2] + float(rng.uniform(5, 60)))
    points = {
        i: LinePoint(a=reach[i], branch=1 if rng.random() < 0.5 else -1)
        for i in range(1, len(reach))
    }
    return int(rng.integers(3, 16)), float(rng.uniform(0, 180)), points


def random_tucked(seed: int) -> tuple[int, float, dict[int, LinePoint | FreePoint]]:
    """Return N, φ and points, one or two of them by hand at least 1 mm inside their lines."""
    rng = np.random.default_rng(seed)
    while True:
        order, phi, lines = random_lines(int(rng.integers(2**32)))
        points: dict[int, LinePoint | FreePoint] = dict(lines)
        if len(points) < 4:
            continue
        first = int(rng.integers(2, len(points) - 1))
        both = first + 4 <= len(points) and rng.random() < 0.4
        try:
            for i in (first, first + 2) if both else (first,):
                points[i] = _moved(order, phi, points, i, rng)
            solved = strip.solve(order, phi, points)
        except InvalidInput:
            continue
        if solved.off_line and min(_beside(solved, i) for i in solved.off_line) > 1:
            return order, phi, points


def _moved(order: int, phi: float, points: Points, i: int, rng: np.random.Generator) -> FreePoint:
    solved = strip.solve(order, phi, {k: points[k] for k in range(1, i + 1)})
    r, z = solved.meridian[i] + rng.uniform(-15, 15, 2)
    return FreePoint(r=float(r), z=float(z))


def _beside(solved: strip.Strip, i: int) -> float:
    """Return how far p_i lies inside its line, mm."""
    (x, y), theta = solved.flat[i], solved.theta
    return float(y if i % 2 else x * np.sin(theta) - y * np.cos(theta))
