"""A motion as GLB: the form at t = 0 as a mesh, its other places as morph targets, one animation.

Metres, y up, as glTF 2.0 wants it. trimesh writes meshes but no morph targets, and the container is
two chunks, JSON and binary (glTF 2.0, section 4), so both are laid out here.
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill.design import Fold
from foldmill.errors import InvalidParameters
from foldmill.exchange.marking import warning
from foldmill.exchange.mesh import y_up
from foldmill.motion import Motion

FRAME_S = 0.06
"""Seconds from one place to the next."""
MOST_TARGETS = 250
"""Morph targets that viewers are still asked to hold; a browser's shader mixes textures of them."""

_FLOAT, _UINT = 5126, 5125
_VERTICES, _INDICES = 34962, 34963


def write_motion(fold: Fold, motion: Motion, steps: int) -> bytes:
    """Return the motion through ``steps`` + 1 even places as the bytes of a .glb file.

    Raises InvalidParameters for more steps than viewers hold morph targets.
    """
    if steps > MOST_TARGETS:
        raise InvalidParameters(
            f"A GLB takes {MOST_TARGETS} steps at most, one morph target each, not {steps}; take "
            "fewer steps."
        )
    frames = [y_up(vertices) for vertices in motion.frames(steps)]
    start, buffers = frames[0], _Buffers()
    corners = fold.pattern.faces.reshape(-1, 1).astype("<u4")
    # No normals: a viewer must then shade every facet flat.
    primitive: dict[str, Any] = {
        "attributes": {"POSITION": buffers.add(start, "VEC3", _VERTICES)},
        "indices": buffers.add(corners, "SCALAR", _INDICES),
        "material": 0,
        "targets": [
            {"POSITION": buffers.add(place - start, "VEC3", _VERTICES)} for place in frames[1:]
        ],
    }
    times = buffers.add((FRAME_S * np.arange(steps + 1))[:, None], "SCALAR")
    weights = buffers.add(np.eye(steps + 1)[:, 1:].reshape(-1, 1), "SCALAR")
    document = _document(motion, primitive, (times, weights), buffers)
    if warning(fold):
        document["asset"]["extras"] = {"warning": warning(fold)}
    return _container(document, bytes(buffers.bytes))


class _Buffers:
    """One binary chunk, and the accessors into it."""

    def __init__(self) -> None:
        self.bytes = bytearray()
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, values: ArrayLike, kind: str, target: int = 0) -> int:
        """Add (n, k) numbers, all of four bytes and so aligned; return the accessor's number."""
        given = np.asarray(values)
        is_index = given.dtype.kind == "u"
        array: NDArray[Any] = given.astype("<u4" if is_index else "<f4") + 0
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": array.nbytes}
        self.views.append(view | ({"target": target} if target else {}))
        self.bytes += array.tobytes()
        accessor = {
            "bufferView": len(self.views) - 1,
            "componentType": _UINT if is_index else _FLOAT,
            "count": len(array),
            "type": kind,
            "min": array.min(axis=0).tolist(),
            "max": array.max(axis=0).tolist(),
        }
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _document(
    motion: Motion, primitive: dict[str, Any], played: tuple[int, int], buffers: _Buffers
) -> dict[str, Any]:
    times, weights = played
    count = len(primitive["targets"])
    names = [f"t={motion.reach * k / count:.6g}" for k in range(1, count + 1)]
    mesh = {
        "primitives": [primitive],
        "weights": [0.0] * count,
        "extras": {"targetNames": names},
    }
    sampler = {"input": times, "output": weights, "interpolation": "LINEAR"}
    channel = {"sampler": 0, "target": {"node": 0, "path": "weights"}}
    return {
        "asset": {"version": "2.0", "generator": "foldmill"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": motion.title}],
        "meshes": [mesh],
        # A sheet has no inside: viewers must not leave out what is seen from behind.
        "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0.0}}],
        "animations": [{"name": motion.name, "channels": [channel], "samplers": [sampler]}],
        "accessors": buffers.accessors,
        "bufferViews": buffers.views,
        "buffers": [{"byteLength": len(buffers.bytes)}],
    }


def _container(document: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
    chunks = [
        (b"JSON", text + b" " * (-len(text) % 4)),
        (b"BIN\0", binary + b"\0" * (-len(binary) % 4)),
    ]
    body = b"".join(struct.pack("<I", len(data)) + kind + data for kind, data in chunks)
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body
