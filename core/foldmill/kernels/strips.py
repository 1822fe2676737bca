"""Solve strips and test their half wedges for penetration, row by row: the form that is compiled.

Every function is plain Python over arrays and numbers, and runs uncompiled as well. They stand in
one file because numba looks only there to see whether what it kept is old.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from foldmill.kernels.jit import jit

Floats = NDArray[np.float64]
FREE, PENETRATES, NO_CANDIDATE, CROSSES_AXIS, TURNS_FREELY, UNSETTLED = range(6)


@jit
def judge(
    wheel: NDArray[np.int64],
    wheels: Floats,
    start: Floats,
    paper: Floats,
    branches: Floats,
    limits: Floats,
    codes: NDArray[np.uint8],
    at: NDArray[np.int32],
    extents: Floats,
) -> None:
    """Fill codes (n,), at (n,) and extents (n, 3); the arguments are those of ``Strips``.

    wheel : (n,) or (1,) rows of ``wheels``, (u, 10) as ``tables.wheels`` returns them;
    limits : (6,) as ``Limits.as_row``. Arrays of one row hold for all.
    """
    points = paper.shape[1] + 2
    spots = np.zeros((4, points))
    heights = np.zeros((points - 2, points))
    normals = np.zeros((points - 2, 4))
    for row in range(len(start)):
        spin = wheels[wheel[row if len(wheel) > 1 else 0]]
        sheet = row if len(paper) > 1 else 0
        turns = branches[row if len(branches) > 1 else 0]
        code, where = solve(start[row], paper[sheet], turns, spin, limits, spots)
        if code == FREE:
            extent = extents[row]
            stretch(spots, spin, extent)
            code = verdict(spots, spin, limits, extent.max(), normals, heights)
        codes[row] = code
        at[row] = where


@jit
def solve(
    start: Floats, paper: Floats, branches: Floats, spin: Floats, limits: Floats, spots: Floats
) -> tuple[int, int]:
    """Fill spots[0] and spots[1] with r and z of all points; return FREE, or what fails and at k.

    The formula and the snapping rule of ``foldmill.axisymmetric.strip``.
    """
    r, z = spots[0], spots[1]
    r[0], z[0], r[1], z[1] = start[0], start[1], start[2], start[3]
    low, high = limits[2], limits[3]
    for k in range(2, len(r)):
        d, c, h, size = paper[k - 2, 0], paper[k - 2, 1], paper[k - 2, 2], paper[k - 2, 3]
        s = abs(r[k - 1]) * spin[1]
        across, up = r[k - 1] * spin[0] - r[k - 2], z[k - 1] - z[k - 2]
        D = sqrt(across * across + up * up)
        if limits[5] * size >= D:
            return TURNS_FREELY, k
        foot = abs(c)
        squared = (h - s) * (h + s) if h <= foot else (D - foot) * (D + foot)
        noise = limits[1] * size * min(foot, h)
        if abs(squared) <= high * noise:
            if abs(squared) > low * noise:
                return UNSETTLED, k
            squared = 0.0
        elif squared < 0:
            return (UNSETTLED if s <= h else NO_CANDIDATE), k
        half = branches[k - 2] * sqrt(squared)
        share = d / (D * sqrt(c * c + squared))
        r[k] = r[k - 2] + share * (c * across - half * up)
        z[k] = z[k - 2] + share * (c * up + half * across)
    return FREE, -1


@jit
def stretch(spots: Floats, spin: Floats, extent: Floats) -> None:
    """Fill extent (3,) with the box of all copies of the points."""
    r, z = spots[0], spots[1]
    left, right, side, low, high = inf, -inf, 0.0, inf, -inf
    for k in range(len(r)):
        reach = 4 + 3 * (k % 2)
        one, two = r[k] * spin[reach], r[k] * spin[reach + 1]
        left, right = min(left, one, two), max(right, one, two)
        side = max(side, abs(r[k]) * spin[reach + 2])
        low, high = min(low, z[k]), max(high, z[k])
    extent[0], extent[1], extent[2] = right - left, 2 * side, high - low


@jit
def verdict(
    spots: Floats, spin: Floats, limits: Floats, size: float, normals: Floats, heights: Floats
) -> int:
    """Return FREE, PENETRATES, CROSSES_AXIS or UNSETTLED for a solved strip.

    size : the largest side of the whole form's box, mm; normals, heights : room for them.
    """
    r = spots[0]
    inner, outer = min(0.0, r.min()), max(0.0, r.max())
    if inner < 0 < outer:
        depth = min(-inner, outer) * spin[2]
        return CROSSES_AXIS if depth > limits[4] * size else UNSETTLED
    # The two planes are put at ±Θ/2, which spares a case for odd and even.
    for k in range(len(r)):
        spots[2, k] = r[k] * spin[2]
        spots[3, k] = r[k] * spin[3] if k % 2 else -r[k] * spin[3]
    eps = limits[0] * size
    measure(spots, normals, heights)
    if crosses(spots, normals, heights, eps) or slides(spots, normals, heights, eps):
        return PENETRATES
    return FREE


@jit
def measure(spots: Floats, normals: Floats, heights: Floats) -> None:
    """Fill normals (F, 4) with x, y, z, length, and heights (F, K) of points times that length."""
    x, y, z = spots[2], spots[3], spots[1]
    for f in range(len(heights)):
        ux, uy, uz = x[f + 1] - x[f], y[f + 1] - y[f], z[f + 1] - z[f]
        vx, vy, vz = x[f + 2] - x[f], y[f + 2] - y[f], z[f + 2] - z[f]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        normals[f, 0], normals[f, 1], normals[f, 2] = nx, ny, nz
        normals[f, 3] = sqrt(nx * nx + ny * ny + nz * nz)
        for k in range(len(x)):
            heights[f, k] = nx * (x[k] - x[f]) + ny * (y[k] - y[f]) + nz * (z[k] - z[f])


@jit
def straddles(height: Floats, first: int, eps: float) -> bool:
    """Tell whether the triangle from point ``first`` on has corners on both sides, beyond eps."""
    a, b, c = height[first], height[first + 1], height[first + 2]
    return bool(min(a, b, c) < -eps and max(a, b, c) > eps)


@jit
def crosses(spots: Floats, normals: Floats, heights: Floats, eps: float) -> bool:
    """Tell whether two triangles that share no edge pass through each other by more than eps."""
    count = len(heights)
    for f in range(count - 2):
        limit = eps * normals[f, 3]
        for g in range(f + 2, count):
            if (
                straddles(heights[f], g, limit)
                and straddles(heights[g], f, eps * normals[g, 3])
                and overlap(spots, normals, heights, f, g) > eps
            ):
                return True
    return False


@jit
def overlap(spots: Floats, normals: Floats, heights: Floats, f: int, g: int) -> float:
    """Return how long triangles f and g overlap along the line of their planes, mm."""
    ax, ay, az = normals[f, 0], normals[f, 1], normals[f, 2]
    bx, by, bz = normals[g, 0], normals[g, 1], normals[g, 2]
    lx, ly, lz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    length = sqrt(lx * lx + ly * ly + lz * lz)
    if length == 0:
        return 0.0
    line = (lx / length, ly / length, lz / length)
    low_f, high_f = span(spots, heights[g], f, line)
    low_g, high_g = span(spots, heights[f], g, line)
    return min(high_f, high_g) - max(low_f, low_g)


@jit
def span(
    spots: Floats, height: Floats, first: int, line: tuple[float, float, float]
) -> tuple[float, float]:
    """Return where a triangle's cut with the other plane begins and ends along a line."""
    low, high = inf, -inf
    for corner in range(3):
        a, b = first + corner, first + (corner + 1) % 3
        if height[a] * height[b] < 0 or height[a] == 0:
            one = spots[2, a] * line[0] + spots[3, a] * line[1] + spots[1, a] * line[2]
            two = spots[2, b] * line[0] + spots[3, b] * line[1] + spots[1, b] * line[2]
            share = 0.0 if height[a] == height[b] else height[a] / (height[a] - height[b])
            spot = one + share * (two - one)
            low, high = min(low, spot), max(high, spot)
    return low, high


@jit
def slides(spots: Floats, normals: Floats, heights: Floats, eps: float) -> bool:
    """Tell whether the strip passes through a triangle exactly along one of its own creases."""
    count = len(heights)
    for f in range(count):
        height, limit = heights[f], eps * normals[f, 3]
        for e in range(count - 1):
            if abs(height[e + 1]) > limit or abs(height[e + 2]) > limit or f == e or f == e + 1:
                continue
            left, right = height[e], height[e + 3]
            if (
                min(left, right) < -limit
                and max(left, right) > limit
                and inside(spots, normals[f], e + 1, f, eps) > eps
            ):
                return True
    return False


@jit
def inside(spots: Floats, normal: Floats, start: int, first: int, eps: float) -> float:
    """Return what length of the edge from ``start`` on is inside a triangle by more than eps."""
    x, y, z = spots[2], spots[3], spots[1]
    low, high = 0.0, 1.0
    sx, sy, sz = x[start + 1] - x[start], y[start + 1] - y[start], z[start + 1] - z[start]
    for corner in range(3):
        a, b = first + corner, first + (corner + 1) % 3
        ux, uy, uz = x[b] - x[a], y[b] - y[a], z[b] - z[a]
        ix = normal[1] * uz - normal[2] * uy
        iy = normal[2] * ux - normal[0] * uz
        iz = normal[0] * uy - normal[1] * ux
        length = sqrt(ix * ix + iy * iy + iz * iz)
        away = (x[start] - x[a]) * ix + (y[start] - y[a]) * iy + (z[start] - z[a]) * iz
        offset, slope = away / length - eps, (sx * ix + sy * iy + sz * iz) / length
        if abs(slope) <= eps:
            if offset <= 0:
                return 0.0
        elif slope > 0:
            low = max(low, -offset / slope)
        else:
            high = min(high, -offset / slope)
    return max(0.0, high - low) * sqrt(sx * sx + sy * sy + sz * sz)
