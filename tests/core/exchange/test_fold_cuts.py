"""Inner cuts leave as two boundaries, which every simulator takes, and come back as cuts."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

import numpy as np
import pytest

from foldmill import CreasePattern, Fold, FoldedForm
from foldmill.exchange import read, write

SIDE = 4
"""Squares along the side of the sheet."""


def grid(cuts: list[tuple[int, int]]) -> Fold:
    """Return a sheet of SIDE × SIDE squares; ``cuts`` are pairs of neighbouring grid points."""
    n = SIDE + 1
    points = [[10.0 * x, 10.0 * y] for y in range(n) for x in range(n)]
    edges = [(y * n + x, y * n + x + 1) for y in range(n) for x in range(SIDE)]
    edges += [(y * n + x, y * n + x + n) for y in range(SIDE) for x in range(n)]
    letters = []
    for a, b in edges:
        on_rim = (a < n and b < n) or a >= n * SIDE or (b == a + n and a % n in {0, SIDE})
        letters.append("C" if (a, b) in cuts else "B" if on_rim else "M")
    pattern = CreasePattern.from_lines(points, edges, letters)
    return Fold(pattern, FoldedForm(np.column_stack([pattern.vertices, np.zeros(n * n)])))


SLIT = [(11, 12), (12, 13)]
CASES = {
    "a slit of two edges inside": (SLIT, 1),
    "a single edge inside": ([(12, 13)], 2),
    "two single edges side by side": ([(6, 7), (11, 12)], 4),
    "from the rim inwards": ([(10, 11)], 1),
    "right across": ([(10, 11), (11, 12), (12, 13), (13, 14)], 5),
    "a cross": ([*SLIT, (7, 12), (12, 17)], 3),
    "a closed square": ([(6, 7), (7, 12), (11, 12), (6, 11)], 4),
    "a square and a tail": ([(6, 7), (7, 12), (11, 12), (6, 11), (12, 13)], 5),
}


@pytest.mark.parametrize("case", CASES)
def test_a_cut_opens_in_the_file_and_closes_again(case: str) -> None:
    cuts, new_vertices = CASES[case]
    fold = grid(cuts)
    text = write(fold)
    data = json.loads(text)
    assert "C" not in data["edges_assignment"]
    assert len(data["vertices_coords"]) == len(fold.pattern.vertices) + new_vertices
    _assert_manifold(data)
    again = read(text)
    assert again.pattern.letters() == fold.pattern.letters()
    assert np.array_equal(again.pattern.edges, fold.pattern.edges)
    assert np.array_equal(again.pattern.vertices, fold.pattern.vertices)
    assert write(again) == text
    assert fold.folded is not None
    assert again.folded is not None
    assert np.array_equal(again.folded.vertices, fold.folded.vertices)


def _assert_manifold(data: dict[str, Any]) -> None:
    """Every edge but a boundary has a face on either side, every boundary on one, none is twice."""
    sides: Counter[frozenset[int]] = Counter()
    for face in data["faces_vertices"]:
        sides.update(frozenset(side) for side in zip(face, face[1:] + face[:1], strict=True))
    edges = [frozenset(edge) for edge in data["edges_vertices"]]
    assert len(set(edges)) == len(edges)
    for edge, letter in zip(edges, data["edges_assignment"], strict=True):
        assert sides[edge] == (1 if letter == "B" else 2)


def test_a_sheet_cut_right_across_falls_into_two_pieces_in_the_file() -> None:
    data = json.loads(write(grid(CASES["right across"][0])))
    linked = {v: v for v in range(len(data["vertices_coords"]))}

    def root(v: int) -> int:
        while linked[v] != v:
            v = linked[v]
        return v

    for a, b in data["edges_vertices"]:
        linked[root(a)] = root(b)
    assert len({root(v) for v in linked}) == 2


@pytest.mark.parametrize("case", CASES)
def test_what_an_array_says_of_a_vertex_or_an_edge_is_said_of_its_copies(case: str) -> None:
    plain = json.loads(write(grid([])))
    plain["vertices_x:place"] = [list(place) for place in plain["vertices_coords"]]
    plain["edges_x:number"] = list(range(len(plain["edges_vertices"])))
    plain["edges_assignment"] = [
        "C" if tuple(edge) in CASES[case][0] else letter
        for edge, letter in zip(plain["edges_vertices"], plain["edges_assignment"], strict=True)
    ]
    plain["edges_foldAngle"] = None
    del plain["edges_foldAngle"]
    text = write(read(json.dumps(plain)))
    data = json.loads(text)
    for place, said in zip(data["vertices_coords"], data["vertices_x:place"], strict=True):
        assert said in (place, None)
    middle = [(a + b) / 2 for a, b in zip(*data["vertices_coords"][12:14], strict=True)]
    assert data["vertices_x:place"].count(None) == data["vertices_coords"].count(middle) + (
        data["vertices_coords"].count([15.0, 10.0]) + data["vertices_coords"].count([15.0, 20.0])
    )
    assert set(data["edges_x:number"]) == set(plain["edges_x:number"])
    again = read(text).meta["fold"]["frame"]
    assert again["vertices_x:place"] == plain["vertices_x:place"]
    assert again["edges_x:number"] == plain["edges_x:number"]
    assert write(read(text)) == text


def test_frames_that_inherit_the_cut_sheet_are_opened_and_closed_with_it() -> None:
    data = json.loads(write(grid([])))
    data["edges_assignment"][data["edges_vertices"].index([12, 13])] = "C"
    data["edges_assignment"][data["edges_vertices"].index([11, 12])] = "C"
    del data["edges_foldAngle"]
    step = {
        "frame_title": "step", "frame_parent": 0, "frame_inherit": True,
        "vertices_coords": [[*place, 1] for place in data["vertices_coords"]],
    }  # fmt: skip
    data["file_frames"] = [step]
    text = write(read(json.dumps(data)))
    written = json.loads(text)
    assert len(written["file_frames"][0]["vertices_coords"]) == len(written["vertices_coords"])
    assert read(text).meta["fold"]["frames"][0]["vertices_coords"] == step["vertices_coords"]


def test_keys_about_cuts_that_do_not_fit_are_refused() -> None:
    data = json.loads(write(grid(SLIT)))
    data["vertices_foldmill:of"][-1] = 999
    with pytest.raises(ValueError, match="do not fit the file's vertices and edges"):
        read(json.dumps(data))


def test_without_our_keys_the_sides_of_a_cut_are_boundaries() -> None:
    data = json.loads(write(grid(SLIT)))
    del data["vertices_foldmill:of"], data["edges_foldmill:cut"]
    assert read(json.dumps(data)).pattern.letters().count("B") == 4 * SIDE + 4
