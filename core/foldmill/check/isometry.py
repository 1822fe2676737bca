"""Does folding stretch the sheet? Every edge must be as long in space as in the pattern."""

from __future__ import annotations

import numpy as np

from foldmill.check.limits import limits
from foldmill.check.report import Figure, Report, counted, edge_name, not_checked
from foldmill.design import Fold
from foldmill.finding import Finding, Severity
from foldmill.vectors import lengths


def isometry(fold: Fold) -> Report:
    """Compare edge lengths; the figure is the largest difference as a share of the sheet's size."""
    pattern = fold.pattern
    if fold.folded is None:
        return not_checked("whether folding stretches the sheet", "isometry", "isometry_edge")
    if not len(pattern.edges):
        return Report((), {"isometry": 0.0, "isometry_edge": "none"})
    ends = fold.folded.vertices[pattern.edges]
    change = lengths(ends[:, 1] - ends[:, 0]) - pattern.edge_lengths
    share = np.abs(change) / pattern.size
    worst = int(share.argmax())
    limit = limits(fold).isometry
    figures: dict[str, Figure] = {
        "isometry": float(share[worst]),
        "isometry_limit": limit,
        "isometry_edge": worst,
    }
    wrong = int(np.count_nonzero(share > limit))
    if not wrong:
        return Report((), figures)
    finding = Finding(
        "isometry",
        Severity.ERROR,
        edge_name(pattern, worst),
        f"Folding changes the length of {counted(wrong, 'edge', 'edges')}; this one by "
        f"{change[worst]:+.3g} mm.",
        "A sheet does not stretch: the pattern and its folded form do not belong together.",
    )
    return Report((finding,), figures)
