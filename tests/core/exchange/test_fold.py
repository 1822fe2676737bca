"""A FOLD file says all of a fold, and gives back whatever else it came with."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from foldmill import Assignment, CreasePattern, Fold, FoldedForm, Symmetry
from foldmill.check import check
from foldmill.exchange import read, write
from foldmill_plugins.rotational import DESIGN as ROTATIONAL
from foldmill_plugins.tuck import DESIGN as TUCK

SAMPLES = Path(__file__).parents[2] / "samples"
PATTERNS = ["ff_bad-twist-UNSAT", "ff_pinwheel", "fold_diagonal-cp"]

CHIRAL: dict[str, Any] = {
    # A sheet 3 × 2 with a valley nearer to its left side that leans to the right.
    "file_spec": 1.2,
    "frame_unit": "mm",
    "vertices_coords": [[0, 0], [1, 0], [3, 0], [3, 2], [1.5, 2], [0, 2]],
    "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 4]],
    "edges_assignment": ["B", "B", "B", "B", "B", "B", "V"],
    "edges_foldAngle": [0, 0, 0, 0, 0, 0, 90],
    "faces_vertices": [[5, 0, 1, 4], [1, 2, 3, 4]],
}


def chiral(**changes: Any) -> str:
    """Return the chiral sheet as a file, with some keys changed, or left out by None."""
    data = {**CHIRAL, **changes}
    return json.dumps({key: value for key, value in data.items() if value is not None})


def same(one: CreasePattern, two: CreasePattern) -> bool:
    names = ("vertices", "edges", "assignments", "fold_angles", "faces", "added", "polygons")
    return all(np.array_equal(getattr(one, name), getattr(two, name)) for name in names)


def test_the_stool_comes_back_from_its_file_as_it_was() -> None:
    stool = TUCK.run(TUCK.preset("stool-n8"))
    text = write(stool)
    again = read(text)
    assert same(again.pattern, stool.pattern)
    assert stool.folded is not None
    assert again.folded is not None
    assert np.array_equal(again.folded.vertices, stool.folded.vertices)
    assert again.meta["design"] == stool.meta["design"]
    assert again.meta["title"] == stool.meta["title"]
    assert write(again) == text
    assert not check(again).findings
    assert TUCK.validate(again.meta["design"]["params"]) == TUCK.preset("stool-n8")


def test_symmetry_survives_so_that_half_a_wedge_still_decides() -> None:
    made = ROTATIONAL.run()
    again = read(write(made))
    assert made.symmetry is not None
    assert again.symmetry is not None
    assert again.symmetry.order == made.symmetry.order
    assert again.symmetry.one_sided is made.symmetry.one_sided
    assert np.array_equal(again.symmetry.wedge, made.symmetry.wedge)


def test_seams_survive() -> None:
    made = ROTATIONAL.run()
    assert made.folded is not None
    seamed = replace(made, folded=FoldedForm(made.folded.vertices, np.array([[1, 2], [3, 5]])))
    again = read(write(seamed)).folded
    assert again is not None
    assert again.seams.tolist() == [[1, 2], [3, 5]]


def test_the_file_is_what_every_reader_takes() -> None:
    data = json.loads(write(TUCK.run(TUCK.preset("stool-n8"))))
    assert data["file_spec"] == 1.2
    assert data["file_creator"] == "foldmill"
    assert data["frame_unit"] == "mm"
    assert data["frame_classes"] == ["creasePattern"]
    (folded,) = data["file_frames"]
    assert folded["frame_classes"] == ["foldedForm"]
    assert (folded["frame_parent"], folded["frame_inherit"]) == (0, True)
    assert {len(place) for place in folded["vertices_coords"]} == {3}
    _assert_portable(data)


def _assert_portable(data: dict[str, Any]) -> None:
    """Hold a file against the format's own words, with no code of ours."""
    count, edges = len(data["vertices_coords"]), data["edges_vertices"]
    assert len(edges) == len(data["edges_assignment"]) == len(data["edges_foldAngle"])
    assert set(data["edges_assignment"]) <= set("BMVFU")
    sign = {"M": -1, "V": 1}
    for letter, angle in zip(data["edges_assignment"], data["edges_foldAngle"], strict=True):
        assert sign.get(letter, 0) * angle >= 0
        assert letter in "MVU" or angle == 0
    sides = []
    for face in data["faces_vertices"]:
        assert all(0 <= vertex < count for vertex in face)
        corners = [data["vertices_coords"][vertex] for vertex in face]
        turns = zip(corners, corners[1:] + corners[:1], strict=True)
        assert sum(a[0] * b[1] - a[1] * b[0] for a, b in turns) > 0
        sides += list(zip(face, face[1:] + face[:1], strict=True))
    assert len(sides) == len(set(sides))
    for (a, b), letter in zip(edges, data["edges_assignment"], strict=True):
        assert ((a, b) in sides) + ((b, a) in sides) == (1 if letter == "B" else 2)


@pytest.mark.parametrize("name", PATTERNS)
def test_other_peoples_patterns_come_back_whole(name: str) -> None:
    text = (SAMPLES / f"{name}.fold").read_text(encoding="utf-8")
    fold, given = read(text), json.loads(text)
    written = write(fold)
    again = json.loads(written)
    assert write(read(written)) == written
    for key in ("vertices_coords", "edges_vertices", "edges_assignment", "faces_vertices"):
        assert again[key] == given[key]
    for key in ("file_author", "file_title", "cpedit:page"):
        assert again.get(key) == given.get(key)
    _assert_portable(again)
    assert not [f for f in check(fold).findings if f.code != "not-checked"]


@pytest.mark.parametrize("name", ["fold_simple", "fold_box-layers", "fold_diagonal-folded"])
def test_a_folded_form_without_its_pattern_is_no_sheet_to_cut(name: str) -> None:
    with pytest.raises(ValueError, match=f"^{name}: .*folded form without its flat pattern"):
        read((SAMPLES / f"{name}.fold").read_text(encoding="utf-8"), name)


def test_polygons_are_triangulated_inside_and_whole_in_the_file() -> None:
    fold = read(chiral())
    assert len(fold.pattern.faces) == 4
    assert fold.pattern.count(Assignment.F) == 2
    assert json.loads(write(fold))["faces_vertices"] == CHIRAL["faces_vertices"]


def test_a_file_asked_for_triangle_by_triangle_says_which_edges_were_added() -> None:
    fold = read(chiral(**{"edges_x:name": list("abcdefg"), "faces_x:name": ["left", "right"]}))
    text = write(fold, triangulated=True)
    data = json.loads(text)
    assert len(data["faces_vertices"]) == 4
    assert data["edges_foldmill:added"] == [False] * 7 + [True] * 2
    assert data["edges_x:name"] == [*"abcdefg", None, None]
    assert data["faces_x:name"] == ["left", "left", "right", "right"]
    again = read(text)
    assert same(again.pattern, fold.pattern)
    assert json.loads(write(again))["edges_x:name"] == [*"abcdefg"]
    assert write(again, triangulated=True) == text


def test_triangles_that_a_symmetry_names_stay_triangles() -> None:
    fold = replace(read(chiral()), symmetry=Symmetry(1, np.array([1, 3]), True))
    again = read(write(fold))
    assert same(again.pattern, fold.pattern)
    assert again.symmetry is not None
    assert again.symmetry.wedge.tolist() == [1, 3]


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("mm", 1), ("cm", 10), ("m", 1000), ("in", 25.4), ("pt", 25.4 / 72), ("um", 1e-3)],
)
def test_any_unit_becomes_millimetres(unit: str, factor: float) -> None:
    coords = [[x * 1000, y * 1000] for x, y in CHIRAL["vertices_coords"]]
    fold = read(chiral(frame_unit=unit, vertices_coords=coords))
    assert fold.pattern.size == pytest.approx(3000 * factor, rel=1e-15)
    assert json.loads(write(fold))["frame_unit"] == "mm"


@pytest.mark.parametrize("unit", ["unit", None])
def test_a_file_without_a_unit_is_taken_as_millimetres_and_says_so(unit: str | None) -> None:
    fold = read(chiral(frame_unit=unit))
    assert fold.pattern.size == 3
    assert "taken as millimetres" in fold.meta["fold"]["notes"][0]


def test_a_sheet_of_clockwise_faces_is_seen_from_its_back_and_turned_over() -> None:
    backward = read(chiral(faces_vertices=[[4, 1, 0, 5], [4, 3, 2, 1]]))
    front = read(
        chiral(
            vertices_coords=[[x, -y] for x, y in CHIRAL["vertices_coords"]],
            faces_vertices=[[4, 1, 0, 5], [4, 3, 2, 1]],
        )
    )
    assert same(backward.pattern, front.pattern)
    assert "turned over" in backward.meta["fold"]["notes"][0]
    assert not front.meta["fold"]["notes"]


def test_faces_that_run_either_way_are_turned_round_and_their_layer_orders_with_them() -> None:
    mixed = read(
        chiral(faces_vertices=[[5, 4, 1, 0], [1, 2, 3, 4]], faceOrders=[[1, 0, 1], [0, 1, -1]])
    )
    assert same(mixed.pattern, read(chiral()).pattern)
    assert mixed.meta["fold"]["frame"]["faceOrders"] == [[1, 0, -1], [0, 1, -1]]
    assert "1 of 2 faces run clockwise" in mixed.meta["fold"]["notes"][0]


def test_faces_are_found_where_a_file_lists_none() -> None:
    given, found = read(chiral()), read(chiral(faces_vertices=None))
    one, two = ({frozenset(face) for face in f.pattern.faces.tolist()} for f in (given, found))
    assert one == two


def test_edges_are_the_sides_of_the_faces_where_a_file_lists_none() -> None:
    fold = read(chiral(edges_vertices=None, edges_assignment=None, edges_foldAngle=None))
    assert sorted(fold.pattern.letters()) == sorted("BBBBBB" + "U" + "FF")


def test_assignments_follow_the_fold_angles_where_a_file_lists_none() -> None:
    assert read(chiral(edges_assignment=None)).pattern.letters() == "BBBBBBVFF"


def test_the_names_of_fold_1_0_are_read() -> None:
    old = chiral(
        edges_foldAngle=None, edges_foldAngles=[0, 0, 0, 0, 0, 0, 45], edges_lengths=[1] * 7
    )
    fold = read(old)
    assert fold.pattern.fold_angles[6] == 45
    assert "edges_lengths" not in write(fold)


@pytest.mark.parametrize("angles", [None, [None] * 7])
def test_an_unstated_fold_angle_is_that_of_a_sheet_folded_flat(angles: Any) -> None:
    assert read(chiral(edges_foldAngle=angles)).pattern.fold_angles[6] == 180
    letters = ["B"] * 6 + ["M"]
    assert (
        read(chiral(edges_foldAngle=angles, edges_assignment=letters)).pattern.fold_angles[6]
        == -180
    )


def test_a_join_becomes_flat_and_stays_known_as_a_join() -> None:
    written = write(read(chiral(edges_assignment=["B"] * 6 + ["J"], edges_foldAngle=None)))
    data = json.loads(written)
    assert data["edges_assignment"] == ["B"] * 6 + ["F"]
    assert data["edges_foldmill:join"] == [False] * 6 + [True]
    assert write(read(written)) == written


def test_a_third_dimension_that_is_level_is_a_sheet_at_some_height() -> None:
    level = read(chiral(vertices_coords=[[x, y, 7] for x, y in CHIRAL["vertices_coords"]]))
    assert same(level.pattern, read(chiral()).pattern)


def test_unknown_keys_survive_frame_by_frame() -> None:
    frames: list[dict[str, Any]] = [
        {"frame_classes": ["diagram"], "x:page": 3, "frame_parent": 0, "frame_inherit": True},
        {"frame_title": "step", "frame_parent": 1, "vertices_x:y": [1, 2], "deep": [{"a": None}]},
    ]
    text = write(
        read(
            chiral(
                **{
                    "file_author": "Ünal \ud83e\udd9a",
                    "x:any": {"b": [1, 2.5, "x"], "a": None},
                    "file_x:y": 1,
                    "frame_description": "two\nlines",
                    "file_frames": frames,
                    "vertices_x:name": [*"abcdef"],
                    "edges_x:odd": [1, 2],
                    "frame_attributes": ["2D", "x:soft"],
                    "frame_classes": ["creasePattern", "x:draft"],
                }
            )
        )
    )
    data = json.loads(text)
    assert data["file_frames"] == frames
    assert data["x:any"] == {"b": [1, 2.5, "x"], "a": None}
    assert data["vertices_x:name"] == [*"abcdef"]
    assert data["edges_x:odd"] == [1, 2]
    assert (data["file_author"], data["file_x:y"]) == ("Ünal 🦚", 1)
    assert data["frame_description"] == "two\nlines"
    assert data["frame_attributes"][-1] == "x:soft"
    assert data["frame_classes"] == ["creasePattern", "x:draft"]
    assert write(read(text)) == text


def solid(turn: float) -> list[list[float]]:
    """Return the chiral sheet in space, its right part turned about its crease by deg."""
    places = np.column_stack([CHIRAL["vertices_coords"], np.zeros(6)])
    axis = (places[4] - places[1]) / np.linalg.norm(places[4] - places[1])
    angle = np.radians(turn)
    for vertex in (2, 3):
        arm = places[vertex] - places[1]
        along = axis * (arm @ axis)
        # A valley lifts what lies to the right of its crease towards the viewer.
        places[vertex] = places[1] + along + (arm - along) * np.cos(angle)
        places[vertex] += np.array([0, 0, 1]) * np.linalg.norm(arm - along) * np.sin(angle)
    return [[float(x) for x in place] for place in places]


def test_a_second_frame_in_space_is_the_folded_form_with_keys_of_its_own() -> None:
    folded = {
        "frame_classes": ["foldedForm"], "frame_parent": 0, "frame_inherit": True,
        "vertices_coords": solid(90), "faceOrders": [[0, 1, 1]], "x:look": "oblique",
    }  # fmt: skip
    fold = read(chiral(file_frames=[folded]))
    assert not check(fold).findings
    text = write(fold)
    assert json.loads(text)["file_frames"][0]["faceOrders"] == [[0, 1, 1]]
    assert json.loads(text)["file_frames"][0]["x:look"] == "oblique"
    assert write(read(text)) == text


def test_a_folded_form_that_comes_first_changes_places_and_takes_its_children_along() -> None:
    drawn = {"frame_classes": ["creasePattern"], "frame_parent": 0, "frame_inherit": True,
             "vertices_coords": CHIRAL["vertices_coords"]}  # fmt: skip
    step = {"frame_title": "step", "frame_parent": 0, "frame_inherit": True}
    text = chiral(
        frame_classes=["foldedForm"], vertices_coords=solid(90), file_frames=[drawn, step]
    )
    fold = read(text)
    assert not check(fold).findings
    frames = json.loads(write(fold))["file_frames"]
    assert frames[0]["frame_classes"] == ["foldedForm"]
    assert frames[1] == {"frame_title": "step", "frame_parent": 1, "frame_inherit": True}
    assert write(read(write(fold))) == write(fold)


def test_a_step_on_the_way_is_no_folded_form_but_stays_in_the_file() -> None:
    step = {"frame_classes": ["foldedForm"], "frame_parent": 0, "frame_inherit": True,
            "vertices_coords": solid(40), "edges_foldAngle": [0, 0, 0, 0, 0, 0, 40]}  # fmt: skip
    fold = read(chiral(file_frames=[step]))
    assert fold.folded is None
    assert json.loads(write(fold))["file_frames"] == [step]


def test_a_frame_that_inherited_inches_keeps_them_when_the_pattern_becomes_millimetres() -> None:
    step = {
        "frame_title": "step",
        "frame_parent": 0,
        "frame_inherit": True,
        "vertices_coords": [[1, 1]],
    }
    (kept,) = json.loads(write(read(chiral(frame_unit="in", file_frames=[step]))))["file_frames"]
    assert kept == {"frame_unit": "in", **step}


def test_a_fold_that_got_its_folded_form_later_keeps_the_parents_of_other_frames() -> None:
    one = {"frame_title": "one", "frame_parent": 0, "frame_inherit": True}
    two = {"frame_title": "two", "frame_parent": 1, "frame_inherit": True}
    flat = read(chiral(file_frames=[one, two]))
    assert json.loads(write(flat))["file_frames"] == [one, two]
    folded = replace(flat, folded=FoldedForm(np.array(solid(90))))
    frames = json.loads(write(folded))["file_frames"]
    assert [frame.get("frame_title") for frame in frames] == [None, "one", "two"]
    assert frames[2]["frame_parent"] == 2
    assert write(read(write(folded))) == write(folded)


def test_the_same_fold_gives_the_same_text_and_another_does_not() -> None:
    fold = read(chiral())
    assert write(fold) == write(read(chiral()))
    assert write(fold).endswith("}\n")
    moved = Fold(CreasePattern.from_lines(fold.pattern.vertices + 1e-9, *_lines(fold)))
    assert write(moved) != write(fold)


def _lines(fold: Fold) -> tuple[Any, str]:
    return fold.pattern.edges[:7], fold.pattern.letters()[:7]
