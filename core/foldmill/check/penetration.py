"""Does the folded form pass through itself?

Where every signed radius of a rotationally symmetric form has one sign, the facets of one half
wedge decide for the whole form (the wedge theorem: mirrored and turned copies stay on their own
side of the planes between them). A file or a plugin may claim that of any form, so it is looked at
first (``foldmill.check.symmetry``). Otherwise all pairs of facets are looked at.
"""

from __future__ import annotations

import numpy as np

from foldmill.check.intersection import penetrations
from foldmill.check.report import Report, counted, not_checked
from foldmill.check.symmetry import half_wedge_decides
from foldmill.design import Fold
from foldmill.finding import Finding, Severity
from foldmill.folded import FoldedForm
from foldmill.pattern import CreasePattern, Indices


def penetration(fold: Fold) -> Report:
    """Count the pairs of facets that pass through each other."""
    if fold.folded is None:
        return not_checked("whether the form passes through itself", "penetrations")
    pairs = penetrating_faces(fold, fold.folded)
    figures = {"penetrations": len(pairs)}
    if not len(pairs):
        return Report((), {**figures})
    a, b = (int(face) for face in pairs[0])
    finding = Finding(
        "penetration",
        Severity.ERROR,
        f"faces {a} and {b}, {_place(fold.pattern, a)}",
        f"The folded form passes through itself: {counted(len(pairs), 'pair', 'pairs')} of facets.",
        "Choose other parameters; no sheet can be folded like this.",
    )
    return Report((finding,), {**figures})


def penetrating_faces(fold: Fold, folded: FoldedForm) -> Indices:
    """Return the pairs of faces (k, 2) that penetrate.

    By the half wedge first, where that decides; all pairs are counted once one is found.
    """
    pattern, symmetry = fold.pattern, fold.symmetry
    if symmetry is not None and half_wedge_decides(symmetry, folded.vertices, pattern.faces):
        within = penetrations(folded.vertices, pattern.edges, pattern.faces[symmetry.wedge])
        if not len(within):
            return np.zeros((0, 2), np.intp)
    return penetrations(folded.vertices, pattern.edges, pattern.faces)


def _place(pattern: CreasePattern, face: int) -> str:
    x, y = pattern.vertices[pattern.faces[face]].mean(axis=0)
    return f"the first at ({x:.3f}, {y:.3f}) mm in the pattern"
