"""The folded stool as a mesh, measured by another library's reader."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
import trimesh

from foldmill import Fold, InvalidInput, UnknownName
from foldmill.exchange import MESH_SUFFIXES, write_mesh
from foldmill_plugins.tuck import DESIGN


@pytest.fixture(scope="module")
def stool() -> Fold:
    return DESIGN.run(DESIGN.preset("stool-n8"))


def load(content: bytes, suffix: str) -> Any:
    return trimesh.load(io.BytesIO(content), file_type=suffix[1:], force="mesh", process=False)


@pytest.mark.parametrize("suffix", [".obj", ".stl"])
def test_the_stool_measures_220_by_220_by_150_millimetres(stool: Fold, suffix: str) -> None:
    mesh = load(write_mesh(stool, suffix), suffix)
    assert np.allclose(mesh.extents, [220, 220, 150], atol=0.1)
    assert len(mesh.faces) == 112


def test_in_glb_the_stool_stands_upright_in_metres_with_y_up(stool: Fold) -> None:
    mesh = load(write_mesh(stool, ".glb"), ".glb")
    assert np.allclose(mesh.extents, [0.22, 0.15, 0.22], atol=1e-4)
    assert stool.folded is not None
    x, y, z = stool.folded.vertices.T
    assert np.allclose(mesh.vertices * 1000, np.column_stack([x, z, -y]), atol=1e-4)


@pytest.mark.parametrize("suffix", MESH_SUFFIXES)
def test_a_mesh_keeps_its_handedness(stool: Fold, suffix: str) -> None:
    assert stool.folded is not None
    mesh = load(write_mesh(stool, suffix), suffix)
    scale = 1e-9 if suffix == ".glb" else 1.0
    corners = stool.folded.vertices[stool.pattern.faces]
    volume = float(np.linalg.det(corners).sum()) / 6
    assert float(np.linalg.det(mesh.triangles).sum()) / 6 == pytest.approx(volume * scale, rel=1e-4)


@pytest.mark.parametrize("suffix", MESH_SUFFIXES)
def test_the_same_fold_gives_the_same_bytes(stool: Fold, suffix: str) -> None:
    again = DESIGN.run(DESIGN.preset("stool-n8"))
    assert write_mesh(stool, suffix) == write_mesh(again, suffix)


def test_a_pattern_alone_has_no_mesh(stool: Fold) -> None:
    with pytest.raises(InvalidInput, match="no folded form to write as a mesh"):
        write_mesh(Fold(stool.pattern), ".stl")


def test_another_suffix_is_told_which_there_are(stool: Fold) -> None:
    with pytest.raises(UnknownName, match=r"There are: \.glb, \.obj, \.stl"):
        write_mesh(stool, ".3ds")
