"""Decompose the edges of a planar graph into trails that turn as little as possible."""

from __future__ import annotations

from collections import defaultdict
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def straightest(points: Floats, edges: Indices) -> list[list[int]]:
    """Return trails (lists of vertices) that use every edge exactly once.

    points : (V, 2) mm; edges : (E, 2). At each vertex the two edges that continue each other best
    are joined first. A trail that returns to its start repeats it.
    """
    partner = _pair_straightest(points, edges)
    used: set[int] = set()
    trails = []
    for start in _starts(edges, partner):
        edge, vertex = start
        if edge in used:
            continue
        trail = [vertex]
        while edge not in used:
            used.add(edge)
            a, b = edges[edge].tolist()
            vertex = b if vertex == a else a
            trail.append(vertex)
            following = partner.get((edge, vertex))
            if following is None:
                break
            edge = following
        trails.append(trail)
    return trails


def _pair_straightest(points: Floats, edges: Indices) -> dict[tuple[int, int], int]:
    """Return (edge, vertex) → the edge that continues it there."""
    around: dict[int, list[tuple[int, float]]] = defaultdict(list)
    for number, (a, b) in enumerate(edges.tolist()):
        for tail, head in ((a, b), (b, a)):
            step = points[head] - points[tail]
            around[tail].append((number, float(np.arctan2(step[1], step[0]))))
    partner: dict[tuple[int, int], int] = {}
    for vertex, spokes in around.items():
        options = sorted(
            (round(abs(abs((p - q + np.pi) % (2 * np.pi) - np.pi) - np.pi), 9), e, f)
            for (e, p), (f, q) in combinations(spokes, 2)
        )
        free = {edge for edge, _ in spokes}
        for _, e, f in options:
            if e in free and f in free:
                free -= {e, f}
                partner[e, vertex], partner[f, vertex] = f, e
    return partner


def _starts(edges: Indices, partner: dict[tuple[int, int], int]) -> list[tuple[int, int]]:
    """Return where trails begin: first at ends that nothing continues, then anywhere on loops."""
    sides = [(edge, vertex) for edge, pair in enumerate(edges.tolist()) for vertex in pair]
    ends = [side for side in sides if side not in partner]
    return ends + sides
