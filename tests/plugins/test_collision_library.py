"""The penetration rule against a collision library, on random forms of every family and on heaps.

The library (FCL) reports whatever touches; a fold touches itself along every crease. So it is shown
each facet shrunk towards its middle, once by a millionth and once by a thousandth: what it reports
both times goes through, what it reports neither time does not, and what it reports once is near to
touching and is counted instead of judged. Facets that lie upon each other it reports both times;
those are told apart by their corners' heights, which are no more than a millionth of the size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from six_crease_oracle import random_design
from strip_oracle import random_lines, random_tucked

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.rosette import HalfWedge
from foldmill.check.intersection import penetrations
from foldmill_plugins.six_crease import DESIGN, solve
from foldmill_plugins.tuck import blanks, corners, flaps, search

Mesh = tuple[np.ndarray, np.ndarray, np.ndarray]
"""vertices (V, 3), edges (E, 2), faces (F, 3)."""
Pairs = set[tuple[int, int]]
LITTLE, MUCH, HEIGHT = 1e-6, 1e-3, 1e-6
COUNT = 110
NEAR = 0.01
"""Largest share of meshes that may be too near to touching to be judged whole."""


def rotational() -> Iterator[Mesh]:
    for seed in range(2 * COUNT):
        form = rosette.assemble(HalfWedge.of(strip.solve(*random_lines(seed))))
        yield form.spatial, form.edges, form.faces


def six_crease() -> Iterator[Mesh]:
    left, seed = COUNT, 0
    while left:
        seed += 1
        params = random_design(seed)
        try:
            solve.meridian(params)
        except ImpossibleGeometry:
            continue
        fold = DESIGN.run(params)
        assert fold.folded is not None
        left -= 1
        yield fold.folded.vertices, fold.pattern.edges, fold.pattern.faces


def tuck() -> Iterator[Mesh]:
    """Yield random edits with their flaps anywhere in their ranges, free or not."""
    left, seed = COUNT, 0
    while left:
        seed += 1
        rng = np.random.default_rng(seed)
        solved = strip.solve(*random_tucked(seed))
        try:
            found = blanks.find(solved)
        except ImpossibleGeometry:
            continue
        half, made = flaps.add(HalfWedge.of(solved), found)
        placed = []
        for blank in found:
            shape = (1, len(blank.points))
            shares, sides = rng.uniform(0.1, 0.9, shape), rng.choice([-1.0, 1.0], shape)
            spots = corners.place(blank, shares, sides, [None] * shape[1])
            placed.append(search.Placed(blank, spots, 1))
        if all(each.corners.exists[0] for each in placed):
            form = flaps.put(rosette.assemble(half), made, placed)
            left -= 1
            yield form.spatial, form.edges, form.faces


def heaps() -> Iterator[Mesh]:
    for seed in range(COUNT):
        rng = np.random.default_rng(seed)
        count = int(rng.integers(3, 16))
        spots = rng.uniform(-1, 1, (count, 1, 3)) + rng.uniform(-0.5, 0.5, (count, 3, 3))
        faces = np.arange(3 * count).reshape(-1, 3)
        sides = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        yield spots.reshape(-1, 3), sides, faces


def reported(fcl: Any, triangles: np.ndarray, shrink: float) -> Pairs:
    """Return the pairs of shrunk triangles (F, 3, 3) that the library finds in contact."""
    middle = triangles.mean(axis=1, keepdims=True)
    spots = (triangles + shrink * (middle - triangles)).reshape(-1, 3)
    models = []
    for _ in range(2):
        model = fcl.BVHModel()
        model.beginModel(len(triangles), len(spots))
        model.addSubModel(spots, np.arange(len(spots)).reshape(-1, 3))
        model.endModel()
        models.append(fcl.CollisionObject(model))
    request = fcl.CollisionRequest(num_max_contacts=1_000_000, enable_contact=True)
    result = fcl.CollisionResult()
    fcl.collide(*models, request, result)
    found = [(contact.b1, contact.b2) for contact in result.contacts]
    return {(min(pair), max(pair)) for pair in found if pair[0] != pair[1]}


def without_touching(pairs: Pairs, triangles: np.ndarray, size: float) -> Pairs:
    """Leave out pairs where one has no corner beyond the other's plane, on one of its sides."""
    if not pairs:
        return set()
    numbers = np.array(sorted(pairs))
    through = np.ones(len(numbers), bool)
    for plane, other in ((0, 1), (1, 0)):
        here, there = (triangles[numbers[:, k]] for k in (plane, other))
        normal = np.cross(here[:, 1] - here[:, 0], here[:, 2] - here[:, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        heights = np.einsum("nij,nj->ni", there - here[:, :1], normal)
        through &= np.minimum(heights.max(axis=1), -heights.min(axis=1)) > HEIGHT * size
    return {(int(a), int(b)) for a, b in numbers[through]}


@pytest.mark.long
@pytest.mark.parametrize("meshes", [rotational, six_crease, tuck, heaps])
def test_a_collision_library_finds_the_same_facets_passing_through_each_other(
    meshes: Callable[[], Iterator[Mesh]],
) -> None:
    fcl = pytest.importorskip("fcl")
    verdicts, near = [], 0
    for vertices, edges, faces in meshes():
        triangles, size = vertices[faces], float(np.ptp(vertices, axis=0).max())
        ours = {(int(a), int(b)) for a, b in penetrations(vertices, edges, faces)}
        little, much = (reported(fcl, triangles, shrink) for shrink in (LITTLE, MUCH))
        through = without_touching(little & much, triangles, size)
        assert through <= ours
        unsure = ours - through
        assert unsure <= little | much
        if unsure and not through:
            near += 1
        else:
            verdicts.append(bool(ours))
            assert bool(ours) is bool(through)
    assert near <= NEAR * len(verdicts)
    assert len(verdicts) * 0.1 < sum(verdicts) < len(verdicts) * 0.95
