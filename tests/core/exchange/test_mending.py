"""Lines of a foreign file that cross or lie on each other become a crease pattern when asked to."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from slit_forms import form

from foldmill import Fold, UnreadableFile, installed
from foldmill.exchange import read, write

SAMPLES = Path(__file__).parents[2] / "samples"
PATTERNS = ["ff_bad-twist-UNSAT", "ff_pinwheel", "fold_diagonal-cp"]
PRESETS = [(slug, name) for slug, design in installed().designs.items() for name in design.presets]
SQUARE = [(0.0, 0.0, 10.0, 0.0), (10, 0, 10, 10), (10, 10, 0, 10), (0, 10, 0, 0)]
Line = tuple[float, float, float, float]


def drawing(lines: Sequence[Line], letters: str, **keys: Any) -> str:
    """Return loose lines upon a square of 10 mm as a FOLD file: no two share a vertex."""
    every = [*SQUARE, *lines]
    points = [list(end) for x, y, u, v in every for end in ((x, y), (u, v))]
    data = {
        "file_spec": 1.2,
        "frame_unit": "mm",
        "vertices_coords": points,
        "edges_vertices": [[2 * k, 2 * k + 1] for k in range(len(every))],
        "edges_assignment": list("BBBB" + letters),
        **keys,
    }
    return json.dumps(data)


def pieces(fold: Fold) -> list[tuple[str, float, shapely.Geometry]]:
    """Return letter, fold angle and line of every edge that was drawn."""
    pattern = fold.pattern
    drawn = ~np.asarray(pattern.added)
    ends = shapely.linestrings(pattern.vertices[pattern.edges[drawn]])
    letters = np.array(list(pattern.letters()))[drawn].tolist()
    return list(zip(letters, pattern.fold_angles[drawn].tolist(), ends, strict=True))


def drawn(fold: Fold, letter: str) -> shapely.Geometry:
    return shapely.union_all([line for own, _, line in pieces(fold) if own == letter])


@pytest.mark.parametrize(("slug", "name"), PRESETS)
def test_a_file_of_our_own_is_read_the_same_to_the_byte(slug: str, name: str) -> None:
    design = installed().design(slug)
    text = write(design.run(design.preset(name)))
    again = read(text, planarise=True)
    assert write(again) == text
    assert not again.findings


def test_the_banks_of_a_slit_stay_two() -> None:
    text = write(form("star-n6", slit=True))
    assert write(read(text, planarise=True)) == text


@pytest.mark.parametrize("name", PATTERNS)
def test_a_sample_that_is_planar_already_is_read_as_it_was(name: str) -> None:
    text = (SAMPLES / f"{name}.fold").read_text()
    assert write(read(text, planarise=True)) == write(read(text))


@pytest.mark.parametrize("name", ["ff_pinwheel", "fold_diagonal-cp"])
def test_a_sample_drawn_as_loose_overlong_lines_folds_as_before(name: str) -> None:
    """Every line is given loose, twice, and half of the second one beyond its middle."""
    whole = read((SAMPLES / f"{name}.fold").read_text())
    given_lines = [(letter, angle, line) for letter, angle, line in pieces(whole)]
    loose = [*given_lines, *((a, b, shapely.reverse(line)) for a, b, line in given_lines)]
    ends = np.array([shapely.get_coordinates(line) for *_, line in loose]) * 100
    text = {
        "frame_unit": "mm",
        "vertices_coords": ends.reshape(-1, 2).tolist(),
        "edges_vertices": np.arange(2 * len(ends)).reshape(-1, 2).tolist(),
        "edges_assignment": [letter for letter, *_ in loose],
        "edges_foldAngle": [angle for _, angle, _ in loose],
    }
    with pytest.raises(UnreadableFile):
        read(json.dumps(text))
    found = read(json.dumps(text), planarise=True)
    assert {f.code for f in found.findings} >= {"mended-overlap"}
    for letter in "BMV":
        wanted = shapely.transform(drawn(whole, letter), lambda xy: 100 * xy)
        assert drawn(found, letter).symmetric_difference(wanted).length < 1e-6


def test_split_creases_keep_their_letters_and_angles() -> None:
    text = drawing(
        [(0, 0, 10, 10), (0, 10, 10, 0)], "MV", edges_foldAngle=[0, 0, 0, 0, -90.0, 45.0]
    )
    found = read(text, planarise=True)
    creases = sorted((letter, angle, line.length) for letter, angle, line in pieces(found))[4:]
    half = pytest.approx(50**0.5)
    assert creases == [("M", -90, half), ("M", -90, half), ("V", 45, half), ("V", 45, half)]
    assert ("mended-crossing", (5.0, 5.0)) in [(f.code, f.at) for f in found.findings]


def test_of_lines_upon_each_other_the_longer_stays_and_joints_close() -> None:
    lines: list[Line] = [(0, 5, 6, 5), (2, 5, 10, 5), (3, 5, 4, 5)]
    found = read(drawing(lines, "MMM"), planarise=True)
    (crease,) = [line for letter, _, line in pieces(found) if letter == "M"]
    assert crease.length == 10
    said = {f.code: f.message for f in found.findings}
    assert "4 stretches" in said["mended-overlap"]  # 2 to 3, 3 to 4 of two lines, 4 to 6


def test_a_crease_upon_the_outline_gives_way_to_it() -> None:
    found = read(drawing([(0, 0, 6, 0), (0, 5, 10, 5)], "MV"), planarise=True)
    assert {letter for letter, *_ in pieces(found)} == {"B", "V"}
    assert drawn(found, "B").length == 40


@pytest.mark.parametrize(
    ("letters", "angles", "said"),
    [("MV", (-180, 180), "is M, -180"), ("MM", (-180, -90), "is M, -90")],
)
def test_creases_upon_each_other_that_fold_differently_are_refused_with_their_place(
    letters: str, angles: tuple[float, float], said: str
) -> None:
    lines: list[Line] = [(0, 5, 10, 5), (4, 5, 6, 5)]
    text = drawing(lines, letters, edges_foldAngle=[0, 0, 0, 0, *angles])
    with pytest.raises(UnreadableFile, match=r"at \(5, 5\) mm") as refusal:
        read(text, "cp.fold", planarise=True)
    assert said in str(refusal.value)
    assert "edge 4" in str(refusal.value)
    assert "edge 5" in str(refusal.value)


def test_what_is_said_of_a_line_is_said_of_all_its_pieces() -> None:
    names = ["a", "b", "c", "d", "one", "two"]
    text = drawing(
        [(0, 0, 10, 10), (0, 10, 10, 0)],
        "MV",
        **{"edges_x:name": names, "vertices_x:n": list(range(12)), "x:whole": [1, 2]},
    )
    kept = read(text, planarise=True).meta["fold"]["frame"]
    assert sorted(kept["edges_x:name"]) == ["a", "b", "c", "d", "one", "one", "two", "two"]
    assert kept["vertices_x:n"].count(None) == 1
    assert kept["x:whole"] == [1, 2]


def test_inches_are_mended_in_millimetres() -> None:
    found = read(drawing([(0, 0, 10, 10), (0, 10, 10, 0)], "MV", frame_unit="in"), planarise=True)
    assert np.ptp(found.pattern.vertices, axis=0) == pytest.approx([254, 254])


def test_a_mended_sheet_seen_from_its_back_is_turned_over() -> None:
    """All faces clockwise: the valley from the lower left becomes one from the upper left."""
    outline = [[0, 0], [4, 0], [4, 2], [0, 2], [0, 0], [2, 2], [2, 0], [2, 2]]
    text = {
        "frame_unit": "mm",
        "vertices_coords": outline,
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]],
        "edges_assignment": list("BBBBV"),
        "faces_vertices": [[0, 3, 2, 1]],
    }
    found = read(json.dumps(text), planarise=True)
    (valley,) = [line for letter, _, line in pieces(found) if letter == "V"]
    assert valley.equals(shapely.LineString([(0, 0), (2, -2)]))


@given(st.integers(0, 10_000), st.integers(1, 7))
@settings(max_examples=60)
def test_lines_across_a_square_cover_what_they_did_and_fold_as_they_did(
    seed: int, count: int
) -> None:
    """Lines on a grid, from rim to rim; where two lie upon each other they are of one kind."""
    rng = np.random.default_rng(seed)
    a, b = rng.integers(0, 11, (2, count)).tolist()
    lines: list[Line] = [
        (float(p), 0.0, float(q), 10.0) if k % 2 else (0.0, float(p), 10.0, float(q))
        for k, (p, q) in enumerate(zip(a, b, strict=True))
    ]
    letters = "".join(
        "MV"[(2 * p + 3 * q + k) % 2] for k, (p, q) in enumerate(zip(a, b, strict=True))
    )
    if any(one == two for k, one in enumerate(lines) for two in lines[:k]):
        return
    at = dict(zip(lines, letters, strict=True))
    found = read(drawing(lines, letters), planarise=True)
    rim = shapely.LinearRing(shapely.box(0, 0, 10, 10).exterior.coords)
    for letter in "MV":
        own = [shapely.LineString([line[:2], line[2:]]) for line in lines if at[line] == letter]
        wanted = shapely.union_all(own).difference(rim.buffer(1e-9))
        assert drawn(found, letter).length == pytest.approx(wanted.length, abs=1e-5)
        assert drawn(found, letter).difference(wanted.buffer(2e-3)).length == 0
    area = found.pattern.vertices[found.pattern.faces]
    assert sum(shapely.Polygon(t).area for t in area) == pytest.approx(100)
    assert write(read(write(found), planarise=True)) == write(found)
