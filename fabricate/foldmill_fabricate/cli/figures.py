"""Figures of a fold that a person asks for first."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from foldmill import Fold


def summary(fold: Fold) -> dict[str, object]:
    """Return figures of a fold that a person asks for first."""
    import numpy as np

    from foldmill import Assignment

    pattern = fold.pattern
    width, height = np.ptp(pattern.vertices, axis=0)
    rare = {"unassigned": Assignment.U, "inner_cuts": Assignment.C}
    found: dict[str, object] = {
        "vertices": len(pattern.vertices),
        "faces": len(pattern.faces),
        "mountains": pattern.count(Assignment.M),
        "valleys": pattern.count(Assignment.V),
        "flats": pattern.count(Assignment.F),
        **{name: pattern.count(each) for name, each in rare.items() if pattern.count(each)},
        "pattern_mm": f"{width:.1f} × {height:.1f}",
    }
    if fold.folded is not None:
        found["folded_mm"] = " × ".join(f"{s:.1f}" for s in np.ptp(fold.folded.vertices, axis=0))
    return found
