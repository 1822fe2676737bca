"""From parameters to a fold: search, cut open, lay flat, scale, look at what became of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern, Fold, FoldedForm, ImpossibleGeometry, Symmetry
from foldmill.check.penetration import penetrating_faces
from foldmill.folded import fold_pattern
from foldmill_plugins.waterbomb import feasibility, pieces, simple, status
from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.convergence import steps
from foldmill_plugins.waterbomb.depths import settled
from foldmill_plugins.waterbomb.distance import Target
from foldmill_plugins.waterbomb.fit import went
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.status import Status
from foldmill_plugins.waterbomb.topology import Indices, Topology
from foldmill_plugins.waterbomb.unfold import unfold

Floats = NDArray[np.float64]

ISOMETRIC = 1e-9
"""Share of an edge by which its flat and its folded length may differ. Plain forms reach 1e-13;
forms crumpled into slivers never come near."""


def generate(params: WaterbombParams) -> Fold:
    """Return the fold; what is wrong with it stands in its findings.

    Raises ImpossibleGeometry where no developable form is found, or it cannot be laid flat.
    """
    build = settled(params)
    require_converged(build)
    cut = build.topology.opened()
    solid = from_zero(build, build.developed.points[build.topology.origin])
    flat = unfold(cut, solid)
    _require_isometric(cut, solid, flat)
    scale = _scale(params, flat)
    pattern, form = _fold_pattern(build, cut, flat * scale, solid * scale)
    form = replace(form, seams=seams(build.topology))
    fold = Fold(pattern, form, _symmetry(build, cut, solid))
    state = Status(
        build.developed.error,
        True,
        len(status.wrong_signed(pattern, cut.assignments)),
        len(penetrating_faces(fold, form)),
        simple.is_simple(cut, flat),
    )
    fold = replace(
        fold,
        findings=(*feasibility.findings(build), *status.findings(pattern, cut.assignments, state)),
        meta=_facts(build, state, scale),
    )
    whole = pieces.Whole(fold, cut, build.topology.origin)
    if params.pieces.is_whole(is_simple=state.is_flat_simple):
        return fold
    return pieces.one_of(whole, params.pieces, state)


def require_converged(build: Build) -> None:
    """Raise ImpossibleGeometry, with the reason as far as it is known, where the search failed."""
    found = build.developed
    if found.is_converged:
        return
    raise ImpossibleGeometry(
        f"No developable form was found: after {found.iterations} steps the angles round a vertex "
        f"still miss 360° by {found.error:.3g}°. {feasibility.warned(build)}"
        "Take another n_u and n_v, a free boundary, another start, or a target that is curved less."
    )


def _require_isometric(cut: Topology, solid: Floats, flat: Floats) -> None:
    a, b = cut.edges.T
    long = np.linalg.norm(solid[a] - solid[b], axis=1)
    gap = np.abs(np.linalg.norm(flat[a] - flat[b], axis=1) / long - 1)
    corners = flat[cut.faces]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    turned = int(np.count_nonzero(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0] <= 0))
    if gap.max() <= ISOMETRIC and not turned:
        return
    raise ImpossibleGeometry(
        f"The form is developable but so crumpled that it cannot be laid flat: an edge changes "
        f"by {100 * gap.max():.3g} % of its length and {turned} facets turn over. Its shortest "
        f"edge is 1/{long.max() / long.min():.3g} of the longest. Take another n_u "
        "and n_v, or a target that does not pass through itself."
    )


def mm_per_unit(build: Build) -> float:
    """Return by how much the target is enlarged, so that its sheet is as large as asked for."""
    solid = build.developed.points[build.topology.origin]
    return _scale(build.params, unfold(build.topology.opened(), solid))


def _scale(params: WaterbombParams, flat: Floats) -> float:
    """Return mm per unit of the target."""
    width, height = np.ptp(flat, axis=0)
    sizes = {"sheet": max(width, height), "width": width, "height": height, "unit": 1.0}
    return float(params.size / sizes[params.sized])


def _fold_pattern(
    build: Build, cut: Topology, flat: Floats, solid: Floats
) -> tuple[CreasePattern, FoldedForm]:
    """Return pattern and form with the front opposite to the displaced centres."""
    faces = cut.faces
    if build.side < 0:
        flat, faces = flat * np.array([-1.0, 1.0]), faces[:, ::-1]
    flat = flat - flat.min(axis=0)
    wanted = cut.assignments
    signs = (wanted == Assignment.V).astype(int) - (wanted == Assignment.M)
    return fold_pattern(flat, solid, cut.edges, faces, signs)


def seams(topology: Topology) -> Indices:
    """Return the pairs (S, 2) of vertices of the opened topology that are one in space."""
    return pieces.twins(topology.origin)


def from_zero(build: Build, solid: Floats) -> Floats:
    """Turn a form round a surface of revolution so that its seam is at azimuth 0."""
    if not build.surface.is_revolution:
        return solid
    x, y = build.surface.points(np.array([build.surface.u[0]]), np.zeros(1))[0, :2]
    c, s = np.array([x, y]) / np.hypot(x, y)
    turned: Floats = solid @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return turned


def _symmetry(build: Build, cut: Topology, solid: Floats) -> Symmetry | None:
    """Return the symmetry of a form round a surface of revolution, or None.

    The half wedge lies between the azimuths 0 and 180°/N_u; u may run against the azimuth.
    """
    if not (build.surface.is_revolution and build.surface.is_u_periodic):
        return None
    runs_along = solid[cut.k == 1, 1].sum() > 0
    n_u = build.topology.n_u
    low = 0 if runs_along else 2 * n_u - 1
    k = cut.k[cut.faces]
    wedge = np.flatnonzero(((k == low) | (k == low + 1)).all(axis=1))
    return Symmetry(n_u, wedge, one_sided=True)


def told(figure: float) -> float:
    """Return a figure as it stands in a file, with three digits: more of them are noise."""
    return float(f"{figure:.3g}")


def _facts(build: Build, state: Status, scale: float) -> dict[str, Any]:
    found, target = build.developed, Target.of(build.surface)
    away = target.distances(found.points) / target.diagonal
    return {
        "status": state.facts(),
        "designed": {
            **state.said(),
            "distance_mean": told(float(away.mean())),
            "distance_largest": told(float(away.max())),
            "iterations": found.iterations,
            "e_total_deg": told(found.error),
            "start": build.start,
            "depth": build.depth,
        },
        "bases": build.topology.n_u * build.topology.n_v,
        "start": build.start,
        "depth": build.depth,
        "feasibility": feasibility.promised(build),
        "convergence": steps(found),
        **({} if build.fit is None else {"fit": went(build.fit)}),
        "distance": {"mean": float(away.mean()), "largest": float(away.max())},
        "mm_per_unit": scale,
    }
