"""What is worked out for all creases at once is what one would find going from one to the next."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest
import shapely
from stools import material, stool

from foldmill import Assignment, CreasePattern, installed
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plan import scores, shapes, sides, spacing


@cache
def pattern(name: str) -> CreasePattern:
    if name == "stool":
        return stool().pattern
    design = installed().design("waterbomb")
    return design.run(design.preset(name)).pattern


NAMES = ("stool", "hyperbolic-paraboloid", "moebius")


def flaps_one_by_one(of: CreasePattern) -> list[tuple[list[int], list[int]]]:
    """Return the facets on one straight fold as sets of vertices, by going through all facets."""
    numbers = {frozenset(edge): k for k, edge in enumerate(of.edges.tolist())}
    folds = {k for k, code in enumerate(of.assignments) if code in (Assignment.M, Assignment.V)}
    facet, found = shapes.facets(of), []
    for number in range(int(facet.max()) + 1):
        faces = of.faces[facet == number].tolist()
        own = {numbers[frozenset((f[k], f[k - 1]))] for f in faces for k in range(3)}
        ends = sorted({v for edge in own & folds for v in of.edges[edge].tolist()})
        if len(ends) < 2:
            continue
        hinge = shapely.LineString(of.vertices[ends])
        longest = max(
            (shapely.LineString(of.vertices[[a, b]]) for a in ends for b in ends if a < b),
            key=lambda line: line.length,
        )
        if shapely.hausdorff_distance(hinge, longest) <= shapes.IN_LINE:
            found.append((sorted({v for f in faces for v in f}), ends))
    return found


@pytest.mark.parametrize("name", NAMES)
def test_flaps_hang_on_one_straight_fold(name: str) -> None:
    of = pattern(name)
    found = list(shapes.flaps(of, of.vertices))
    wanted = flaps_one_by_one(of)
    assert [own.tolist() for own, _ in found] == [own for own, _ in wanted]
    for (_, hinge), (_, ends) in zip(found, wanted, strict=True):
        assert set(hinge.tolist()) <= set(ends)


def held_one_by_one(of: CreasePattern, by_face: dict[Face, np.ndarray]) -> set[int]:
    """Return the inner vertices whose creases are not one straight groove."""
    inner, held = set(scores.surrounded(of).tolist()), set()
    for vertex in inner:
        own = [
            (face, of.vertices[a + b - vertex] - of.vertices[vertex])
            for face, edges in by_face.items()
            for a, b in of.edges[edges].tolist()
            if vertex in (a, b)
        ]
        if len(own) < 2:
            continue
        (one, p), (two, q) = own[:2]
        bend = np.degrees(np.pi - np.arccos(np.clip(p @ q / np.hypot(*p) / np.hypot(*q), -1, 1)))
        if len(own) > 2 or one is not two or bend > scores.STRAIGHT_DEG:
            held.add(vertex)
    return held


@pytest.mark.parametrize("name", NAMES)
def test_scores_stop_short_where_creases_meet_that_are_not_one_groove(name: str) -> None:
    by_face = sides.scored_edges(pattern(name), material().score)
    assert scores.held_back(pattern(name), by_face) == held_one_by_one(pattern(name), by_face)


def near_one_by_one(of: CreasePattern, by_face: dict[Face, np.ndarray]) -> set[tuple[int, int]]:
    """Return the pairs of creases without a common vertex that come too near each other."""
    edges, front = np.concatenate(list(by_face.values())), len(by_face[Face.FRONT])
    lines = shapely.linestrings(of.vertices[of.edges[edges]])
    ends = [set(pair) for pair in of.edges[edges].tolist()]
    across, beside = 2 * material().thickness, material().score.min_spacing
    found = set()
    for i in range(len(edges)):
        for j in np.flatnonzero(shapely.distance(lines[i], lines) < max(across, beside)).tolist():
            least = across if (i < front) != (j < front) else beside
            if i < j and not ends[i] & ends[j] and shapely.distance(lines[i], lines[j]) < least:
                found.add((int(edges[i]), int(edges[j])))
    return found


@pytest.mark.parametrize("name", NAMES)
def test_scores_that_come_too_near_each_other_are_all_told(name: str) -> None:
    of = pattern(name)
    small = (0.02 if name == "stool" else 0.1) * of.vertices
    of = CreasePattern(small, of.edges, of.assignments, of.fold_angles, of.faces)
    by_face = sides.scored_edges(of, material().score)
    told = spacing.findings(of, of.vertices, by_face, {}, material())
    pairs = [tuple(map(int, re.findall(r"(\d+) \(", finding.where))) for finding in told]
    apart = {(a, b) for a, b in pairs if not set(of.edges[a]) & set(of.edges[b])}
    assert apart == near_one_by_one(of, by_face)
    assert apart
