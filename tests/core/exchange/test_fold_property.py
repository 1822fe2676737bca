"""Whatever lies in a FOLD file, writing it and reading it again changes nothing."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill.check import planarity
from foldmill.design import Fold
from foldmill.exchange import read, write

JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3)
    ),
    max_leaves=6,
)
NAMES = st.text(st.characters(categories=["Ll", "Lu", "Nd"]), min_size=1, max_size=6)


@st.composite
def sheets(draw: st.DrawFn) -> dict[str, Any]:
    """Draw a sheet of bent squares, some of them halved, all sorts of lines between them."""
    nx, ny = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    shift = st.floats(-0.2, 0.2)
    coords = [
        [20 * (x + draw(shift)), 20 * (y + draw(shift))]
        for y in range(ny + 1)
        for x in range(nx + 1)
    ]
    faces = [
        face
        for y in range(ny)
        for x in range(nx)
        for face in _square(y * (nx + 1) + x, nx + 1, draw(st.booleans()))
    ]
    sides = [side for face in faces for side in zip(face, face[1:] + face[:1], strict=True)]
    edges = sorted({tuple(sorted(side)) for side in sides})
    letters = [
        draw(st.sampled_from("MVFUCJ")) if {(a, b), (b, a)} <= set(sides) else "B" for a, b in edges
    ]
    share = st.floats(0.01, 1)
    angles = [{"M": -180, "V": 180}.get(letter, 0) * draw(share) for letter in letters]
    turned = [_turned(face, draw(st.integers(0, 3))) for face in faces]
    data: dict[str, Any] = {
        "frame_unit": draw(st.sampled_from(["mm", "cm", "unit"])),
        "vertices_coords": coords,
        "edges_vertices": [list(e)[:: draw(st.sampled_from([1, -1]))] for e in edges],
        "edges_assignment": letters,
        "edges_foldAngle": angles,
        "faces_vertices": turned,
        "vertices_x:a": draw(st.lists(JSON, min_size=len(coords), max_size=len(coords))),
        "edges_x:a": draw(st.lists(JSON, min_size=len(edges), max_size=len(edges))),
        "faces_x:a": draw(st.lists(JSON, min_size=len(faces), max_size=len(faces))),
        "file_frames": draw(
            st.lists(st.dictionaries(NAMES, JSON, min_size=1, max_size=2), max_size=2)
        ),
    }
    return data | {f"y:{k}": v for k, v in draw(st.dictionaries(NAMES, JSON, max_size=3)).items()}


def _square(corner: int, row: int, halved: bool) -> list[list[int]]:
    a, b, c, d = corner, corner + 1, corner + 1 + row, corner + row
    return [[a, b, c], [a, c, d]] if halved else [[a, b, c, d]]


def _turned(face: list[int], steps: int) -> list[int]:
    steps %= len(face)
    return face[steps:] + face[:steps]


@settings(max_examples=120, deadline=None, derandomize=True)
@given(sheets())
def test_reading_and_writing_loses_nothing(data: dict[str, Any]) -> None:
    given_text = json.dumps(data)
    fold = read(given_text)
    written = write(fold)
    again = read(written)
    assert write(again) == written
    _assert_same(fold, again)
    _assert_given(data, again)
    assert (
        json.loads(written)["faces_vertices"] == data["faces_vertices"]
        or "C" in fold.pattern.letters()
    )
    assert not planarity(again).findings
    spelled_out = write(fold, triangulated=True)
    triangles = read(spelled_out)
    _assert_same(fold, triangles)
    _assert_given(data, triangles)
    assert write(triangles, triangulated=True) == spelled_out


def _assert_same(one: Fold, two: Fold) -> None:
    for name in ("vertices", "edges", "assignments", "fold_angles", "faces", "added", "polygons"):
        assert np.array_equal(getattr(one.pattern, name), getattr(two.pattern, name)), name


def _assert_given(data: dict[str, Any], fold: Fold) -> None:
    """Hold the fold against what was put into the file."""
    kept = fold.meta["fold"]
    letters = "".join(data["edges_assignment"])
    assert fold.pattern.letters()[: len(letters)] == letters.replace("J", "F")
    assert kept["frames"] == data["file_frames"]
    for key in data:
        if ":" in key:
            assert kept["frame"][key] == data[key], key
