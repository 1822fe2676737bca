"""A target as a triangle mesh from a file: a disk, laid over a square and made smooth."""

from __future__ import annotations

import re
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry
from foldmill_plugins.waterbomb.disk import Disk
from foldmill_plugins.waterbomb.named_file import NamedFile
from foldmill_plugins.waterbomb.obj_faults import first_fault
from foldmill_plugins.waterbomb.patch import patch
from foldmill_plugins.waterbomb.sound import sound
from foldmill_plugins.waterbomb.surfaces import Surface

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SUFFIXES = (".stl", ".obj", ".ply", ".off")
NODES = (9, 41)
"""Fewest and most nodes of the smooth surface along each side."""
MOST_FACES = 200_000
HEAD = 10_000
"""Bytes within which a mesh file says how much it holds."""
ASTRAY = 0.03
"""Share of the mesh's diagonal by which the smooth surface may miss one of its vertices."""


class MeshSurface(NamedFile):
    """A triangle mesh that is a disk: one piece, one border, no handle."""

    kind: Literal["mesh"] = "mesh"
    """A triangle mesh (.stl .obj .ply .off) in one piece with one border and no handle; its
    sharpest four corners become those of u and v."""

    def surface(self) -> Surface:
        """Return the surface; raises ImpossibleGeometry for a mesh that is no disk."""
        return _surface(self)


@lru_cache(maxsize=8)
def _surface(params: MeshSurface) -> Surface:
    disk = Disk.of(*_loaded(params))
    uv = disk.over_square()
    count = int(np.clip(round(np.sqrt(len(disk.points))), *NODES))
    nodes = np.linspace(-1, 1, count)
    jet = patch(nodes, nodes, sampled(uv, disk.faces, disk.points, nodes))
    missed = np.linalg.norm(jet(*uv[np.unique(disk.faces)].T).p - disk.points, axis=1)
    size = float(np.linalg.norm(np.ptp(disk.points, axis=0)))
    if missed.max() > ASTRAY * size:
        x, y, z = disk.points[missed.argmax()]
        raise ImpossibleGeometry(
            f"{params.file}: at ({x:.4g}, {y:.4g}, {z:.4g}) the smooth surface through the mesh is "
            f"{100 * missed.max() / size:.3g} % of its diagonal away from it, more than "
            f"{100 * ASTRAY:g} %. Make its triangles smaller and more even, or the target rounder."
        )
    return sound(Surface("surface", jet, (-1.0, 1.0), (-1.0, 1.0)))


def sampled(uv: Floats, faces: Indices, points: Floats, nodes: Floats) -> Floats:
    """Return the mesh's places (n, n, 3) at a grid of u and v, linear over each triangle."""
    step, corners = float(nodes[1] - nodes[0]), uv[faces]
    low = np.ceil((corners.min(axis=1) - nodes[0]) / step - 1e-9).astype(int)
    high = np.floor((corners.max(axis=1) - nodes[0]) / step + 1e-9).astype(int)
    best = np.full((len(nodes), len(nodes)), -np.inf)
    out = np.zeros((len(nodes), len(nodes), 3))
    for face in np.flatnonzero((low <= high).all(axis=1)):
        (a, b), (c, d) = low[face], high[face] + 1
        share = _shares(corners[face], nodes[a:c, None], nodes[None, b:d])
        least = share.min(axis=0)
        wins = least > best[a:c, b:d]
        best[a:c, b:d][wins] = least[wins]
        out[a:c, b:d][wins] = np.moveaxis(share, 0, -1)[wins] @ points[faces[face]]
    return out


def _shares(corners: Floats, u: Floats, v: Floats) -> Floats:
    """Return the barycentric coordinates (3, a, b) of places u (a, 1), v (1, b) in a triangle."""
    one, two = corners[1] - corners[0], corners[2] - corners[0]
    area = one[0] * two[1] - one[1] * two[0]
    du, dv = u - corners[0, 0], v - corners[0, 1]
    second = (du * two[1] - dv * two[0]) / area
    third = (one[0] * dv - one[1] * du) / area
    return np.stack([1 - second - third, second, third])


def _loaded(params: MeshSurface) -> tuple[Floats, Indices]:
    """Return the vertices and triangles of the file, welded; raises ImpossibleGeometry."""
    suffix = Path(params.file).suffix.lower()
    if suffix not in SUFFIXES:
        raise ImpossibleGeometry(
            f"{params.file}: a mesh is read from {' '.join(SUFFIXES)}, not "
            f"{suffix or 'a file without a suffix'}."
        )
    content = params.content()
    _require_few(params.file, promised(content, suffix))
    try:
        points, faces = _welded(content, suffix[1:])
    except Exception as error:  # a broken file breaks its reader in whatever way it likes
        told = " ".join(str(error).split())[:200] or type(error).__name__
        raise ImpossibleGeometry(_broken(params.file, content, suffix, told)) from None
    if not np.isfinite(points).all() or not len(faces) or not np.ptp(points, axis=0).max() > 0:
        told = "it holds no triangles, or all its corners in one place"
        raise ImpossibleGeometry(_broken(params.file, content, suffix, told))
    _require_few(params.file, len(faces))
    return points, faces


def _broken(file: str, content: bytes, suffix: str, told: str) -> str:
    """Say what is wrong with a file of which its reader says ``told``."""
    fault = first_fault(content) if suffix == ".obj" else ""
    return (
        f"{file} is no {suffix} file with one triangle mesh: {fault or told}. Save the mesh again "
        "as triangles, from the program it was made with."
    )


def _require_few(file: str, count: int) -> None:
    if count > MOST_FACES:
        raise ImpossibleGeometry(
            f"{file} has {count} triangles or more; take at most {MOST_FACES}."
        )


def promised(content: bytes, suffix: str) -> int:
    """Return how many triangles a mesh file holds at least, or says that it holds, unread.

    Three corners that no other triangle has count as one; ten spaces of an .obj file do, since a
    polygon may have any number of corners.
    """
    if suffix == ".obj":
        return max(content.count(b"\nf"), content.count(b" ") // 10)
    if suffix == ".stl":
        is_text = b"\0" not in content
        return content.count(b"endfacet") if is_text else (len(content) - 84) // 50
    head = content[:HEAD]
    if suffix == ".ply":
        named = dict(re.findall(rb"element (\S+) +(\d{1,18})", head))
        corners, faces = named.pop(b"vertex", b"0"), max(map(int, named.values()), default=0)
    else:
        corners, faces = ([int(word) for word in re.findall(rb"\d{1,18}", head)] + [0, 0])[:2]
    return max(int(corners) // 3, faces)


def _welded(content: bytes, kind: str) -> tuple[Floats, Indices]:
    import trimesh

    repair: Any = trimesh.repair
    mesh = trimesh.load_mesh(BytesIO(content), file_type=kind, process=False)
    _require_finite(np.asarray(mesh.vertices))  # merging would drop the triangles at such corners
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    mesh.update_faces(mesh.nondegenerate_faces() & mesh.unique_faces())
    repair.fix_winding(mesh)
    mesh.remove_unreferenced_vertices()
    return np.array(mesh.vertices, np.float64), np.array(mesh.faces, np.intp)


def _require_finite(points: Floats) -> None:
    lost = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(lost):
        raise ValueError(f"corner {lost[0] + 1} is at no finite place (and {len(lost) - 1} more)")
