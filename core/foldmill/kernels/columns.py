"""Solve strips and test their half wedges over whole columns: what is used where numba is not.

The same rules as in ``strips``, one NumPy call for many rows. Pairs of triangles that straddle each
other go to the check's own ``cut_lengths``, so that the exact rule stands in one place.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from foldmill.check.triangles import cut_lengths
from foldmill.kernels.tables import CODES, stretch

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
N = TypeVar("N", bound=np.generic)

BLOCK = 4096
"""Rows in one go: what nine points need then stays in a processor's cache."""


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
    """Fill codes (n,), at (n,) and extents (n, 3); the arguments are those of ``strips.judge``."""
    for first in range(0, len(start), BLOCK):
        rows = slice(first, first + BLOCK)
        spin = wheels[_rows(wheel, rows)]
        sheet = _rows(paper, rows), _rows(branches, rows)
        spots, codes[rows], at[rows] = _solve(start[rows], sheet, spin, limits)
        solved = np.flatnonzero(codes[rows] == CODES.FREE)
        spots, spin = spots[:, solved], spin[solved] if len(spin) > 1 else spin
        extent = stretch(spots, spin)
        extents[first + solved] = extent
        codes[first + solved] = _verdicts(spots, spin, limits, extent.max(axis=1, initial=0.0))


def _rows(array: NDArray[N], rows: slice) -> NDArray[N]:
    return array[rows] if len(array) > 1 else array


def _solve(
    start: Floats, sheet: tuple[Floats, Floats], spin: Floats, limits: Floats
) -> tuple[Floats, NDArray[np.uint8], NDArray[np.int32]]:
    """Return r and z (2, n, K), codes (n,) and at (n,)."""
    paper, branches = sheet
    count, steps = len(start), paper.shape[1]
    r, z = np.full((2, count, steps + 2), np.nan)
    r[:, :2], z[:, :2] = start[:, ::2], start[:, 1::2]
    codes, at = np.zeros(count, np.uint8), np.full(count, -1, np.int32)
    for k in range(2, steps + 2):
        triangle = paper[:, k - 2]
        s = np.abs(r[:, k - 1]) * spin[:, 1]
        across, up = r[:, k - 1] * spin[:, 0] - r[:, k - 2], z[:, k - 1] - z[:, k - 2]
        with np.errstate(invalid="ignore", divide="ignore"):
            D = np.sqrt(across * across + up * up)
            squared, fault = _half_chord(triangle, s, D, limits)
            d, c = triangle[:, 0], triangle[:, 1]
            half = branches[:, k - 2] * np.sqrt(squared)
            share = d / (D * np.sqrt(c * c + squared))
            new = (fault > 0) & (codes == 0)
            codes[new], at[new] = fault[new], k
            share = np.where(codes > 0, np.nan, share)
            r[:, k] = r[:, k - 2] + share * (c * across - half * up)
            z[:, k] = z[:, k - 2] + share * (c * up + half * across)
    return np.stack([r, z]), codes, at


def _half_chord(
    triangle: Floats, s: Floats, D: Floats, limits: Floats
) -> tuple[Floats, NDArray[np.uint8]]:
    """Return the squared half-chord (n,) and what fails (n,): FREE where nothing does."""
    _, c, h, size = triangle.T
    _, snap, low, high, _, turn = limits
    foot = np.abs(c)
    squared = np.where(h <= foot, (h - s) * (h + s), (D - foot) * (D + foot))
    noise = snap * size * np.minimum(foot, h)
    is_none = np.abs(squared) <= high * noise
    fault = np.where(is_none & (np.abs(squared) > low * noise), CODES.UNSETTLED, CODES.FREE)
    missing = np.where(s <= h, CODES.UNSETTLED, CODES.NO_CANDIDATE)
    fault = np.where(~is_none & (squared < 0), missing, fault)
    fault = np.where(turn * size >= D, CODES.TURNS_FREELY, fault)
    return np.where(is_none, 0.0, squared), fault.astype(np.uint8)


def _verdicts(spots: Floats, spin: Floats, limits: Floats, size: Floats) -> NDArray[np.uint8]:
    """Return the codes (n,) of solved strips (2, n, K)."""
    r = spots[0]
    inner, outer = np.minimum(r.min(axis=1), 0.0), np.maximum(r.max(axis=1), 0.0)
    beyond = np.minimum(-inner, outer)
    is_sure = beyond * spin[:, 2] > limits[4] * size
    codes = np.where(is_sure, CODES.CROSSES_AXIS, CODES.UNSETTLED).astype(np.uint8)
    rest = np.flatnonzero(beyond == 0)
    spin = spin[rest] if len(spin) > 1 else spin
    hit = _penetrates(spots[:, rest], spin, limits[0], size[rest])
    codes[rest] = np.where(hit, CODES.PENETRATES, CODES.FREE)
    return codes


def _penetrates(spots: Floats, spin: Floats, limit: float, size: Floats) -> Flags:
    """Tell which half wedges (2, n, K) pass through themselves, measured in their own size."""
    r, z = spots / size[:, None]
    sign = np.where(np.arange(r.shape[1]) % 2 == 1, 1.0, -1.0)
    points = np.stack([r * spin[:, 2, None], r * spin[:, 3, None] * sign, z], axis=2)
    corners = np.stack([points[:, :-2], points[:, 1:-1], points[:, 2:]], axis=2)
    normals = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    offset = (normals * corners[:, :, 0]).sum(axis=2)
    heights = normals @ points.transpose(0, 2, 1) - offset[:, :, None]
    hit: Flags = np.zeros(len(points), bool)
    hit[_crossing(corners, heights, limit)] = True
    hit[_sliding(points, normals, heights, limit)] = True
    return hit


def _crossing(corners: Floats, heights: Floats, limit: float) -> NDArray[np.intp]:
    """Return the rows in which two triangles that share no edge pass through each other."""
    low = np.minimum(np.minimum(heights[..., :-2], heights[..., 1:-1]), heights[..., 2:])
    high = np.maximum(np.maximum(heights[..., :-2], heights[..., 1:-1]), heights[..., 2:])
    straddles = (low < -limit) & (high > limit)
    both = straddles & straddles.transpose(0, 2, 1)
    row, f, g = np.nonzero(np.triu(both, 2))
    rows: NDArray[np.intp] = row[cut_lengths(corners[row, f], corners[row, g], limit) > 0]
    return rows


def _sliding(points: Floats, normals: Floats, heights: Floats, limit: float) -> list[int]:
    """Return the rows in which the strip passes through a triangle along one of its creases."""
    in_plane = np.abs(heights) <= limit
    left, right = heights[:, :, :-3], heights[:, :, 3:]
    passes = in_plane[:, :, 1:-2] & in_plane[:, :, 2:-1]
    passes &= (np.minimum(left, right) < -limit) & (np.maximum(left, right) > limit)
    faces, creases = np.arange(passes.shape[1])[:, None], np.arange(passes.shape[2])
    passes &= (faces != creases) & (faces != creases + 1)
    if not passes.any():
        return []
    from foldmill.kernels.strips import inside  # loads numba, where it is

    found = []
    for row, f, e in zip(*np.nonzero(passes), strict=True):
        x, y, z = points[row].T
        spots = np.stack([x, z, x, y])  # as ``strips`` keeps them: r is not looked at
        if inside(spots, np.append(normals[row, f], 1.0), e + 1, f, limit) > limit:
            found.append(int(row))
    return found
