"""A motion as GLB: its base by another library's reader, its animation by the words of glTF 2.0."""

from __future__ import annotations

import io
import json
import struct
from typing import Any

import numpy as np
import pytest
import trimesh

from foldmill import Fold, InvalidParameters
from foldmill.exchange.glb import FRAME_S, MOST_TARGETS, write_motion
from foldmill_plugins.rotational import DESIGN as ROTATIONAL
from foldmill_plugins.six_crease import DESIGN as SIX_CREASE

STEPS = 6
MADE: list[tuple[Any, str]] = [
    (SIX_CREASE, "cup"),
    (SIX_CREASE, "vase-interrupted"),
    (ROTATIONAL, "bowl-n8"),
]
FORMS = pytest.mark.parametrize(("design", "name"), MADE)


class Glb:
    """A reader after glTF 2.0, section 4.4 (the container) and 3.6 (buffers and accessors)."""

    def __init__(self, content: bytes) -> None:
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        chunks, at = [], 12
        while at < length:
            size, kind = struct.unpack_from("<I4s", content, at)
            assert size % 4 == 0
            chunks.append((kind, content[at + 8 : at + 8 + size]))
            at += 8 + size
        assert at == length
        assert [kind for kind, _ in chunks] == [b"JSON", b"BIN\0"]
        self.root = json.loads(chunks[0][1])
        self.binary = chunks[1][1]
        assert len(self.binary) - 3 <= self.root["buffers"][0]["byteLength"] <= len(self.binary)

    def values(self, accessor: int) -> np.ndarray:
        """Read an accessor, and hold its count, its bounds and its alignment against the bytes."""
        said = self.root["accessors"][accessor]
        view = self.root["bufferViews"][said["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3}[said["type"]]
        kind = {5126: "<f4", 5125: "<u4"}[said["componentType"]]
        assert view["byteOffset"] % 4 == 0
        assert view["byteLength"] == 4 * width * said["count"]
        assert view["byteOffset"] + view["byteLength"] <= self.root["buffers"][0]["byteLength"]
        read = np.frombuffer(self.binary, kind, width * said["count"], view["byteOffset"])
        table = read.reshape(-1, width)
        assert said["min"] == table.min(axis=0).tolist()
        assert said["max"] == table.max(axis=0).tolist()
        return table


def written(design: Any, name: str) -> tuple[Fold, bytes]:
    fold = design.run(design.preset(name))
    return fold, write_motion(fold, next(iter(fold.motions.values())), STEPS)


@FORMS
def test_another_reader_finds_the_form_at_t_0_in_metres_with_y_up(design: Any, name: str) -> None:
    fold, content = written(design, name)
    mesh: Any = trimesh.load(io.BytesIO(content), file_type="glb", force="mesh", process=False)
    assert fold.folded is not None
    x, y, z = fold.folded.vertices.T
    assert np.allclose(mesh.vertices * 1000, np.column_stack([x, z, -y]), atol=1e-4)
    assert np.array_equal(mesh.faces, fold.pattern.faces)


@FORMS
def test_each_morph_target_is_a_place_of_the_motion(design: Any, name: str) -> None:
    fold, content = written(design, name)
    glb, motion = Glb(content), next(iter(fold.motions.values()))
    mesh = glb.root["meshes"][0]
    (primitive,) = mesh["primitives"]
    start = glb.values(primitive["attributes"]["POSITION"])
    assert glb.values(primitive["indices"]).max() < len(start)
    assert len(primitive["targets"]) == len(mesh["weights"]) == STEPS
    assert len(mesh["extras"]["targetNames"]) == STEPS
    for k, target in enumerate(primitive["targets"], start=1):
        x, y, z = motion.at(motion.reach * k / STEPS).T
        place = 1000.0 * (start.astype(float) + glb.values(target["POSITION"]))
        assert np.abs(place - np.column_stack([x, z, -y])).max() < 1e-4


@FORMS
def test_the_animation_goes_from_place_to_place_in_seconds(design: Any, name: str) -> None:
    glb = Glb(written(design, name)[1])
    (animation,) = glb.root["animations"]
    (channel,), (sampler,) = animation["channels"], animation["samplers"]
    assert channel["target"]["path"] == "weights"
    assert glb.root["nodes"][channel["target"]["node"]]["mesh"] == 0
    times = glb.values(sampler["input"])[:, 0]
    assert times[0] == 0
    assert np.diff(times) == pytest.approx(np.full(STEPS, FRAME_S))
    weights = glb.values(sampler["output"]).reshape(len(times), STEPS)
    assert np.array_equal(weights[1:], np.eye(STEPS))
    assert not weights[0].any()
    assert sampler["interpolation"] == "LINEAR"


def test_what_is_animated_is_not_offered_as_vertices_to_the_graphics_card() -> None:
    """glTF 2.0, 3.11: a view with a target holds vertices or indices, and each view one kind."""
    glb = Glb(written(*MADE[0])[1])
    targets = [view.get("target") for view in glb.root["bufferViews"]]
    assert targets == [34962, 34963, *[34962] * STEPS, None, None]
    assert sum(v["byteLength"] for v in glb.root["bufferViews"]) <= len(glb.binary)


def test_the_same_motion_gives_the_same_bytes() -> None:
    assert written(*MADE[0])[1] == written(*MADE[0])[1]


def test_more_steps_than_viewers_hold_are_refused() -> None:
    fold = SIX_CREASE.run()
    with pytest.raises(InvalidParameters, match=r"A GLB takes 250 steps at most, .* not 251"):
        write_motion(fold, fold.motions["along-arc"], MOST_TARGETS + 1)
