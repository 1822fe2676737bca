"""FOLD files of several frames and versions: the one asked for, at the size that is said."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from foldmill import UnreadableFile
from foldmill.exchange.options import Options
from foldmill_fabricate.importing import Imported, read_pattern

SQUARE: dict[str, Any] = {
    "file_spec": 1,
    "file_creator": "somebody",
    "frame_classes": ["creasePattern"],
    "frame_unit": "mm",
    "vertices_coords": [[0, 0], [10, 0], [10, 10], [0, 10]],
    "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
    "edges_assignment": ["B", "B", "B", "B", "V"],
    "edges_foldAngles": [0, 0, 0, 0, 90],
    "faces_vertices": [[0, 1, 2], [0, 2, 3]],
    "edges_other:key": ["a", "b", "c", "d", "e"],
}
TALLER = {
    "frame_parent": 0,
    "frame_inherit": True,
    "vertices_coords": [[0, 0], [10, 0], [10, 30], [0, 30]],
}
STEP = {
    "frame_classes": ["foldedForm"],
    "frame_parent": 0,
    "frame_inherit": True,
    "vertices_coords": [[0, 0, 0], [10, 0, 0], [10, 10, 0], [5, 5, 50**0.5]],
}


def read(data: dict[str, Any], **said: object) -> Imported:
    content = json.dumps(data).encode()
    return read_pattern(content, Options(**said), name="x.fold")  # type: ignore[arg-type]


def size(found: Imported) -> list[float]:
    return np.ptp(found.fold.pattern.vertices, axis=0).tolist()  # type: ignore[no-any-return]


def test_of_several_patterns_the_first_is_taken_and_the_others_are_told() -> None:
    data = SQUARE | {"file_frames": [TALLER]}
    found = read(data)
    assert size(found) == [10, 10]
    (finding,) = [each for each in found.fold.findings if each.code == "import-frame"]
    assert "patterns (0, 1); frame 0 was taken" in finding.message
    assert "--frame" in finding.remedy
    assert size(read(data, frame=1)) == [10, 30]
    with pytest.raises(UnreadableFile, match="no vertices in a frame 5; those with any: 0, 1"):
        read(data, frame=5)


def test_a_folded_form_scales_with_its_pattern() -> None:
    found = read(SQUARE | {"file_frames": [STEP]}, width=50.0)
    assert size(found) == [50, 50]
    assert found.fold.folded is not None
    assert np.allclose(found.fold.folded.vertices[3], [25, 25, 5 * 50**0.5])


def test_a_frame_that_is_folded_is_laid_flat_where_it_is_asked_for() -> None:
    found = read(SQUARE | {"file_frames": [STEP]}, frame=1)
    assert np.allclose(sorted(size(found)), [10, 10])
    assert found.fold.pattern.fold_angles.max() == pytest.approx(90)


def test_version_1_0_is_read_and_foreign_arrays_survive() -> None:
    fold = read(SQUARE, scale=2.0).fold
    assert fold.pattern.fold_angles.max() == 90  # by its old key edges_foldAngles
    assert fold.meta["fold"]["frame"]["edges_other:key"] == ["a", "b", "c", "d", "e"]


@pytest.mark.parametrize(
    ("unit", "said", "wide"),
    [
        ("cm", {}, 100),
        ("cm", {"scale": 0.5}, 50),
        ("cm", {"unit": "mm"}, 10),
        ("cm", {"width": 42.0}, 42),
        ("unit", {"unit": "in"}, 254),
    ],
)
def test_what_is_said_of_the_size_goes_before_what_is_written(
    unit: str, said: dict[str, object], wide: float
) -> None:
    found = read(SQUARE | {"frame_unit": unit}, **said)
    assert size(found) == pytest.approx([wide, wide])
    assert found.questions == ()


def test_a_file_in_units_of_nothing_is_asked_how_large_it_is() -> None:
    assert [q.option for q in read(SQUARE | {"frame_unit": "unit"}).questions] == ["--width"]


def test_every_assignment_is_read() -> None:
    strip = {
        **SQUARE,
        "vertices_coords": [[x, y] for y in (0, 10) for x in range(0, 70, 10)],
        "edges_vertices": [
            *([k, k + 1] for k in range(6)),
            *([k + 7, k + 8] for k in range(6)),
            *([k, k + 7] for k in range(7)),
        ],
        "edges_assignment": [*"B" * 12, *"BMVFUJB"],
        "faces_vertices": [[k, k + 1, k + 8, k + 7] for k in range(6)],
    }
    del strip["edges_foldAngles"], strip["edges_other:key"]
    pattern = read(strip).fold.pattern
    own = ~np.asarray(pattern.added)
    letters = [letter for letter, kept in zip(pattern.letters(), own, strict=True) if kept]
    assert "".join(letters[12:]) == "BMVFUFB"
