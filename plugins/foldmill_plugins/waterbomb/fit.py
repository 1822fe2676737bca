"""Bring a developable form closer to its target, and keep it developable all the way.

A step minimises the linearised objective under the linearised conditions (the KKT system), damped
as by Levenberg and Marquardt; then the form is developed again with the least motion. It is taken
where the objective falls and no more facets pass through each other than before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.contact import Clashes, Contacts
from foldmill_plugins.waterbomb.linear import Factorised
from foldmill_plugins.waterbomb.objective import Objective
from foldmill_plugins.waterbomb.solve import Developed, develop
from foldmill_plugins.waterbomb.topology import Indices
from foldmill_plugins.waterbomb.unknowns import Unknowns

Floats = NDArray[np.float64]

NEARLY = 1e-6
"""deg. e_total after a step: enough for the objective to tell steps apart."""
RETURN = 8
"""Steps of the return to developable forms after which a step was too long."""
FIRST, LEAST = 1e-3, 1e-6
"""Damping at first and at least, as a share of the mean of the diagonal."""
RAISES = 12
"""How often damping is raised fivefold before the fit ends."""
LOOK_BACK, ENOUGH = 8, 4e-3
"""Steps in which the objective must fall by this share for more of them to be worth while."""
SLACK = 1e-10
"""Share by which conditions may give way within a step: a closed torus has one too many."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """A form after its fit, and how the fit went."""

    developed: Developed
    """The form, developed as closely as any."""
    objectives: tuple[float, ...]
    """The objective at the start and after every step."""
    refused: int
    """Steps not taken because facets would have passed through each other."""

    @property
    def iterations(self) -> int:
        """How many steps were taken."""
        return len(self.objectives) - 1


@dataclass(eq=False)
class _Way:
    """The steps of a fit so far."""

    objective: Objective
    clashes: Clashes
    allowed: int
    """Pairs of facets that passed through each other at the start."""
    points: Floats
    values: list[float]
    sound: Floats
    """The last form of which no more facets passed through each other than at the start."""
    met: set[tuple[int, int]]
    """Pairs of facets that a step pushed through each other."""
    refused: int = 0


def fitted(objective: Objective, clashes: Clashes, tolerance: float, most: int) -> Fitted:
    """Return the form nearest to its target that steps from the objective's start lead to.

    First facets may pass through each other on the way, as they often part again. Where they do
    not, the fit goes on from the last sound form, and takes no step that lets them.
    tolerance : deg, of e_total at the end; most : steps.
    """
    start = objective.start
    allowed = len(clashes.pairs(start))
    way = _Way(objective, clashes, allowed, start, [objective.value(start)], start, set())
    _descend(way, most, is_strict=False)
    if way.sound is not way.points:
        way.points = way.sound
        way.values.append(objective.value(way.points))
        _descend(way, most, is_strict=True)
    exact = develop(objective.unknowns.conditions, way.points, tolerance, 4 * RETURN)
    return Fitted(exact, tuple(way.values), way.refused)


def _descend(way: _Way, most: int, *, is_strict: bool) -> None:
    """Take steps until they win nothing, or there have been most of them."""
    solver, damping, first = Factorised(), FIRST, len(way.values)
    for _ in range(most):
        stepped = _step(way, damping, solver, is_strict=is_strict)
        if stepped is None:
            return
        damping = max(stepped / 10, LEAST)
        late = len(way.values) - first > LOOK_BACK
        if late and way.values[-1] > (1 - ENOUGH) * way.values[-LOOK_BACK]:
            return


def _step(way: _Way, damping: float, solver: Factorised, *, is_strict: bool) -> float | None:
    """Take one step; return its damping, or None where no damping helps."""
    system = _system(way.objective, way.points)
    for _ in range(RAISES):
        moved = _moved(way.objective.unknowns, way.points, system, damping, solver)
        value = np.inf if moved is None else way.objective.value(moved)
        if moved is not None and value < way.values[-1]:
            pairs = way.clashes.pairs(moved)
            is_sound = len(pairs) <= way.allowed
            if is_sound or not is_strict:
                way.points = moved
                way.sound = moved if is_sound else way.sound
                way.values.append(value)
                _keep_apart(way, is_sound=is_sound)
                return damping
            way.refused += 1
            if _watch(way, pairs):
                system = _system(way.objective, way.points)
                continue
        damping *= 5
    return None


def _watch(way: _Way, pairs: Indices) -> bool:
    """Keep pairs of facets apart from now on; tell whether any of them is a new one."""
    fresh = {(int(a), int(b)) for a, b in pairs} - way.met
    way.met |= fresh
    if fresh:
        _keep_apart(way, is_sound=True)
    return bool(fresh)


def _keep_apart(way: _Way, *, is_sound: bool) -> None:
    """Turn the planes between facets that have met as they are now."""
    if way.met and is_sound:
        contacts = Contacts.of(way.points, way.clashes.faces, np.array(sorted(way.met)))
        way.objective = replace(way.objective, contacts=contacts)
        way.values[-1] = way.objective.value(way.points)


@dataclass(frozen=True, eq=False)
class _System:
    """The parts of a KKT system: [[H + μ, Jᵀ], [J, 0]] (q, λ) = −(g, r)."""

    curvature: Any
    gradient: Floats
    jacobian: Any
    residual: Floats


def _system(objective: Objective, points: Floats) -> _System:
    residual, jacobian = objective.unknowns.conditions.linearised(points)
    rows, slopes = objective.linearised(points)
    return _System(slopes.T @ slopes, slopes.T @ rows, jacobian, residual)


def _moved(
    unknowns: Unknowns, points: Floats, system: _System, damping: float, solver: Factorised
) -> Floats | None:
    """Return the developable form (V, 3) after a damped step, or None where there is none."""
    from scipy.sparse import bmat, identity

    size, rows = system.curvature.shape[0], system.jacobian.shape[0]
    scale = float(system.curvature.diagonal().mean())
    steep = float(system.jacobian.power(2).sum()) / max(rows, 1)
    upper = system.curvature + damping * scale * identity(size)
    lower = -SLACK * steep / scale * identity(rows)
    whole = bmat([[upper, system.jacobian.T], [system.jacobian, lower]]).tocsc()
    found = solver.solve(whole, 0.0, -np.concatenate([system.gradient, system.residual]))
    if found is None:
        return None
    there = develop(
        unknowns.conditions, unknowns.conditions.moved(points, found[:size]), NEARLY, RETURN
    )
    return there.points if there.is_converged else None


def went(fit: Fitted) -> dict[str, Any]:
    """Return how a fit went, for people."""
    return {
        "iterations": fit.iterations,
        "objective": list(fit.objectives),
        "refused_for_penetration": fit.refused,
    }
