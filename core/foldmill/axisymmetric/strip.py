"""Solve one half wedge: a strip of triangles (i-2, i-1, i) between two planes through the axis.

One formula serves every axisymmetric family. With d, u, c, h measured in the flat pattern,

    s = |r_{i-1}| sin Θ
    q = (r_{i-1} cos Θ − r_{i-2},  z_{i-1} − z_{i-2}),   D = |q|
    P_i = P_{i-2} + d (c·q + b·sqrt(h² − s²)·q⊥) / D²,   q⊥ = (−q_z, q_r),   b = ±1

It is the intersection of two circles in the plane of P_i (thesis 3.2.2), with h² − s² = D² − c².
Two places exist where s < h, one where s = h; where D = 0 the circles are one (thesis 3.2.3) and
the direction γ of P_{i-2}P_i is free.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.errors import ImpossibleGeometry, InvalidParameters, NoCandidate
from foldmill.tolerances import COINCIDENT_MM, ON_LINE, SNAP_EPSILONS

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Strip:
    """A solved half wedge."""

    order: int
    """N."""
    flat: Floats
    """(T+1, 2) p_0 … p_T, mm."""
    meridian: Floats
    """(T+1, 2) P_0 … P_T as (r, z) in their planes, mm; r is signed."""
    off_line: tuple[int, ...]
    """Points strictly inside the wedge: each leaves a blank beside it."""
    crossing: tuple[int, ...] = ()
    """Points beyond their line, only where they were not refused: no sheet has paper for them."""

    @property
    def theta(self) -> float:
        """Θ = π/N, rad."""
        return float(np.pi / self.order)

    @cached_property
    def spatial(self) -> Floats:
        """(T+1, 3) the points in space: odd ones at azimuth 0, even ones at Θ."""
        azimuth = np.where(np.arange(len(self.meridian)) % 2 == 0, self.theta, 0.0)
        r, z = self.meridian.T
        return np.column_stack([r * np.cos(azimuth), r * np.sin(azimuth), z])

    @property
    def one_sided(self) -> bool:
        """True where no point crosses the axis to the other side."""
        return on_one_side(self.meridian[1:])


def on_one_side(meridian: Floats) -> bool:
    """Tell whether no radius of points (n, 2) as (r, z) has another sign than the others.

    One that lies on the axis but for rounding has none.
    """
    r, size = meridian[:, 0], float(np.abs(meridian).max())
    return bool((r >= -ON_LINE * size).all() or (r <= ON_LINE * size).all())


def solve(
    order: int,
    phi: float,
    points: Mapping[int, LinePoint | FreePoint],
    *,
    refuse_crossing: bool = True,
) -> Strip:
    """Solve the strip from its centre outwards.

    order : N ≥ 3; phi : deg in [0, 180]; points : p_1 … p_T by number;
    refuse_crossing : false keeps points beyond their line, for a report on them.
    Raises InvalidParameters for contradicting points, ImpossibleGeometry where a P_i has no place
    or lies beyond its symmetry line; both name i and by how much.
    """
    theta, count = np.pi / order, len(points) + 1
    flat, meridian = np.zeros((count, 2)), np.zeros((count, 2))
    first = points[1]
    if not isinstance(first, LinePoint):
        raise InvalidParameters("Point 1 lies on its line; it is moved by a and φ, not by r and z.")
    flat[1] = (first.a, 0.0)
    meridian[1] = first_point(first.a, phi)
    _refuse_near(1, flat)
    off_line: list[int] = []
    crossing: list[int] = []
    for i in range(2, count):
        point = points[i]
        if isinstance(point, LinePoint):
            flat[i] = _on_line(i, point, flat, theta)
            _refuse_near(i, flat)
            meridian[i] = _place(i, point, flat, meridian, theta)
        else:
            meridian[i] = (point.r, point.z)
            flat[i] = _unfold(i, flat, meridian, theta)
            _refuse_near(i, flat)
            side = _side_of_line(i, flat, theta)
            if side < 0 and refuse_crossing:
                raise _crossing_refusal(i, flat, theta)
            if side:
                (off_line if side > 0 else crossing).append(i)
            else:
                meridian[i] = _settled(i, flat, meridian, theta)
    return Strip(order, flat, meridian, tuple(off_line), tuple(crossing))


def _refuse_near(i: int, flat: Floats) -> None:
    """Refuse p_i where an edge from it to a point before it would have no length."""
    for j in range(max(0, i - 2), i):
        away = float(np.hypot(*(flat[i] - flat[j])))
        if away < COINCIDENT_MM:
            other = f"point {j}" if j else "the centre"
            raise InvalidParameters(
                f"Point {i} lies on {other}: {away:.2g} mm are less than the {COINCIDENT_MM:g} mm "
                f"that tell two points apart. Move point {i} outwards."
            )


def first_point(a: float, phi: float) -> Floats:
    """Return P_1 as (r, z), mm, for its distance a from the centre and φ in deg."""
    return a * np.array([_sine(phi), np.cos(np.radians(phi)) if phi != 90 else 0.0])


def _sine(degrees: float) -> float:
    return 0.0 if degrees in {0, 180} else float(np.sin(np.radians(degrees)))


def _direction(i: int, theta: float) -> Floats:
    return np.array([np.cos(theta), np.sin(theta)]) if i % 2 == 0 else np.array([1.0, 0.0])


def _on_line(i: int, point: LinePoint, flat: Floats, theta: float) -> Floats:
    along = _direction(i, theta)
    inner = float(flat[i - 2] @ along)
    if point.a <= inner:
        raise InvalidParameters(
            f"Point {i} must lie farther out than point {i - 2}: a = {point.a:g} mm, "
            f"but point {i - 2} is at {inner:g} mm. Give point {i} more than {inner:g} mm."
        )
    spot: Floats = point.a * along
    if _turn(flat[i - 2], flat[i - 1], spot) * (1 if i % 2 == 0 else -1) <= 0:
        raise InvalidParameters(
            f"Point {i} turns the triangle {i - 2}-{i - 1}-{i} over; give it a larger a."
        )
    return spot


def _turn(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _place(i: int, point: LinePoint, flat: Floats, meridian: Floats, theta: float) -> Floats:
    remedy = f"Bring point {i - 1} nearer to the axis, or move it outwards in the pattern."
    side, before = Side(point.branch, point.gamma), meridian[i - 2 : i]
    return place(i, Paper.of(flat, i), side, before, theta, remedy)


@dataclass(frozen=True)
class Paper:
    """A triangle (i-2, i-1, i) of the flat pattern, mm."""

    d: float
    """Length of its side p_{i-2}p_i."""
    c: float
    """Distance of the foot of p_{i-1} from p_{i-2} along that side."""
    h: float
    """Distance of p_{i-1} from the line of that side."""
    size: float
    """The largest coordinate of the pattern, against which rounding is measured."""

    @classmethod
    def of(cls, flat: Floats, i: int) -> Paper:
        """Return the triangle (i-2, i-1, i) of points p_0 … p_T (T+1, 2), mm."""
        base, across = flat[i - 2], flat[i - 1]
        d = float(np.hypot(*(flat[i] - base)))
        c = float((across - base) @ (flat[i] - base)) / d
        return cls(d, c, abs(_turn(base, flat[i], across)) / d, float(np.abs(flat).max()))


@dataclass(frozen=True)
class Side:
    """Which of its places a point takes."""

    branch: int
    """b = ±1."""
    gamma: float | None
    """Direction of P_{i-2}P_i, deg, where every direction is possible."""


def place(i: int, paper: Paper, side: Side, before: Floats, theta: float, remedy: str) -> Floats:
    """Return P_i as (r, z), mm.

    before : (2, 2) P_{i-2} and P_{i-1}; theta : rad; remedy : what to do where it has no place.
    Raises NoCandidate where P_i has no place, InvalidParameters where its γ is missing.
    """
    s, q = _apart(before[0], before[1], theta)
    if _is_one_circle(paper, q):
        return _place_freely(i, side.gamma, before[0], paper.d)
    spot = meet(paper, side.branch, before[0], before[1], theta)
    if not np.isfinite(spot).all():
        raise NoCandidate(
            f"Point {i} has no place: point {i - 1} is {s:.6g} mm from its plane, and only "
            f"{paper.h:.6g} mm of paper reach there ({s - paper.h:.3g} mm too few). {remedy}",
            point=i,
        )
    return spot


def meet(paper: Paper, branch: int, base: Floats, across: Floats, theta: ArrayLike) -> Floats:
    """Return P_i (..., 2) for many forms of one pattern at once; NaN where it has no one place.

    base, across : (..., 2) P_{i-2} and P_{i-1} as (r, z), mm; theta : (...) rad.
    """
    s, q = _apart(base, across, theta)
    D = np.hypot(q[..., 0], q[..., 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        half_chord = np.sqrt(_squared_half_chord(paper, s, D))[..., None]
        normal = np.stack([-q[..., 1], q[..., 0]], axis=-1)
        # √(c² + half²) is D; so the step is as long as in the pattern, however small D is.
        reach = D[..., None] * np.hypot(paper.c, half_chord)
        steps = paper.d * (paper.c * q + branch * half_chord * normal) / reach
    spot: Floats = base + np.where(_is_one_circle(paper, q)[..., None], np.nan, steps)
    return spot


def _apart(base: Floats, across: Floats, theta: ArrayLike) -> tuple[Floats, Floats]:
    """Return s, the distance of P_{i-1} from the plane of P_i, and q, from P_{i-2} to its foot."""
    r, z = across[..., 0], across[..., 1]
    q = np.stack([r * np.cos(theta) - base[..., 0], z - base[..., 1]], axis=-1)
    return np.abs(r) * np.sin(theta), q


def _is_one_circle(paper: Paper, q: Floats) -> NDArray[np.bool_]:
    tiny = SNAP_EPSILONS * np.finfo(float).eps * paper.size
    return np.asarray(np.hypot(q[..., 0], q[..., 1]) <= tiny)


def _place_freely(i: int, gamma: float | None, base: Floats, d: float) -> Floats:
    if gamma is None:
        raise InvalidParameters(
            f"Point {i} can turn freely about point {i - 2} here (their circles are one): "
            f"give it a direction, points.{i}.gamma, in degrees."
        )
    angle = np.radians(gamma)
    spot: Floats = base + d * np.array([np.cos(angle), np.sin(angle)])
    return spot


def _squared_half_chord(paper: Paper, s: Floats, D: Floats) -> Floats:
    """Return h² − s², snapped to 0 within rounding; negative where the circles do not meet."""
    c, h = abs(paper.c), paper.h
    squared = (h - s) * (h + s) if h <= c else (D - c) * (D + c)
    # A difference of squares is only as good as the smaller of its parts.
    noise = SNAP_EPSILONS * np.finfo(float).eps * paper.size * max(min(c, h), 0.0)
    clear: Floats = np.where((np.abs(squared) <= noise) | ((squared < 0) & (s <= h)), 0.0, squared)
    return clear


def _unfold(i: int, flat: Floats, meridian: Floats, theta: float) -> Floats:
    """Find p_i by two circles, on the side that keeps its triangle the right way up."""
    r, z = meridian.T
    outer = float(np.hypot(r[i] - r[i - 2], z[i] - z[i - 2]))
    straight = r[i] ** 2 + r[i - 1] ** 2 - 2 * r[i] * r[i - 1] * np.cos(theta)
    across = float(np.sqrt(max(straight + (z[i] - z[i - 1]) ** 2, 0.0)))
    step = flat[i - 1] - flat[i - 2]
    base = float(np.hypot(*step))
    if outer < COINCIDENT_MM or across < COINCIDENT_MM:
        near = i - 2 if outer < COINCIDENT_MM else i - 1
        raise InvalidParameters(f"Point {i} lies on point {near}; move one of them.")
    x = (base**2 + outer**2 - across**2) / (2 * base)
    y_squared = (outer - x) * (outer + x)
    if y_squared <= 0:
        raise ImpossibleGeometry(
            f"Point {i} is in one line with points {i - 2} and {i - 1}: its triangle has no area."
        )
    along = step / base
    left = np.array([-along[1], along[0]]) * (1 if i % 2 == 0 else -1)
    spot: Floats = flat[i - 2] + x * along + np.sqrt(y_squared) * left
    return spot


def _inside(i: int, flat: Floats, theta: float) -> float:
    """Return how far p_i lies inside its line, mm."""
    along = _direction(i, theta)
    inward = np.array([along[1], -along[0]]) * (1 if i % 2 == 0 else -1)
    return float(flat[i] @ inward)


def _side_of_line(i: int, flat: Floats, theta: float) -> int:
    """Return 1 where p_i is strictly inside, -1 beyond its line; snap it where it is on it: 0."""
    inside, along = _inside(i, flat, theta), _direction(i, theta)
    if abs(inside) <= ON_LINE * float(np.abs(flat).max()):
        flat[i] = float(flat[i] @ along) * along
        return 0
    return 1 if inside > 0 else -1


def _settled(i: int, flat: Floats, meridian: Floats, theta: float) -> Floats:
    """Return P_i for a p_i that was brought onto its line: the place nearest to where it was."""
    paper, before = Paper.of(flat, i), (meridian[i - 2], meridian[i - 1])
    spots = np.array([meet(paper, branch, *before, theta) for branch in (1, -1)])
    away = np.hypot(*(spots - meridian[i]).T)
    nearest: Floats = spots[np.nanargmin(away)] if np.isfinite(away).any() else meridian[i]
    return nearest


def _crossing_refusal(i: int, flat: Floats, theta: float) -> ImpossibleGeometry:
    return ImpossibleGeometry(
        f"Point {i} crosses its symmetry line by {-_inside(i, flat, theta):.4g} mm in the pattern: "
        f"there is no paper for it (the angles about point {i - 2} exceed 360°). Move it back by r "
        f"or z."
    )
