"""A slow second way to solve a six-crease strip, by spheres and planes in space, and random strips.

Nothing here is shared with the solver under test: two spheres give their radical plane, that and
the plane of the point a line, and the line meets a sphere twice. Fifty digits are kept, so that a
difference is the other one's rounding.
"""

from __future__ import annotations

from decimal import Decimal, getcontext
from math import cos, pi, sin

import numpy as np

from foldmill_plugins.six_crease.params import HeightPoint, SixCreaseParams

getcontext().prec = 50
Vector = tuple[Decimal, Decimal, Decimal]


def random_design(seed: int) -> SixCreaseParams:
    """Return parameters that may or may not have a form: N 3…16, T 4…11."""
    rng = np.random.default_rng(seed)
    n, w = int(rng.integers(3, 17)), float(rng.uniform(5, 40))
    y = [0.0, float(rng.uniform(-1, 1) * w)]
    for _ in range(int(rng.integers(2, 10))):
        y.append(y[-2] + float(rng.uniform(0.2, 3) * w))
    phi = float(rng.uniform(5, 175))
    bound = np.hypot(w, y[1]) / sin(pi / n) / sin(np.radians(phi))
    points = {
        i: HeightPoint(y=height, branch=1 if rng.random() < 0.5 else -1)
        for i, height in enumerate(y, start=1)
    }
    return SixCreaseParams(
        n=n,
        w=w,
        L=float(rng.uniform(0, 0.8) * bound),
        phi=phi,
        beta=float(rng.uniform(0, 360)),
        points=points,
    )


def by_spheres(params: SixCreaseParams) -> list[tuple[float, float]] | int:
    """Return P_1 … P_T as (r, z), mm, or the number of the first point without a place."""
    theta = pi / params.n
    outward = [_vector(1, 0, 0), _vector(cos(theta), sin(theta), 0)]
    normal = _vector(-sin(theta), cos(theta), 0)
    w, y = Decimal(params.w), [Decimal(point.y) for point in params.points.values()]
    tilt, beta = np.radians(params.phi), np.radians(params.beta)
    places = [_vector(params.L * sin(tilt), 0, params.L * cos(tilt))]
    depth = _dot(places[0], normal)
    foot = _add(places[0], normal, -depth)
    squared = w * w + (y[1] - y[0]) ** 2 - depth * depth
    if squared < 0:
        return 2
    swing = _add(_vector(0, 0, cos(beta)), outward[1], Decimal(sin(beta)))
    places.append(_add(foot, swing, squared.sqrt()))
    for k in range(2, len(y)):
        branch = params.points[k + 1].branch
        far, near = (y[k] - y[k - 2]) ** 2, w * w + (y[k] - y[k - 1]) ** 2
        spot = _meet(places[k - 2 : k], (far, near), outward[k % 2], branch)
        if spot is None:
            return k + 1
        places.append(spot)
    return [(float(_dot(spot, outward[k % 2])), float(spot[2])) for k, spot in enumerate(places)]


def _meet(
    centres: list[Vector],
    squares: tuple[Decimal, Decimal],
    outward: Vector,
    branch: int,
) -> Vector | None:
    """Return where spheres about the centres (of squared radii) meet the plane through the axis."""
    base, other = centres
    step = _add(other, base, Decimal(-1))
    # The radical plane: (X − base)·step = (|step|² + R_base² − R_other²) / 2.
    height = (_dot(step, step) + squares[0] - squares[1]) / 2
    across, up = _dot(step, outward), step[2]
    size = across * across + up * up
    # base lies in the plane; X = base + α·outward + β·z with α·across + β·up = height.
    left = squares[0] - height * height / size
    if left < 0:
        return None
    swing = branch * (left / size).sqrt()
    alpha = height * across / size - swing * up
    rise = height * up / size + swing * across
    return _add(_add(base, outward, alpha), _vector(0, 0, 1), rise)


def _vector(x: float, y: float, z: float) -> Vector:
    return Decimal(x), Decimal(y), Decimal(z)


def _dot(a: Vector, b: Vector) -> Decimal:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _add(a: Vector, b: Vector, share: Decimal) -> Vector:
    return a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]
