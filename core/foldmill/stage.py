"""A shape on the way to a form, such as the target it was searched from: only to be looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from foldmill.errors import InvalidPattern
from foldmill.pattern import Floats, Indices


@dataclass(frozen=True, eq=False)
class Stage:
    """Triangles in space, in mm and where the form is."""

    name: str
    """For people, such as "target"."""
    vertices: Floats
    """(n, 3) mm."""
    faces: Indices
    """(k, 3) counter-clockwise seen from the front."""
    is_drawn: np.ndarray
    """(k, 3) bool: whether side j of a face, from its corner j to j + 1, is drawn as a line."""

    def __post_init__(self) -> None:
        sound = self.faces.shape == self.is_drawn.shape == (len(self.faces), 3)
        if not (sound and self.vertices.shape[1:] == (3,) and np.isfinite(self.vertices).all()):
            raise InvalidPattern(f"The stage {self.name!r} is no mesh of triangles in space.")
