"""How far an approximation is from its target: d(A, T) of Eq. 6.3, by projection.

The thesis samples the target and takes the nearest sample, which overestimates; here the nearest
sample is only where Newton's method starts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.surfaces import Jet, Surface

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ROUNDS = 30
ENOUGH = 1e-9
"""Step in shares of the rectangle at which a projection has arrived: its distance errs by the
square."""
HALVINGS = 6


@dataclass(frozen=True, eq=False)
class Target:
    """A surface, sampled once so that projections know where to begin."""

    surface: Surface
    u: Floats
    v: Floats
    samples: Floats
    """(n, 3)"""

    @classmethod
    def of(cls, surface: Surface, along_u: int = 120, along_v: int = 60) -> Target:
        """Return a surface with samples, ends included."""
        grid = np.meshgrid(
            np.linspace(*surface.u, along_u + 1),
            np.linspace(*surface.v, along_v + 1),
            indexing="ij",
        )
        u, v = grid[0].ravel(), grid[1].ravel()
        return cls(surface, u, v, surface.points(u, v))

    @property
    def diagonal(self) -> float:
        """The diagonal of the target's bounding box, to about nine digits."""
        low = [-self._highest(-1.0, axis) for axis in range(3)]
        high = [self._highest(1.0, axis) for axis in range(3)]
        return float(np.linalg.norm(np.subtract(high, low)))

    def _highest(self, sign: float, axis: int) -> float:
        """Return the greatest value of a coordinate, by ever finer grids about the best sample."""
        best = int((sign * self.samples[:, axis]).argmax())
        centre = np.array([self.u[best], self.v[best]])
        spans = np.array([self.surface.u, self.surface.v])
        reach = (spans[:, 1] - spans[:, 0]) / 50
        found = 0.0
        for _ in range(4):
            span = np.linspace(-1, 1, 21)[:, None] * reach + centre
            u, v = np.meshgrid(*np.clip(span, spans[:, 0], spans[:, 1]).T, indexing="ij")
            u, v = u.ravel(), v.ravel()
            heights = sign * self.surface.points(u, v)[:, axis]
            at = int(heights.argmax())
            centre, reach, found = np.array([u[at], v[at]]), reach / 10, float(heights[at])
        return found

    def distances(self, points: Floats) -> Floats:
        """Return the distance (n,) of points (n, 3) from the target."""
        return self.projected(points)[1]

    def projected(self, points: Floats) -> tuple[Floats, Floats]:
        """Return u, v (n, 2) of the nearest places of the target, and how far (n,) they are."""
        from scipy.spatial import cKDTree

        found = cKDTree(self.samples).query(points)
        far, nearest = np.asarray(found[0], np.float64), found[1]
        spots = np.column_stack([self.u[nearest], self.v[nearest]])
        active = np.arange(len(points))
        for _ in range(ROUNDS):
            moved, gap = _advance(self.surface, points[active], spots[active], far[active])
            change = np.abs(moved - spots[active]) / self._extent
            spots[active], far[active] = moved, gap
            active = active[(change > ENOUGH).any(axis=1)]
            if not len(active):
                break
        return spots, far

    @property
    def _extent(self) -> Floats:
        return np.array([np.ptp(self.surface.u), np.ptp(self.surface.v)])


def _advance(surface: Surface, points: Floats, spots: Floats, far: Floats) -> tuple[Floats, Floats]:
    """Take one Newton step of every projection, shortened until it comes no farther."""
    step = _newton(surface, surface.jet(*spots.T), points, spots)
    moved, gap = spots.copy(), far.copy()
    open_ = np.arange(len(points))
    for _ in range(HALVINGS):
        trial = _within(surface, spots[open_] + step[open_])
        away = np.linalg.norm(surface.points(*trial.T) - points[open_], axis=1)
        nearer = away <= gap[open_]
        chosen = open_[nearer]
        moved[chosen], gap[chosen] = trial[nearer], away[nearer]
        open_ = open_[~nearer]
        if not len(open_):
            break
        step[open_] /= 4
    return moved, gap


def _newton(surface: Surface, jet: Jet, points: Floats, spots: Floats) -> Floats:
    """Return the steps (n, 2); a coordinate at its end that would leave the rectangle stays."""
    away = jet.p - points

    def dot(a: Floats, b: Floats) -> Floats:
        out: Floats = np.einsum("ij,ij->i", a, b)
        return out

    g = np.column_stack([dot(away, jet.u), dot(away, jet.v)])
    first = [dot(jet.u, jet.u), dot(jet.u, jet.v), dot(jet.v, jet.v)]
    full = [a + dot(away, b) for a, b in zip(first, (jet.uu, jet.uv, jet.vv), strict=True)]
    is_bowl = (full[0] > 0) & (full[0] * full[2] - full[1] ** 2 > 1e-6 * first[0] * first[2])
    a, b, c = (np.where(is_bowl, one, two) for one, two in zip(full, first, strict=True))
    held = _held(surface, spots, g)
    a, c, b = np.where(held[:, 0], 1.0, a), np.where(held[:, 1], 1.0, c), np.where(
        held.any(axis=1), 0.0, b
    )  # fmt: skip
    g = np.where(held, 0.0, g)
    det = a * c - b * b
    det = np.where(np.abs(det) > 0, det, 1.0)
    steps: Floats = np.column_stack(
        [(b * g[:, 1] - c * g[:, 0]) / det, (b * g[:, 0] - a * g[:, 1]) / det]
    )
    return steps


def _held(surface: Surface, spots: Floats, gradient: Floats) -> NDArray[np.bool_]:
    """Tell which coordinates (n, 2) are at an end of the rectangle and pulled beyond it."""
    held = np.zeros(spots.shape, bool)
    ends = ((surface.u, surface.is_u_periodic), (surface.v, surface.is_v_periodic))
    for axis, ((low, high), periodic) in enumerate(ends):
        if not periodic:
            x, g = spots[:, axis], gradient[:, axis]
            held[:, axis] = ((x <= low) & (g > 0)) | ((x >= high) & (g < 0))
    return held


def _within(surface: Surface, spots: Floats) -> Floats:
    """Return spots (n, 2) clamped to the rectangle, or wrapped where it closes."""
    out = spots.copy()
    ends = ((surface.u, surface.is_u_periodic), (surface.v, surface.is_v_periodic))
    for axis, ((low, high), periodic) in enumerate(ends):
        x = spots[:, axis]
        out[:, axis] = low + (x - low) % (high - low) if periodic else np.clip(x, low, high)
    return out
