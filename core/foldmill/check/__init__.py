"""Is this pattern a sheet, does it fold without stretching, and does it pass through itself?

``check(fold)`` runs every rule of this package over a fold and returns their findings and figures.
A rule never raises for what it finds. What needs the folded form is "not checked" without one.
``flat_foldability``, vertex by vertex, and ``layers``, of the whole sheet, are asked for by
themselves: a form in space need not fold flat.
"""

from __future__ import annotations

from foldmill.check.assignment import assignment
from foldmill.check.developability import developability
from foldmill.check.flat_foldability import flat_foldability
from foldmill.check.isometry import isometry
from foldmill.check.layers import layers
from foldmill.check.penetration import penetration
from foldmill.check.planarity import planarity
from foldmill.check.report import NOT_CHECKED, Figure, Report
from foldmill.design import Fold

RULES = (planarity, developability, isometry, assignment, penetration)
"""Every rule, in the order in which a person would ask."""

__all__ = [
    "NOT_CHECKED",
    "RULES",
    "Figure",
    "Report",
    "assignment",
    "check",
    "developability",
    "flat_foldability",
    "isometry",
    "layers",
    "penetration",
    "planarity",
]


def check(fold: Fold) -> Report:
    """Return what all rules say of a fold, and after them what its own family found.

    Figures that begin with ``designed_`` are what the family said when the fold was made; a file
    brings them along, and nothing here has looked at them.
    """
    said = Report(figures={f"designed_{k}": v for k, v in fold.meta.get("designed", {}).items()})
    return Report.joined([*(rule(fold) for rule in RULES), Report(fold.findings), said])
