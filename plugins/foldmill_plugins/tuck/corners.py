"""Where the corners T of a flap are in space, for many choices of t at once.

T_i is where three spheres meet (thesis 4.1.1). About X (P_A, or the corner before), P_i and Q (the
next point, or P_B), with x, p, q the places of their feet on the line, q' the distance of the next
point from the line, and τ = t − x,

    (T − X)·(P_i − X) = τ (p − x)      (T − X)·(Q − X) = τ (q − x) + (|Q − X|² − (q − x)² − q'²) / 2

so T's foot in the plane X P_i Q is linear in τ, and the square of its height above it is quadratic,
never positive at τ = 0: T exists in one interval of t. The last corner of an open blank knows no Q:
it lies in the symmetry plane, or in the plane of the flap's facet before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.vectors import cross, lengths
from foldmill_plugins.tuck.blanks import Blank

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Corners:
    """S choices of the k corners of one flap."""

    t: Floats
    """(S, k) distances from the centre, mm."""
    spots: Floats
    """(S, k, 3) mm; not finite where there is none."""
    sides: Floats
    """(S, k) ±1."""
    low: Floats
    """(S, k) where the interval of t begins, given the corners before, mm."""
    high: Floats
    """(S, k) where it ends; not above ``low`` where no t has a T."""
    exists: Flags
    """(S,) whether all its corners exist."""

    def chosen(self, which: Flags | NDArray[np.intp]) -> Corners:
        """Return some of the choices."""
        t, spots, sides = self.t[which], self.spots[which], self.sides[which]
        return Corners(t, spots, sides, self.low[which], self.high[which], self.exists[which])


@dataclass(frozen=True, eq=False)
class _Spheres:
    """T over the plane X P_i Q for S places of X: along X-P_i, across it, and above the plane.

    Everything is measured from P_i and from the line X-P_i: T may lie as near to them as a sliver
    of paper, and a difference of long lengths would lose it.
    """

    to_point: Floats
    """(S, 3) P_i − X."""
    length: Floats
    """(S,) its length."""
    one: Floats
    """(S, 3) its direction."""
    two: Floats
    """(S, 3) across it, towards Q; zeros on the rim, where there is no Q."""
    normal: Floats
    """(S, 3) above the plane."""
    ahead: Floats
    """(S,) p − x."""
    beside: float
    """p', the distance of p_i from the line."""
    rest: Floats
    second: Floats
    """(S,) T is rest + τ·second across."""

    def squared_height(self, tau: Floats) -> Floats:
        """Return the square of T's height above the plane (S,)."""
        apart, across = tau * self.beside / self.length, self.rest + tau * self.second
        square: Floats = (apart - across) * (apart + across)
        return square

    def step(self, tau: Floats, height: Floats) -> Floats:
        """Return T − X (S, 3)."""
        beyond = ((tau - self.ahead) * self.ahead - self.beside**2) / self.length
        across = self.rest + tau * self.second
        inside = self.to_point + beyond[:, None] * self.one + across[:, None] * self.two
        step: Floats = inside + height[:, None] * self.normal
        return step

    def reach(self) -> tuple[Floats, Floats]:
        """Return the interval (low, high) of τ in which T exists; it may be empty."""
        slope = self.beside / self.length
        a = (slope - self.second) * (slope + self.second)
        b = -2 * self.rest * self.second
        c = -self.rest * self.rest
        disc = b * b - 4 * a * c
        q = -(b + np.where(b < 0, -1.0, 1.0) * np.sqrt(np.maximum(disc, 0.0))) / 2
        one, two = q / a, np.where(q == 0, 0.0, c / q)
        low, high = np.fmin(one, two), np.fmax(one, two)
        rises = a >= 0
        low, high = np.where(rises, high, low), np.where(rises, np.inf, high)
        return np.where(disc < 0, np.inf, low), high


def place(blank: Blank, shares: Floats, sides: Floats, given: Sequence[float | None]) -> Corners:
    """Return corners at shares (S, k) in (0, 1) of their intervals, or at the t that are given.

    sides : (S, k) ±1; given : k distances from the centre, mm, or None.
    """
    count, k = shares.shape
    t, low, high = (np.zeros((count, k)) for _ in range(3))
    spots = np.zeros((count, k, 3))
    exists = np.ones(count, bool)
    x, spot = np.full(count, blank.start), np.broadcast_to(blank.spatial[0], (count, 3))
    with np.errstate(all="ignore"):
        for j in range(k):
            spheres = _spheres(blank, j, x, spot)
            low[:, j], high[:, j] = _interval(blank, j, x, spheres)
            fixed = given[j]
            within = low[:, j] + shares[:, j] * (high[:, j] - low[:, j])
            t[:, j] = within if fixed is None else fixed
            square = spheres.squared_height(t[:, j] - x)
            is_rim = _is_rim(blank, j)
            exists &= (t[:, j] > low[:, j]) & ((t[:, j] < high[:, j]) | is_rim) & (square >= 0)
            height = (1.0 if is_rim and j else sides[:, j]) * np.sqrt(square)
            spots[:, j] = spot + spheres.step(t[:, j] - x, height)
            x, spot = t[:, j], spots[:, j]
    return Corners(t, spots, sides, low, high, exists & np.isfinite(spots).all(axis=(1, 2)))


def _is_rim(blank: Blank, j: int) -> bool:
    return blank.is_open and j == len(blank.points) - 1


def _interval(blank: Blank, j: int, x: Floats, spheres: _Spheres) -> tuple[Floats, Floats]:
    """Return where t_j has a T, lies on its segment, and turns no triangle of the flap over."""
    low, high = spheres.reach()
    if _is_rim(blank, j):  # the rim may be anywhere; a share of 1 is where it is straight
        return x, np.where(x < blank.end, blank.end, x + blank.beside[j + 1])
    low, high = x + np.fmax(low, 0.0), np.fmin(x + high, blank.end)
    rise = blank.beside[j + 2] - blank.beside[j + 1]
    offset = blank.beside[j + 1] * blank.feet[j + 2] - blank.feet[j + 1] * blank.beside[j + 2]
    if rise < 0:
        high = np.fmin(high, offset / -rise)
    elif rise > 0:
        low = np.fmax(low, -offset / rise)
    elif offset <= 0:
        high = low
    return low, high


def _spheres(blank: Blank, j: int, x: Floats, spot: Floats) -> _Spheres:
    to_point = blank.spatial[j + 1] - spot
    reach = lengths(to_point)
    one = to_point / reach[:, None]
    ahead, beside = blank.feet[j + 1] - x, float(blank.beside[j + 1])
    if _is_rim(blank, j):
        two, none = np.zeros_like(spot), np.zeros(len(spot))
        normal = _rim_normal(blank, j, spot, one)
        return _Spheres(to_point, reach, one, two, normal, ahead, beside, none, none)
    to_next = blank.spatial[j + 2] - spot
    two = _unit(to_next - np.einsum("si,si->s", to_next, one)[:, None] * one)
    part_one = np.einsum("si,si->s", to_next, one)
    part_two = np.einsum("si,si->s", to_next, two)
    far = blank.feet[j + 2] - x
    spare = (np.einsum("si,si->s", to_next, to_next) - far**2 - blank.beside[j + 2] ** 2) / 2
    rest, second = spare / part_two, (far - ahead / reach * part_one) / part_two
    normal = np.broadcast_to(blank.across, one.shape) if j == 0 else cross(one, two)
    return _Spheres(to_point, reach, one, two, normal, ahead, beside, rest, second)


def _rim_normal(blank: Blank, j: int, spot: Floats, one: Floats) -> Floats:
    """Return the direction from the line X-P_j in which the rim's corner lies."""
    if j == 0:
        return cross(np.broadcast_to(blank.across, one.shape), one)
    back = spot - blank.spatial[j]
    return _unit(back - np.einsum("si,si->s", back, one)[:, None] * one)


def _unit(vectors: Floats) -> Floats:
    unit: Floats = vectors / lengths(vectors)[:, None]
    return unit
