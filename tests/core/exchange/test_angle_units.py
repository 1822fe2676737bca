"""A FOLD file whose fold angles are radians is asked about, and read as what it means."""

from __future__ import annotations

import json
from math import pi, radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from foldmill import Fold, UnreadableFile
from foldmill.exchange import write
from foldmill.exchange.fold_options import read
from foldmill.exchange.options import Options
from foldmill_plugins.rotational import DESIGN

SAMPLES = Path(__file__).parents[2] / "samples"
CROSS: dict[str, Any] = {
    "frame_unit": "mm",
    "vertices_coords": [[0, 0], [90, 0], [90, 90], [0, 90], [45, 45]],
    "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
    "edges_assignment": [*"BBBBMVMM"],
    "faces_vertices": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
}
FLAT_RAD = [0, 0, 0, 0, -pi, pi, -pi, -pi]


def fold(angles: list[Any], said: str | None = None, **other: Any) -> Fold:
    text = json.dumps({**CROSS, "edges_foldAngle": angles, **other})
    return read(text.encode(), Options(angles=said))[0]


@pytest.mark.parametrize("decimals", [15, 6, 5, 4, 2])
def test_a_crease_by_pi_is_asked_about_and_then_folds_flat(decimals: int) -> None:
    rounded = [round(angle, decimals) for angle in FLAT_RAD]
    with pytest.raises(UnreadableFile, match=r"go up to 3\.14\d*, which is π.*--angles radians"):
        fold(rounded)
    assert fold(rounded, "radians").pattern.fold_angles[4:].tolist() == [-180, 180, -180, -180]


def test_who_means_degrees_may_say_so() -> None:
    assert fold(FLAT_RAD, "degrees").pattern.fold_angles[5] == pi


def test_half_folded_radians_are_told_and_converted() -> None:
    half = [0, 0, 0, 0, -pi / 2, pi / 2, -pi / 2, -pi / 4]
    found = fold(half)
    assert [each.code for each in found.findings] == ["import-angles"]
    assert "1.57°" in found.findings[0].message
    assert np.allclose(fold(half, "radians").pattern.fold_angles[4:], [-90, 90, -90, -45])
    assert not fold(half, "radians").findings


@pytest.mark.parametrize(
    "angles", [[0, 0, 0, 0, -180, 180, -180, -180], [None] * 8, [0, 0, 0, 0, -3, 3.3, -3, -3]]
)
def test_degrees_are_read_without_a_word(angles: list[Any]) -> None:
    assert not fold(angles).findings


def test_every_frame_and_the_older_spelling_are_converted() -> None:
    step = {"frame_classes": ["foldedForm"], "edges_foldAngles": [0, 0, 0, 0, -1, 1, None, -1]}
    text = json.dumps({**CROSS, "edges_foldAngles": FLAT_RAD, "file_frames": [step]})
    found = read(text.encode(), Options(angles="radians"))[0]
    assert found.pattern.fold_angles[5] == 180
    [kept] = found.meta["fold"]["frames"]
    assert kept["edges_foldAngles"] == pytest.approx(
        [0] * 4 + [-57.29578, 57.29578, None, -57.29578]
    )


def test_a_nearly_flat_file_of_our_own_is_believed() -> None:
    made = DESIGN.run(DESIGN.preset("bowl-n8"))
    shallow = json.loads(write(made))
    shallow["edges_foldAngle"] = [angle / 100 for angle in shallow["edges_foldAngle"]]
    codes = [each.code for each in read(json.dumps(shallow).encode(), Options())[0].findings]
    assert "import-angles" not in codes


@pytest.mark.parametrize("wrong", [10**400, "a", True, [1]])
@pytest.mark.parametrize("said", [None, "radians"])
def test_what_is_no_angle_is_refused_by_its_edge(wrong: object, said: str | None) -> None:
    with pytest.raises(UnreadableFile, match="fold angle of edge 5"):
        fold([0, 0, 0, 0, -1, wrong, -1, -1], said)
    with pytest.raises(UnreadableFile, match="file_frames"):
        fold(FLAT_RAD, said, file_frames=[wrong])


@pytest.mark.parametrize("name", ["fold_diagonal-cp.fold", "ff_pinwheel.fold"])
def test_a_stranger_s_file_in_radians_is_read_as_that_in_degrees(name: str) -> None:
    data = json.loads((SAMPLES / name).read_text())
    wanted = read(json.dumps(data).encode(), Options(width=100))[0].pattern
    angles = data.get("edges_foldAngle", wanted.fold_angles[~np.asarray(wanted.added)].tolist())
    data["edges_foldAngle"] = [None if angle is None else radians(angle) for angle in angles]
    text = json.dumps(data).encode()
    with pytest.raises(UnreadableFile, match="--angles radians"):
        read(text, Options(width=100))
    found = read(text, Options(width=100, angles="radians"))[0].pattern
    assert np.allclose(found.fold_angles, wanted.fold_angles)
