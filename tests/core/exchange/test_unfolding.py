"""A folded form alone is laid flat, and the flat sheet folds into it again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from foldmill import Design, Fold, UnreadableFile
from foldmill.check import check
from foldmill.exchange import fold_options, write
from foldmill.exchange.options import Options
from foldmill_plugins import rotational, tuck

SAMPLES = Path(__file__).parents[2] / "samples"


def read(data: dict[str, Any] | bytes, **said: object) -> Fold:
    content = data if isinstance(data, bytes) else json.dumps(data).encode()
    return fold_options.read(content, Options(**said))[0]  # type: ignore[arg-type]


def notes(fold: Fold) -> str:
    return " ".join(finding.message for finding in fold.findings)


@pytest.mark.parametrize(
    ("name", "area", "counts"),
    [  # mountains, valleys
        ("fold_simple.fold", 4.0, (2, 1)),
        ("fold_diagonal-folded.fold", 1.0, (0, 1)),
        ("fold_box-layers.fold", 64.0, (24, 34)),
    ],
)
def test_every_folded_sample_is_laid_flat_and_proved(
    name: str, area: float, counts: tuple[int, int]
) -> None:
    fold = read((SAMPLES / name).read_bytes(), scale=1.0)
    report = check(fold)
    assert not report.has_errors
    assert report.figures["area_mm2"] == pytest.approx(area, rel=1e-6)
    assert report.figures["isometry"] != "not checked"
    assert (report.figures["mountains"], report.figures["valleys"]) == counts
    assert "laid flat" in notes(fold)


@pytest.mark.parametrize("design", [rotational.DESIGN, tuck.DESIGN])
def test_a_family_s_form_is_laid_into_the_pattern_it_was_folded_from(design: Design[Any]) -> None:
    made = design.run({})
    assert made.folded is not None
    data = json.loads(write(made))
    (frame,) = data.pop("file_frames")
    solid = {**data, **frame, "frame_classes": ["foldedForm"]}
    alone = {k: v for k, v in solid.items() if k not in {"frame_parent", "frame_inherit"}}
    alone = {k: v for k, v in alone.items() if not k.startswith("foldmill:")}
    laid = read(alone)
    was, now = made.pattern, laid.pattern
    assert now.letters() == was.letters()
    assert np.allclose(now.edge_lengths, was.edge_lengths, atol=1e-4)
    far = [np.linalg.norm(p.vertices[:, None] - p.vertices, axis=2) for p in (was, now)]
    assert np.allclose(far[0], far[1], atol=1e-3)  # the same sheet, turned perhaps
    assert np.allclose(now.fold_angles, was.fold_angles, atol=1e-3)


CUBE_CORNER: dict[str, Any] = {
    "frame_classes": ["foldedForm"],
    "frame_unit": "mm",
    "vertices_coords": [[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]],
    "edges_vertices": [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3], [3, 1]],
    "edges_assignment": ["M", "M", "M", "B", "B", "B"],
    "faces_vertices": [[0, 1, 2], [0, 2, 3], [0, 3, 1]],
}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({}, "cannot be laid flat: round vertex"),
        ({"faces_vertices": []}, "lists no faces"),
        (
            {
                "vertices_coords": [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 4]],
                "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0]],
                "edges_assignment": ["B"] * 4,
                "faces_vertices": [[0, 1, 2, 3]],
            },
            "The face 0 is not plane",
        ),
        ({"edges_assignment": ["B"] * 6}, "hangs on no other by a crease"),
        ({"vertices_coords": [[0, 0, 0], [9, 0, 0], [4, 0, 0], [0, 0, 9]]}, "no area"),
    ],
)
def test_what_cannot_be_laid_flat_is_refused(change: dict[str, Any], said: str) -> None:
    with pytest.raises(UnreadableFile, match=said):
        read(CUBE_CORNER | change)


def test_a_form_seen_from_its_back_is_turned_over() -> None:
    corner = {
        "frame_classes": ["foldedForm"],
        "frame_unit": "mm",
        "vertices_coords": [[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]],
        "edges_vertices": [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3]],
        "faces_vertices": [[0, 1, 2], [0, 3, 1]],
    }
    valley = read({**corner, "edges_assignment": ["V", "B", "B", "B", "B"]})
    mountain = read({**corner, "edges_assignment": ["M", "B", "B", "B", "B"]})
    for fold, angle in ((valley, 90), (mountain, -90)):
        assert fold.pattern.fold_angles[0] == pytest.approx(angle)
        assert not check(fold).has_errors
    assert ("turned over" in notes(valley)) != ("turned over" in notes(mountain))


@pytest.mark.parametrize("classes", [["foldedForm"], ["creasePattern"], []])
def test_a_form_that_is_not_folded_yet_is_the_pattern(classes: list[str]) -> None:
    # As Origami Simulator saves a model at 0 %: a foldedForm in space that lies flat.
    said = [*"BBBBMVMU"], [*[None] * 4, -180, 120, -180, None]
    places = [[-0.5, 0, -0.5], [0.5, 0, -0.5], [0.5, 0, 0.5], [-0.5, 0, 0.5], [0.0, 0, 0.1]]
    pairs = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]]
    saved = {
        "file_creator": "Origami Simulator: http://git.io/origami",
        "frame_classes": classes,
        "frame_attributes": ["3D"],
        "frame_unit": "unit",
        "vertices_coords": places,
        "edges_vertices": pairs,
        "edges_assignment": said[0],
        "edges_foldAngle": said[1],
        "faces_vertices": [[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]],
    }
    fold = read(saved, width=100)
    assert fold.folded is None
    assert "is not folded: it is the pattern" in notes(fold)
    assert fold.pattern.letters() == "BBBBMVMU"
    assert fold.pattern.fold_angles.tolist() == [0, 0, 0, 0, -180, 120, -180, 0]
    # Seen from above, where its facets run counter-clockwise, z points downward.
    seen = 100 * np.array(places)[:, [0, 2]] * [1, -1] + 50
    assert np.allclose(fold.pattern.vertices, seen)


def test_a_pattern_is_taken_as_it_is() -> None:
    fold = read((SAMPLES / "fold_diagonal-cp.fold").read_bytes(), scale=1.0)
    assert "laid flat" not in notes(fold)
