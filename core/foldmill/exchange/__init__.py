"""Files that others read and write: FOLD 1.2 in and out, meshes of the folded form out.

``read`` and ``write`` turn text into a Fold and back and lose nothing on the way: unknown keys,
other frames and unknown per-element arrays are kept in ``Fold.meta["fold"]``. ``write_mesh`` gives
the bytes of an OBJ, STL or GLB file, ``write_motion`` those of an animated GLB. None of them
touches the disk.
"""

from __future__ import annotations

from foldmill.exchange.fold import read, write
from foldmill.exchange.glb import write_motion
from foldmill.exchange.mesh import MESH_SUFFIXES, write_mesh

__all__ = ["MESH_SUFFIXES", "read", "write", "write_mesh", "write_motion"]
