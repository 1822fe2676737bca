"""Gauss–Newton with the least motion: make every angle sum 360°, and move the mesh little.

ΔX = −Jᵀ (J Jᵀ + λ)⁻¹ r. λ is rounding small (a closed torus has one redundant row: Gauss–Bonnet)
and grows tenfold where a step makes things worse (thesis 6.1.2 uses Levenberg–Marquardt).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.linear import Factorised

Floats = NDArray[np.float64]

FLOOR = 1e-13
"""λ as a share of the mean of the diagonal of J Jᵀ: the least that keeps a torus regular."""
FIRST_RAISE = 1e-6
"""λ after a first failed step, as the same share."""
MOST_RAISES = 12
"""How often λ is raised tenfold before the search is given up."""


class Conditions(Protocol):
    """What makes a mesh developable, as far as the search must know."""

    def residual(self, points: Floats) -> Floats:
        """Return (m,) angle sums minus 2π, rad; points : (V, 3)."""

    def linearised(self, points: Floats) -> tuple[Floats, Any]:
        """Return the residual and its sparse Jacobian (m, n) by what may move."""

    def moved(self, points: Floats, step: Floats) -> Floats:
        """Return the vertices (V, 3) after a step (n,)."""


@dataclass(frozen=True, eq=False)
class Developed:
    """A mesh after the search, and how the search went."""

    points: Floats
    """(V, 3)"""
    errors: tuple[float, ...]
    """e_total of the base mesh and after every iteration, deg (Eq. 6.2)."""
    extremes: tuple[tuple[float, float, float], ...]
    """Greatest, smallest and mean angle sum at each of them, deg (Fig. 6.6)."""
    tolerance: float
    """deg. e_total that was asked for."""

    @property
    def iterations(self) -> int:
        """How many steps were taken."""
        return len(self.errors) - 1

    @property
    def error(self) -> float:
        """e_total at the end, deg."""
        return self.errors[-1]

    @property
    def is_converged(self) -> bool:
        """Whether the mesh is developable as closely as was asked for."""
        return self.error <= self.tolerance


def develop(
    stars: Conditions, points: Floats, tolerance: float, most: int, sums: int | None = None
) -> Developed:
    """Return the developable mesh nearest to the base mesh points (V, 3), step by step.

    tolerance : deg, of e_total; most : iterations; sums : how many of the conditions are angle
    sums, left out where all are. Never raises for a search that fails.
    """
    solver = Factorised()
    errors, extremes = [], []
    damping = FLOOR
    for _ in range(most + 1):
        residual, jacobian = stars.linearised(points)
        errors.append(e_total(residual))
        extremes.append(_extremes(residual[:sums]))
        if errors[-1] <= tolerance or len(errors) > most:
            break
        moved, damping = _step(stars, points, residual, jacobian, solver, damping)
        if moved is None:
            break
        points = moved
    return Developed(points, tuple(errors), tuple(extremes), tolerance)


def e_total(residual: Floats) -> float:
    """Return e_total in deg: the greatest deviation of an angle sum from 360° (Eq. 6.2)."""
    return float(np.degrees(np.abs(residual).max())) if len(residual) else 0.0


def _extremes(residual: Floats) -> tuple[float, float, float]:
    sums = 360 + np.degrees(residual) if len(residual) else np.array([360.0])
    return float(sums.max()), float(sums.min()), float(sums.mean())


def _step(
    stars: Conditions,
    points: Floats,
    residual: Floats,
    jacobian: Any,
    solver: Factorised,
    damping: float,
) -> tuple[Floats | None, float]:
    """Return the moved points and the λ to begin with next time; None where no λ helps."""
    gram = (jacobian @ jacobian.T).tocsc()
    scale = float(gram.diagonal().mean())
    before = float(residual @ residual)
    for _ in range(MOST_RAISES):
        weights = solver.solve(gram, damping * scale, residual)
        if weights is not None:
            moved = stars.moved(points, -(jacobian.T @ weights))
            after = stars.residual(moved)
            if np.isfinite(after).all() and (after @ after < before or e_total(after) < 1e-11):
                return moved, FLOOR if damping <= FIRST_RAISE else damping / 10
        damping = max(FIRST_RAISE, damping * 10)
    return None, damping
