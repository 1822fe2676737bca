"""The folded form as a triangle mesh: OBJ and STL in millimetres, GLB in metres with y up."""

from __future__ import annotations

from typing import Any

import numpy as np

from foldmill.design import Fold
from foldmill.errors import InvalidInput, UnknownName
from foldmill.pattern import Floats

MESH_SUFFIXES = (".glb", ".obj", ".stl")
"""The suffixes that ``write_mesh`` knows."""

_METRES = 1e-3


def write_mesh(fold: Fold, suffix: str) -> bytes:
    """Return the folded form as the bytes of an .obj, .stl or .glb file.

    Raises UnknownName for another suffix and InvalidInput where the fold has no folded form.
    """
    if suffix not in MESH_SUFFIXES:
        raise UnknownName.of("mesh format", suffix, MESH_SUFFIXES)
    if fold.folded is None:
        raise InvalidInput(
            "There is no folded form to write as a mesh: this fold is a pattern only. Start from a "
            "design, or from a FOLD file with a foldedForm frame."
        )
    vertices = fold.folded.vertices + 0.0
    if suffix == ".glb":
        mesh = _mesh(y_up(vertices), fold)
        mesh.visual = _both_faces_visible()
        return bytes(mesh.export(file_type="glb"))
    if suffix == ".stl":
        return bytes(_mesh(vertices, fold).export(file_type="stl"))
    header = "foldmill: millimetres, z up"
    text: str = _mesh(vertices, fold).export(file_type="obj", header=header)
    return (text.rstrip("\n") + "\n").encode()


def y_up(vertices: Floats) -> Floats:
    """Turn (x, y, z up) in mm into glTF's (x, y up, z towards the viewer) in metres."""
    x, y, z = vertices.T
    return np.column_stack([x, z, -y]) * _METRES + 0.0


def _mesh(vertices: Floats, fold: Fold) -> Any:
    import trimesh

    return trimesh.Trimesh(vertices, fold.pattern.faces, process=False)


def _both_faces_visible() -> Any:
    """A sheet has no inside: viewers must not leave out what is seen from behind."""
    import trimesh

    visual: Any = trimesh.visual
    return visual.TextureVisuals(material=visual.material.PBRMaterial(doubleSided=True))
