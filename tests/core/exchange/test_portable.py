"""Files for particular programs hold the pattern, and nothing those programs stumble over."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from typing import Any

import hand_made
import numpy as np
import pytest

from foldmill import CreasePattern, Fold
from foldmill.exchange import portable, read, write
from foldmill.exchange.marking import marked
from foldmill.finding import Finding, Severity

KEYS = {
    *("file_spec", "file_creator", "file_title", "file_classes", "frame_classes"),
    *("frame_attributes", "frame_unit", "frame_description", "vertices_coords"),
    *("edges_vertices", "edges_assignment", "edges_foldAngle", "faces_vertices"),
}
WRITERS: list[Callable[[Fold], str]] = [
    portable.spatial,
    portable.flat,
    portable.downward,
    portable.plain,
    portable.strict,
]
NAMES = [writer.__name__ for writer in WRITERS]
JOINED = json.dumps(
    {
        "vertices_coords": [[0, 0], [30, 0], [60, 0], [60, 20], [30, 20], [0, 20]],
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 4]],
        "edges_assignment": ["B", "B", "B", "B", "B", "B", "J"],
        "faces_vertices": [[0, 1, 4, 5], [1, 2, 3, 4]],
        "edges_foldAngle": [0, 0, 0, 0, 0, 0, 0],
        "their:key": 7,
    }
)


def cut() -> Fold:
    """Return a square with a mountain, a valley that leads from it, and a cut inside."""
    points = [(0, 0), (60, 0), (60, 60), (0, 60), (20, 30), (40, 30)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 5), (5, 2), (3, 4), (5, 1)]
    angles = [0.0] * 4 + [-40.0, 0.0, 50.0, 30.0, -20.0]
    return Fold(CreasePattern.from_lines(points, edges, "BBBBMCVVM", angles))


def data(text: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(text)
    return found


def seen(fold: Fold) -> Counter[tuple[Any, ...]]:
    """Every line by place and kind, whatever its number."""
    ends = fold.pattern.vertices[fold.pattern.edges].round(6)
    lines = zip(
        fold.pattern.letters(),
        fold.pattern.fold_angles.round(6).tolist(),
        ends.tolist(),
        strict=True,
    )
    return Counter((letter, angle, *map(tuple, sorted(two))) for letter, angle, two in lines)


@pytest.mark.parametrize("writer", WRITERS, ids=NAMES)
def test_a_file_has_one_frame_and_no_key_of_anybodys_own(writer: Callable[[Fold], str]) -> None:
    for fold in (hand_made.fold(), cut(), read(JOINED)):
        assert set(data(writer(fold))) <= KEYS


@pytest.mark.parametrize("writer", WRITERS[:4], ids=NAMES[:4])
def test_simulators_meet_neither_the_letter_c_nor_j(writer: Callable[[Fold], str]) -> None:
    for fold in (cut(), read(JOINED)):
        assert set(data(writer(fold))["edges_assignment"]) <= set("BMVFU")


def test_a_cut_is_two_banks_for_a_simulator_and_one_line_by_the_letter() -> None:
    opened, whole = data(portable.plain(cut())), data(portable.strict(cut()))
    assert Counter(opened["edges_assignment"])["B"] - 4 >= 2
    assert Counter(whole["edges_assignment"])["C"] == 1
    assert "cuts" in whole["frame_attributes"]
    assert "noCuts" in opened["frame_attributes"]
    assert seen(read(portable.strict(cut()))) == seen(cut())


def test_a_join_comes_back_as_a_join_by_the_letter_only() -> None:
    whole = data(portable.strict(read(JOINED)))
    assert whole["edges_assignment"][6] == "J"
    assert "joins" in whole["frame_attributes"]
    assert data(portable.plain(read(JOINED)))["edges_assignment"][6] == "F"


def test_the_pattern_is_the_same_as_in_the_whole_file() -> None:
    fold = hand_made.fold()
    assert seen(read(portable.plain(fold))) == seen(read(write(fold))) == seen(fold)


def test_origami_simulator_gets_a_height_so_that_it_shows_the_front() -> None:
    flat, high = data(portable.plain(cut())), data(portable.spatial(cut()))
    assert high["vertices_coords"] == [[x, y, 0] for x, y in flat["vertices_coords"]]
    assert high["edges_foldAngle"] == flat["edges_foldAngle"]
    assert seen(read(portable.spatial(hand_made.fold()))) == seen(hand_made.fold())


def test_flat_folders_angles_are_closed_and_its_edges_begin_low() -> None:
    found = data(portable.flat(cut()))
    closed = {"M": -180, "V": 180, "B": 0}
    assert found["edges_foldAngle"] == [closed[letter] for letter in found["edges_assignment"]]
    assert all(a < b for a, b in found["edges_vertices"])
    places = np.array(found["vertices_coords"])
    for face in found["faces_vertices"]:
        x, y = places[face].T
        assert x @ np.roll(y, -1) - y @ np.roll(x, -1) > 0


def test_what_is_up_on_the_sheet_is_up_on_a_screen_that_counts_downward() -> None:
    found, plain = data(portable.downward(cut())), data(portable.plain(cut()))
    places, sheet = np.array(found["vertices_coords"]), np.array(plain["vertices_coords"])
    assert places.min(axis=0).tolist() == [0, 0]
    assert np.allclose(places[:, 1] + sheet[:, 1], 60)
    assert np.allclose(places[:, 0], sheet[:, 0])
    assert found["edges_assignment"] == plain["edges_assignment"]  # seen from the same face
    assert "faces_vertices" not in found


@pytest.mark.parametrize("writer", WRITERS, ids=NAMES)
def test_a_form_that_does_not_fold_says_so_in_every_file(writer: Callable[[Fold], str]) -> None:
    fault = Finding("crosses", Severity.ERROR, "edge 3", "It crosses edge 4.", "Move it.")
    assert data(writer(marked(cut(), [fault])))["frame_description"] == "DOES NOT FOLD: crosses"
    assert "frame_description" not in data(writer(cut()))
