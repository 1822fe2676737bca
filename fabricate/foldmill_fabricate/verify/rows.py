"""Perforated creases: rows of cuts with lands between them and at their ends.

A row may be stretched so that it comes out even; so a cut or a land may be up to twice as long as
the preset says, but the land at a vertex is never shorter.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import Perforation
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import NOWHERE, Asked
from foldmill_fabricate.verify.cover import Pieces, pairs, uncovered
from foldmill_fabricate.verify.planned import Planned, at

STRETCH = 2.0
"""How many times longer than the preset says a cut or a land may be."""


def prove_rows(
    asked: Asked, score: Perforation, drawn: Pieces, strokes: Sequence[Planned]
) -> list[Finding]:
    """Check length of cuts, of the lands between them and of those at vertices."""
    found = [
        _error(
            "perforation-cut",
            f"{stroke} at {at(stroke.points[0])}",
            f"It cuts {stroke.length:.2f} mm in one; the preset has cuts of {score.cut:g} mm.",
        )
        for stroke in strokes
        if stroke.length > STRETCH * score.cut + tolerances.UNEVEN_MM
    ]
    return found + _long_lands(asked, score, drawn)


def _error(code: str, where: str, message: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message)


def _long_lands(asked: Asked, score: Perforation, drawn: Pieces) -> list[Finding]:
    """Find stretches of creases that are left whole for longer than any land may be."""
    most = STRETCH * max(score.gap, score.setback)
    wanted = asked.lines(asked.score_face != NOWHERE)
    _, along, _, _ = pairs(drawn, wanted, tolerances.PLAN_MM).along()
    whole = uncovered(wanted, along)
    return [
        _error(
            "missing-score",
            asked.name(int(edge)),
            f"{high - low:.2f} mm of it are not perforated; a land has {most:g} mm at the most.",
        )
        for edge, low, high in zip(whole.line, whole.low, whole.high, strict=True)
        if high - low > most + tolerances.UNEVEN_MM
    ]


def share(score: object) -> float:
    """Return which share of a scored crease strokes run along: 1, or a perforation's cuts."""
    if isinstance(score, Perforation):
        return float(np.divide(score.cut, score.cut + score.gap))
    return 1.0
