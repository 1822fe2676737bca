"""Strokes over a planar graph: as few as can be, no sharp turn too many, lifts where they pay."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import networkx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay
from stools import machine

from foldmill_fabricate.toolpath import corners, order, pieces
from foldmill_fabricate.toolpath.routing import Route, route

Graph = tuple[np.ndarray, np.ndarray]


def random_graph(seed: int, vertices: int, share: float) -> Graph:
    """Part of a triangulation: planar, with odd and even vertices, in several pieces or one."""
    rng = np.random.default_rng(seed)
    points = 100 * rng.random((vertices, 2))
    sides = Delaunay(points).simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    edges = np.unique(np.sort(sides, axis=1), axis=0)
    kept = edges[rng.random(len(edges)) < share]
    return points, kept if len(kept) else edges[:1]


def miura(rows: int, columns: int) -> Graph:
    spots = [(5.0 * j, 7.0 * i + 2 * (j % 2)) for i in range(rows + 1) for j in range(columns + 1)]
    number = np.arange(len(spots)).reshape(rows + 1, columns + 1)
    across = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1)
    along = np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1)
    return np.array(spots), np.vstack([across, along])


def ways(points: np.ndarray, found: Route) -> list[np.ndarray]:
    return [points[list(trail)] for trail in found.trails]


def sharp_turns(points: np.ndarray, found: Route) -> int:
    total = 0
    for way in ways(points, found):
        closed = [way[1:2]] if np.array_equal(way[0], way[-1]) else []
        step = np.diff(np.vstack([way, *closed]), axis=0)
        heading = np.degrees(np.arctan2(step[:, 1], step[:, 0]))
        bend = np.abs((np.diff(heading) + 180) % 360 - 180)
        total += int((bend > corners.TURN_DEG + 1e-6).sum())
    return total


def fewest_sharp_turns(points: np.ndarray, edges: np.ndarray) -> int:
    """Per vertex: as many pairs as can be, as few sharp ones as can be; by another matching."""
    around: dict[int, list[float]] = {}
    for tail, head in np.vstack([edges, edges[:, ::-1]]).tolist():
        step = points[head] - points[tail]
        around.setdefault(tail, []).append(float(np.degrees(np.arctan2(step[1], step[0]))))
    total = 0
    for spokes in around.values():
        graph = networkx.Graph()
        graph.add_nodes_from(range(len(spokes)))
        for i, p in enumerate(spokes):
            for j, q in enumerate(spokes[:i]):
                bend = abs(180 - abs((p - q) % 360))
                if bend <= corners.TURN_DEG:
                    graph.add_edge(i, j)
        smooth = len(networkx.max_weight_matching(graph, maxcardinality=True))
        total += len(spokes) // 2 - smooth
    return total


@given(st.integers(0, 10_000), st.integers(4, 30), st.floats(0.2, 1.0))
def test_every_edge_is_drawn_once_in_as_few_strokes_as_can_be(
    seed: int, vertices: int, share: float
) -> None:
    points, edges = random_graph(seed, vertices, share)
    found = route(points, edges, np.zeros(2), corners.free_turning())
    drawn = Counter(tuple(sorted(side)) for trail in found.trails for side in pairwise(trail))
    assert drawn == Counter(tuple(sorted(edge)) for edge in edges.tolist())
    graph = networkx.Graph(edges.tolist())
    pieces = networkx.connected_components(graph)
    odd = [sum(graph.degree(v) % 2 for v in piece) for piece in pieces]
    assert len(found.trails) == sum(max(1, count // 2) for count in odd)


@given(st.integers(0, 10_000), st.integers(4, 30), st.floats(0.2, 1.0), st.booleans())
def test_a_drawing_that_is_numbered_in_another_way_is_drawn_alike(
    seed: int, vertices: int, share: float, is_grid: bool
) -> None:
    points, edges = miura(3, 1 + vertices // 6) if is_grid else random_graph(seed, vertices, share)
    dice = np.random.default_rng(seed)
    number = dice.permutation(len(points))
    mixed = dice.permuted(dice.permutation(number[edges]), axis=1)
    placed = np.zeros_like(points)
    placed[number] = points
    kind = corners.fewest_turns() if seed % 2 else corners.free_turning()
    one = ways(points, route(points, edges, np.zeros(2), kind))
    other = ways(placed, route(placed, mixed, np.zeros(2), kind))
    assert [way.tolist() for way in one] == [way.tolist() for way in other]


@pytest.mark.parametrize("start", [None, np.zeros(2)])
def test_a_drawing_in_one_piece_has_the_least_travel(start: np.ndarray | None) -> None:
    points, edges = miura(9, 12)
    found = route(points, edges, start, corners.free_turning())
    odd = [v for v, n in networkx.Graph(edges.tolist()).degree() if n % 2]
    graph = networkx.Graph()
    for k, v in enumerate(odd):
        graph.add_edge(v, "end", weight=0.0)
        away = 0.0 if start is None else float(np.hypot(*(points[v] - start)))
        graph.add_edge(v, "start", weight=away)
        for w in odd[:k]:
            graph.add_edge(v, w, weight=float(np.hypot(*(points[v] - points[w]))))
    pairs = networkx.min_weight_matching(graph)
    best = sum(graph.edges[pair]["weight"] for pair in pairs)
    way = ways(points, found)
    assert order.travel(way, way[0][0] if start is None else start) == pytest.approx(best)
    assert found.bound == pytest.approx(best)
    assert len(found.trails) == len(odd) // 2


@pytest.mark.parametrize("few", [0, 20, 1000])
def test_a_drawing_in_several_pieces_is_drawn_whole_however_its_ends_are_joined(
    few: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Squares apart, a large net with many ends, and small ones whose ends are not matched."""
    monkeypatch.setattr(pieces, "FEW", few)
    square = np.array([[0, 0], [4, 0], [4, 4], [0, 4]], float)
    cross = np.array([[0, 0], [2, 0], [4, 0], [2, 2], [2, -2]], float)
    parts = [
        (square + np.array([-20, 9]), [[0, 1], [1, 2], [2, 3], [3, 0]]),
        (square + np.array([-30, 0]), [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]]),
        (cross + np.array([-10, 0]), [[0, 1], [1, 2], [1, 3], [4, 1]]),
        miura(6, 7),
    ]
    sizes = np.cumsum([0, *(len(points) for points, _ in parts)])
    points = np.vstack([own for own, _ in parts])
    edges = np.vstack([np.array(e) + by for (_, e), by in zip(parts, sizes[:-1], strict=True)])
    found = route(points, edges, np.zeros(2), corners.free_turning())
    drawn = Counter(tuple(sorted(side)) for trail in found.trails for side in pairwise(trail))
    assert drawn == Counter(tuple(sorted(edge)) for edge in edges.tolist())
    odd = [int((np.bincount(np.array(e).ravel()) % 2).sum()) for _, e in parts]
    assert len(found.trails) == sum(max(1, count // 2) for count in odd)
    way = ways(points, found)
    assert found.bound + found.gap == pytest.approx(order.travel(way, np.zeros(2)))
    assert 0 < found.bound < found.bound + found.gap


@given(st.integers(0, 10_000), st.integers(4, 25), st.floats(0.3, 1.0))
def test_a_wheel_that_is_not_lifted_turns_sharply_no_more_than_it_must(
    seed: int, vertices: int, share: float
) -> None:
    points, edges = random_graph(seed, vertices, share)
    found = route(points, edges, None, corners.fewest_turns())
    least = fewest_sharp_turns(points, edges)
    # A closed way that was cut open for a hop saves the turn at the cut.
    assert sharp_turns(points, found) <= least
    whole = corners.pair(edges.ravel(), _spokes(points, edges), corners.fewest_turns())
    ends = np.flatnonzero(whole > np.arange(len(whole)))
    spokes = _spokes(points, edges)
    bend = corners.bends(spokes[ends], spokes[whole[ends]])
    assert int((bend > corners.TURN_DEG).sum()) == least


def _spokes(points: np.ndarray, edges: np.ndarray) -> np.ndarray:
    step = points[edges[:, 1]] - points[edges[:, 0]]
    angle = np.degrees(np.arctan2(step[:, 1], step[:, 0]))
    return np.stack([angle, angle + 180], axis=1).ravel()


def test_a_knife_is_lifted_exactly_where_that_is_quicker_than_a_swivel() -> None:
    points = np.array([[0, 0], [10, 0], [20, 3], [20, 20]], float)
    edges = np.array([[0, 1], [1, 2], [2, 3]])
    quick = machine().motion
    slow = quick.model_copy(update={"lift_time": 1.0})
    at = [len(route(points, edges, None, corners.by_time(m)).trails) for m in (quick, slow)]
    assert at == [2, 1]
