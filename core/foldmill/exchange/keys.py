"""The keys of a FOLD file: those of our own, those written anew, and those that follow."""

from __future__ import annotations

ADDED = "edges_foldmill:added"
"""True for the edges that only triangulate a polygon, in a file written triangle by triangle."""
POLYGON = "faces_foldmill:polygon"
"""The polygon each triangle is part of, in such a file."""
JOIN = "edges_foldmill:join"
"""True for the edges that came with the letter J, which simulators refuse; they are written F."""
OF = "vertices_foldmill:of"
"""The vertex each vertex repeats; null for one set into the middle of a cut."""
CUT = "edges_foldmill:cut"
"""The ends of the cut an edge stands for, an empty list for its copies, null for other edges."""
DESIGN = "foldmill:design"
"""Which design and parameters it was: slug, version, params."""
DESIGNED = "foldmill:designed"
"""What the family said of the result when it was made: name → number, text or truth value."""
ERRORS = "foldmill:errors"
"""Codes of what is wrong with a form that was written all the same."""
SEAMS = "foldmill:seams"
"""Pairs of vertices that are two in the pattern and one in space."""
SYMMETRY = "foldmill:symmetry"
"""order, wedge (triangles of one half wedge) and one_sided."""

WRITTEN = frozenset(
    {
        *("file_spec", "file_creator", "file_title", "file_frames"),
        *("frame_unit", "frame_parent", "frame_inherit", "vertices_coords", "edges_vertices"),
        *("edges_assignment", "edges_foldAngle", "edges_foldAngles", "faces_vertices"),
        *(ADDED, POLYGON, OF, CUT, SEAMS, SYMMETRY),
    }
)
"""Keys that are written anew from the fold itself."""
DERIVED = frozenset(
    {
        *("vertices_vertices", "vertices_edges", "vertices_faces", "edges_faces", "edges_length"),
        *("edges_lengths", "faces_edges", "faces_faces"),
    }
)
"""Keys that follow from the others. Readers stumble over any that disagree, so none is written."""

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1e3, "um": 1e-3, "nm": 1e-6, "in": 25.4, "pt": 25.4 / 72}
"""mm per unit, by the names of frame_unit."""
