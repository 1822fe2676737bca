"""The folded form as a triangle mesh: OBJ and STL in millimetres, GLB in metres with y up."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from foldmill.design import Fold
from foldmill.errors import InvalidInput, UnknownName
from foldmill.exchange.marking import warning
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
        said = {"extras": {"warning": warning(fold)}} if warning(fold) else {}
        return bytes(mesh.export(file_type="glb", tree_postprocessor=_telling(said)))
    if suffix == ".stl":
        stl = bytes(_mesh(vertices, fold).export(file_type="stl"))
        return _stl_header(fold) + stl[80:]
    header = "\n".join(["foldmill: millimetres, z up", *filter(None, [warning(fold)])])
    text: str = _mesh(vertices, fold).export(file_type="obj", header=header)
    return (text.rstrip("\n") + "\n").encode()


def y_up(vertices: Floats) -> Floats:
    """Turn (x, y, z up) in mm into glTF's (x, y up, z towards the viewer) in metres."""
    x, y, z = vertices.T
    return np.column_stack([x, z, -y]) * _METRES + 0.0


def _telling(said: dict[str, Any]) -> Callable[[dict[str, Any]], None]:
    """Return what adds words to the asset of a glTF document."""

    def tell(tree: dict[str, Any]) -> None:
        tree["asset"].update(said)

    return tell


def _stl_header(fold: Fold) -> bytes:
    """Return the 80 bytes before a binary STL's triangles; they must not begin with "solid"."""
    return warning(fold).encode("ascii", "replace")[:80].ljust(80, b"\0")


def _mesh(vertices: Floats, fold: Fold) -> Any:
    import trimesh

    return trimesh.Trimesh(vertices, fold.pattern.faces, process=False)


def _both_faces_visible() -> Any:
    """A sheet has no inside: viewers must not leave out what is seen from behind."""
    import trimesh

    visual: Any = trimesh.visual
    return visual.TextureVisuals(material=visual.material.PBRMaterial(doubleSided=True))
