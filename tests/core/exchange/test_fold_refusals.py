"""A wrong FOLD file gets one sentence that names the element, never a traceback."""

from __future__ import annotations

import json
import random
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from foldmill import UnreadableFile
from foldmill.check import check
from foldmill.exchange import read, write
from foldmill_plugins.rotational import DESIGN

SQUARE: dict[str, Any] = {
    "frame_unit": "mm",
    "vertices_coords": [[0, 0], [10, 0], [10, 10], [0, 10]],
    "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
    "edges_assignment": ["B", "B", "B", "B", "V"],
    "faces_vertices": [[0, 1, 2], [0, 2, 3]],
}
COORDS = SQUARE["vertices_coords"]

WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "no vertices": ({"vertices_coords": None}, "There are no vertices (vertices_coords)"),
    "no lines": ({"edges_vertices": None, "faces_vertices": None}, "There are no edges"),
    "nothing assigned": (
        {"edges_assignment": None, "faces_vertices": None},
        "needs edges_assignment",
    ),
    "text for a place": (
        {"vertices_coords": [*COORDS[:3], "x"]},
        "Vertex 3 must be 2 or 3 numbers",
    ),
    "a billion too far": ({"vertices_coords": [*COORDS[:3], [0, 1e10]]}, "Vertex 3 must be"),
    "an edge to nowhere": ({"edges_vertices": [[0, 1], [1, 9]]}, "edge 1 names the vertex 9"),
    "an edge of three": ({"edges_vertices": [[0, 1, 2]]}, "edge 0 must name two vertices"),
    "an edge in a point": ({"edges_vertices": [[0, 0]]}, "edge 0 meets one vertex twice"),
    "a face of two": ({"faces_vertices": [[0, 1]]}, "face 0 must name at least three"),
    "a face to nowhere": ({"faces_vertices": [[0, 1, -1]]}, "face 0 names the vertex -1"),
    "a letter too few": ({"edges_assignment": [*"BBBB"]}, "4 entries for 5 edges"),
    "a letter nobody knows": ({"edges_assignment": [*"BBBBX"]}, "edge 4 is 'X'"),
    "an angle too few": ({"edges_foldAngle": [0]}, "1 entries for 5 edges"),
    "an angle that is text": ({"edges_foldAngle": [0, 0, 0, 0, "a"]}, "fold angle of edge 4"),
    "a mountain folded up": ({"edges_foldAngle": [0, 0, 0, 0, -90]}, "edge 4: a mountain folds by"),
    "an angle beyond 180": (
        {"edges_foldAngle": [0, 0, 0, 0, 200]},
        "edge 4 folds by more than 180",
    ),
    "a side that is no edge": ({"faces_vertices": [[0, 1, 3], [0, 2, 3]]}, "side 1-3, which is no"),
    "paper upon paper": (
        {"faces_vertices": [[0, 1, 2], [0, 1, 2]]},
        "faces 0 and 1 lie on the same side of the edge 0-1",
    ),
    "a crease at the rim": ({"edges_assignment": [*"BBVBV"]}, "edge 2 (2-3) is marked V"),
    "a boundary inside": ({"edges_assignment": [*"BBBBB"]}, "edge 4 (0-2) is marked B"),
    "a face of no area": (
        {"vertices_coords": [[0, 0], [5, 5], [10, 10], [0, 10]]},
        "face 0 has no area",
    ),
    "a line that ends inside": (
        {
            "faces_vertices": None,
            "vertices_coords": [*COORDS, [5, 4]],
            "edges_vertices": [*SQUARE["edges_vertices"][:4], [0, 4]],
        },
        "end inside the sheet",
    ),
    "an unknown unit": ({"frame_unit": "ell"}, "'ell' is none of the format's units"),
    "a unit without end": ({"frame_unit": 10**400}, "is none of the format's units"),
    "frames that are none": ({"file_frames": [1]}, "file_frames must be a list"),
    "a frame that inherits from itself": (
        {"file_frames": [{"frame_parent": 1, "frame_inherit": True}]},
        "Frame 1 inherits from frame 1",
    ),
    "a symmetry of broken order": (
        {"foldmill:symmetry": {"order": 2.7, "wedge": [0], "one_sided": True}},
        "foldmill:symmetry must have a whole order",
    ),
    "a symmetry with half a face": (
        {"foldmill:symmetry": {"order": 2, "wedge": [0.5], "one_sided": True}},
        "foldmill:symmetry must have a whole order",
    ),
    "a symmetry that is perhaps one-sided": (
        {"foldmill:symmetry": {"order": 2, "wedge": [0], "one_sided": "perhaps"}},
        "foldmill:symmetry must have a whole order",
    ),
    "a symmetry that is a number": ({"foldmill:symmetry": 6}, "foldmill:symmetry must have"),
    "a symmetry without order": ({"foldmill:symmetry": {"wedge": [0]}}, "foldmill:symmetry"),
    "a wedge of no face": (
        {"foldmill:symmetry": {"order": 3, "wedge": [7], "one_sided": True}},
        "faces that are not there",
    ),
    "a polygon of astronomical number": (
        {"edges_foldmill:added": [False] * 5, "faces_foldmill:polygon": [0, 10**400]},
        "do not fit",
    ),
    "marks that do not fit": (
        {"edges_foldmill:added": [True], "faces_foldmill:polygon": [0, 0]},
        "do not fit",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_is_named(case: str) -> None:
    changes, said = WRONG[case]
    data = {k: v for k, v in {**SQUARE, **changes}.items() if v is not None}
    with pytest.raises(UnreadableFile) as refusal:
        read(json.dumps(data), "chair.fold")
    assert str(refusal.value).startswith("chair.fold: ")
    assert said in str(refusal.value)
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 400


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "This is no JSON: Expecting value at line 1, column 1."),
        ('{\n "a": 1,,\n}', "at line 2, column 9"),
        ("[1, 2]", "A FOLD file is a JSON object, this one is a list."),
        ('{"vertices_coords": [[NaN, 0]]}', "NaN is no number"),
        ('{"a": ' + "9" * 5000 + "}", "This is no JSON"),
        ("[" * 100_000, "nested too deeply"),
        ("%PDF-1.4", "This is no JSON"),
    ],
    ids=["empty", "commas", "list", "nan", "huge", "deep", "pdf"],
)
def test_what_is_no_json_object_is_no_fold_file(text: str, said: str) -> None:
    with pytest.raises(UnreadableFile) as refusal:
        read(text)
    assert said in str(refusal.value)


def test_a_byte_order_mark_is_no_reason_to_refuse() -> None:
    assert read("\ufeff" + json.dumps(SQUARE)).pattern.letters() == "BBBBV"


JUNK: list[Any] = [
    None, True, -1, 0, 3, 10**400, 1.5, 1e300, "", "M", "mm", [], [0], [0, 1], [[0, 0]], [None],
    {}, {"a": 1}, ["B", 1], [[0, 1], [1, 2]], [[0, 1, 2]], [1, 0, 1], "creasePattern",
]  # fmt: skip


def test_no_damage_to_a_file_gets_past_a_sentence() -> None:
    samples = sorted((Path(__file__).parents[2] / "samples").glob("*.fold"))
    files = [write(DESIGN.run()), *(path.read_text(encoding="utf-8") for path in samples)]
    rng, refused = random.Random(20), 0
    for turn in range(1000):
        data = json.loads(files[turn % len(files)])
        for _ in range(rng.choice([1, 1, 2])):
            _damage(data, rng)
        try:
            fold = read(json.dumps(data))
        except UnreadableFile:
            refused += 1
        else:
            check(fold)
            written = write(fold)
            assert write(read(written)) == written
    assert 200 < refused < 950


def _damage(data: dict[str, Any], rng: random.Random) -> None:
    """Put junk somewhere into a file, take something out of it, or double it."""
    holder: Any = data
    while True:
        keys = list(holder) if isinstance(holder, dict) else list(range(len(holder)))
        if not keys:
            return
        key = rng.choice(keys)
        inner = holder[key]
        if isinstance(inner, dict | list) and inner and rng.random() < 0.6:
            holder = inner
            continue
        if rng.random() < 0.3:
            del holder[key]
        elif isinstance(holder, list) and rng.random() < 0.3:
            holder.append(deepcopy(inner))
        else:
            holder[key] = deepcopy(rng.choice(JUNK))
        return


def test_lines_that_cross_without_a_vertex_are_refused_as_such() -> None:
    crossed = {
        **SQUARE,
        "edges_vertices": [*SQUARE["edges_vertices"], [1, 3]],
        "edges_assignment": [*"BBBBVM"],
        "faces_vertices": None,
    }
    crossed = {key: value for key, value in crossed.items() if value is not None}
    with pytest.raises(UnreadableFile, match=r"edge 4 meets another .* at \(5, 5\) mm"):
        read(json.dumps(crossed))
