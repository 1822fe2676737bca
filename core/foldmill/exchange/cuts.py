"""Inner cuts in a portable file: split into two boundaries on the way out, joined on the way in.

Simulators refuse the letter C. So the vertices along a cut are doubled: the corners of the faces at
a vertex fall into groups that hang together through edges which are not cut, and every group after
the first gets a vertex of its own. A single cut edge with both ends inside the sheet would be two
boundaries over the same two vertices; it gets a vertex in its middle first.

Two keys of our own tell how to undo it: ``vertices_foldmill:of`` names the vertex each one repeats
(null for a middle), ``edges_foldmill:cut`` holds the ends of the cut an edge stands for, and an
empty list for its copies.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from foldmill.errors import UnreadableFile
from foldmill.exchange.graph import Graph, numbered, side_faces
from foldmill.exchange.keys import CUT, OF

Corner = tuple[int, int]
"""A vertex, and a face that has a corner there."""


def split(graph: Graph) -> Graph:
    """Open all cuts of a graph, in place; returns it."""
    graph.cuts = [None] * len(graph.edges)
    if "C" in graph.letters:
        for k, letter in enumerate(graph.letters):
            graph.cuts[k] = list(graph.edges[k]) if letter == "C" else None
        for edge in list(_lone(graph)):
            _bisect(graph, edge)
        _open(graph)
    return graph


def _open(graph: Graph) -> None:
    own, left = _corner_vertices(graph), side_faces(graph.faces)
    for k, (a, b) in enumerate(list(graph.edges)):
        beside = [left[side] for side in ((a, b), (b, a)) if side in left]
        copies = [(own.get((a, f), a), own.get((b, f), b)) for f in beside] or [(a, b)]
        graph.edges[k] = copies[0]
        if graph.letters[k] == "C":
            graph.letters[k] = "B"
            for copy in copies[1:]:
                _append(graph, copy, "B", k)
    graph.faces = [
        [own.get((vertex, f), vertex) for vertex in face] for f, face in enumerate(graph.faces)
    ]


def _append(graph: Graph, edge: tuple[int, int], letter: str, like: int) -> None:
    graph.edges.append(edge)
    graph.letters.append(letter)
    graph.angles.append(0.0)
    graph.edge_source.append(graph.edge_source[like])
    graph.cuts.append([])


def _corner_vertices(graph: Graph) -> dict[Corner, int]:
    """Give every group of corners along the cuts its vertex; new vertices are appended."""
    groups = _corner_groups(graph)
    first: set[int] = set()
    made: dict[Corner, int] = {}
    own: dict[Corner, int] = {}
    for corner in sorted(groups):
        leader, vertex = groups[corner], corner[0]
        if leader == corner and vertex in first:
            graph.vertex_source.append(graph.vertex_source[vertex])
            made[leader] = len(graph.vertex_source) - 1
        first.add(vertex)
        own[corner] = made.get(leader, vertex)
    return own


def _corner_groups(graph: Graph) -> dict[Corner, Corner]:
    """Return for every corner along the cuts the lowest corner it hangs together with."""
    on_cut = {
        v for edge, c in zip(graph.edges, graph.letters, strict=True) for v in edge if c == "C"
    }
    leader = {(v, f): (v, f) for f, face in enumerate(graph.faces) for v in face if v in on_cut}
    left = side_faces(graph.faces)

    def lead(corner: Corner) -> Corner:
        while leader[corner] != corner:
            corner = leader[corner]
        return corner

    for (a, b), letter in zip(graph.edges, graph.letters, strict=True):
        one, two = left.get((a, b)), left.get((b, a))
        if letter == "C" or one is None or two is None:
            continue
        for vertex in (a, b):
            if vertex in on_cut:
                low, high = sorted((lead((vertex, one)), lead((vertex, two))))
                leader[high] = low
    return {corner: lead(corner) for corner in leader}


def _lone(graph: Graph) -> Iterator[int]:
    """Yield the cuts whose two sides would keep both their vertices in common."""
    groups, left = _corner_groups(graph), side_faces(graph.faces)
    for k, (a, b) in enumerate(graph.edges):
        one, two = left.get((a, b)), left.get((b, a))
        if graph.letters[k] != "C" or one is None or two is None:
            continue
        if all(groups[v, one] == groups[v, two] for v in (a, b)):
            yield k


def _bisect(graph: Graph, k: int) -> None:
    (a, b), middle = graph.edges[k], len(graph.vertex_source)
    graph.vertex_source.append(graph.vertex_source[a] + graph.vertex_source[b])
    graph.edges[k] = (a, middle)
    _append(graph, (middle, b), "C", k)
    for face in graph.faces:
        for i in range(len(face)):
            if {face[i - 1], face[i]} == {a, b}:
                face.insert(i, middle)
                break


def marks(graph: Graph) -> dict[str, list[Any]]:
    """Return the keys that tell how to undo ``split``; none where nothing was split."""
    if not any(graph.cuts):
        return {}
    return {
        OF: [source[0] if len(source) == 1 else None for source in graph.vertex_source],
        CUT: list(graph.cuts),
    }


def join(graph: Graph, of: list[Any], cut: list[Any]) -> None:
    """Undo ``split`` in place; raises UnreadableFile where the keys do not fit the elements.

    The graph's sources then name the elements of the file that are kept.
    """
    vertices = [k for k, vertex in enumerate(of) if vertex == k]
    if not _fits(graph, of, cut, len(vertices)):
        raise UnreadableFile(
            f"{OF} and {CUT} do not fit the file's vertices and edges; leave both out to read the "
            f"cuts as the boundaries they were written as."
        )
    kept = [k for k, ends in enumerate(cut) if ends != []]
    graph.edges = [_joined(graph.edges[k], of, cut[k]) for k in kept]
    graph.letters = ["C" if cut[k] else graph.letters[k] for k in kept]
    graph.angles = [graph.angles[k] for k in kept]
    graph.faces = [[of[v] for v in face if of[v] is not None] for face in graph.faces]
    graph.vertex_source, graph.edge_source = numbered(len(vertices)), [(k,) for k in kept]


def _joined(edge: tuple[int, int], of: list[Any], ends: list[int] | None) -> tuple[int, int]:
    a, b = ends or (of[edge[0]], of[edge[1]])
    return a, b


def _fits(graph: Graph, of: list[Any], cut: list[Any], count: int) -> bool:
    """Tell whether the originals come first, and every other vertex and cut refers to them."""
    if len(of) != len(graph.vertex_source) or len(cut) != len(graph.edges):
        return False
    pairs = [ends for ends in cut if ends is not None]
    if not all(isinstance(ends, list) and len(ends) in {0, 2} for ends in pairs):
        return False
    whole = [v for edge, ends in zip(graph.edges, cut, strict=True) if ends is None for v in edge]
    named = [v for v in of[count:] if v is not None] + [v for ends in pairs for v in ends]
    return of[:count] == list(range(count)) and all(
        isinstance(v, int) and 0 <= v < count for v in named + [of[v] for v in whole]
    )
