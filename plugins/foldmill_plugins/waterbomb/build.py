"""From parameters to a developable mesh: target, topology, start, base mesh, search."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.base import Offsets, base_mesh, closed_topology
from foldmill_plugins.waterbomb.contact import Clashes
from foldmill_plugins.waterbomb.curvature import flat_metric
from foldmill_plugins.waterbomb.fit import Fitted, fitted
from foldmill_plugins.waterbomb.jacobian import Stars
from foldmill_plugins.waterbomb.kawasaki import FlatFoldable
from foldmill_plugins.waterbomb.metric import Start, closed_form, crowding
from foldmill_plugins.waterbomb.nested import halved, transferred
from foldmill_plugins.waterbomb.objective import Objective
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.sector import Sector
from foldmill_plugins.waterbomb.solve import Conditions, Developed, develop
from foldmill_plugins.waterbomb.surfaces import Surface
from foldmill_plugins.waterbomb.topology import Topology
from foldmill_plugins.waterbomb.unknowns import Unknowns

Floats = NDArray[np.float64]

E_TOTAL = 1e-10
"""deg. e_total of a developable mesh. The thesis' 1e-5 leaves gaps of a hundredth of the sheet
where a torus is laid flat."""
MOST_ITERATIONS = 40
"""Steps after which the search is given up; a start that suits takes 3 to 6."""
COARSE = 1e-3
"""deg. e_total at which a coarser mesh has told where it goes."""
MANY = 2_000
"""Bases beyond which a search begins with fewer of them, or takes one sector."""
DEPTH = 0.3
"""Depth of the widest cell, in cells: folds of 30° at least on all seven surfaces, and close."""
UNIFORM_DEPTH, UNIFORM_SLIDE = 0.5, 0.25
"""The depth and slide at which the most targets converge."""


@dataclass(frozen=True, eq=False)
class Build:
    """One tessellation in the making; each step is made when it is asked for."""

    params: WaterbombParams

    @cached_property
    def surface(self) -> Surface:
        """The target."""
        return self.params.surface.surface()

    @cached_property
    def topology(self) -> Topology:
        """The graph, closed where the target closes."""
        return closed_topology(self.surface, self.params.n_u, self.params.n_v)

    @cached_property
    def side(self) -> int:
        """1 where the centres are displaced against P_u × P_v, else -1: the front is opposite."""
        is_inner = self.params.side == "inner"
        return 1 if is_inner == self.surface.is_outward else -1

    @property
    def depth(self) -> float:
        """The depth that is stated, or the usual one of the start."""
        usual = UNIFORM_DEPTH if self.start == "uniform" else DEPTH
        return usual if self.params.depth is None else self.params.depth

    @cached_property
    def promise(self) -> Start:
        """The depths that make the folded metric flat: the feasibility indicator rests on them."""
        depth = DEPTH if self.params.depth is None else self.params.depth
        wants_field = self.params.start == "flat-metric" or not self.surface.is_revolution
        make = flat_metric if wants_field else closed_form
        return make(self.surface, self.topology, depth)

    @cached_property
    def crowding(self) -> float:
        """Greatest depth that flatness asks for, in heights of a cell as they are at that depth."""
        return crowding(self.surface, self.topology, self.promise, self.side)

    @cached_property
    def start(self) -> str:
        """Which start is taken: closed-form, flat-metric or uniform."""
        if self.params.start != "auto":
            return self.params.start
        if not self.promise.is_feasible:
            return "uniform"
        return "closed-form" if self.surface.is_revolution else "flat-metric"

    @cached_property
    def offsets(self) -> Offsets:
        """How far the vertices of the base mesh leave the grid."""
        given, inside = self.params, self.params.rim == "inside"
        if self.start == "uniform":
            depth: float | Floats = self.depth
            slide: float | Floats = UNIFORM_SLIDE
        else:
            depth, slide = self.promise.depth, self.promise.slide
        slide = slide if given.slide is None else given.slide
        return Offsets(depth, slide, given.lift, self.side, inside)

    def with_bases(self, topology: Topology) -> Build:
        """Return the same with another number of bases."""
        changed = {"n_u": topology.n_u, "n_v": topology.n_v, "start": self.start}
        return Build(self.params.model_copy(update=changed))

    @cached_property
    def base(self) -> Floats:
        """(V, 3) the base mesh."""
        return base_mesh(self.surface, self.topology, self.offsets)

    @cached_property
    def stars(self) -> Stars:
        """The conditions of the search."""
        return Stars.of(self.topology, is_boundary_free=self.params.boundary == "free")

    @cached_property
    def developed(self) -> Developed:
        """The mesh in the end: after the search, and after the fit where one is asked for."""
        if self.fit is None:
            return self.plain
        exact = self.fit.developed
        return replace(
            self.plain,
            points=exact.points,
            errors=(*self.plain.errors[:-1], exact.error),
            extremes=(*self.plain.extremes[:-1], exact.extremes[-1]),
        )

    @cached_property
    def fit(self) -> Fitted | None:
        """The mesh after the fit; None where none is asked for, or there is nothing to fit."""
        options = self.params.fit
        if not (options.on and self.plain.is_converged):
            return None
        unknowns = self.unknowns
        objective = Objective.of(
            self.surface, self.topology, self.side, unknowns, self.plain.points, options
        )
        clashes = Clashes.of(self.topology, is_symmetric=self.is_symmetric)
        return fitted(objective, clashes, E_TOTAL, options.iterations)

    @property
    def is_symmetric(self) -> bool:
        """Whether every base of a strip is like the next one, turned about the axis."""
        return self.surface.is_revolution and self.topology.is_u_closed

    @cached_property
    def unknowns(self) -> Unknowns:
        """What a fit may move."""
        is_free = self.params.fit.boundary == "free"
        stars = Stars.of(self.topology, is_boundary_free=is_free)
        if self.is_symmetric:
            return Unknowns.by_orbit(Sector.of(self.topology, stars, self.base))
        return Unknowns.of(self.conditions_on(stars), stars.is_free)

    @cached_property
    def plain(self) -> Developed:
        """The mesh after the search: a large one by its sector, or begun by a coarser one."""
        if self.params.n_u * self.params.n_v > MANY:
            if self.surface.is_revolution and self.topology.is_u_closed:
                return self._by_sector()
            if self.start == "uniform":
                return develop(self.stars, self._begun_by_a_coarser(), E_TOTAL, MOST_ITERATIONS)
        sums = len(self.stars.centre)
        return develop(self.conditions_on(self.stars), self.base, E_TOTAL, MOST_ITERATIONS, sums)

    def conditions_on(self, stars: Stars) -> Conditions:
        """Return what the search must keep: developability, and flat-foldability if wanted."""
        wants_more = self.params.flat_foldable and not self.is_symmetric
        return FlatFoldable(stars) if wants_more else stars

    def _by_sector(self) -> Developed:
        sector = Sector.of(self.topology, self.stars, self.base)
        found = develop(sector, self.base, E_TOTAL, MOST_ITERATIONS)
        rest = develop(self.stars, found.points, E_TOTAL, MOST_ITERATIONS)
        if rest.iterations == 0:
            return replace(found, errors=(*found.errors[:-1], rest.error))
        return replace(rest, errors=found.errors + rest.errors[1:])

    def _begun_by_a_coarser(self) -> Floats:
        topology = halved(self.surface, self.topology)
        if topology is None:
            return self.base
        coarse = self.with_bases(topology)
        begun = coarse._begun_by_a_coarser()
        moved = develop(coarse.stars, begun, COARSE, MOST_ITERATIONS).points
        return transferred(self.surface, topology, coarse.base, moved, self.topology, self.base)
