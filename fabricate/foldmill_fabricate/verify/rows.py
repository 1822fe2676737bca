"""Perforated creases: rows of cuts with lands between them and at their ends.

A row may be stretched so that it comes out even; so a cut or a land may be up to twice as long as
the preset says, but the land at a vertex is never shorter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import Perforation
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import NOWHERE, Asked
from foldmill_fabricate.verify.cover import Pieces, Stretches, pairs, uncovered
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
    wanted = asked.lines(asked.score_face != NOWHERE)
    _, along, _, _ = pairs(drawn, wanted, tolerances.PLAN_MM).along()
    found += _long_lands(asked, score, wanted, along)
    return found + _short_lands(asked, score, along)


def _error(code: str, where: str, message: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message)


def _long_lands(
    asked: Asked, score: Perforation, wanted: Pieces, along: Stretches
) -> list[Finding]:
    """Find stretches of creases that are left whole for longer than any land may be."""
    most = STRETCH * max(score.gap, score.setback)
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


def _short_lands(asked: Asked, score: Perforation, along: Stretches) -> list[Finding]:
    """Find rows whose first or last cut comes nearer to a vertex than a land is long."""
    begins, ends = asked.lengths.copy(), np.zeros(len(asked.lengths))
    np.minimum.at(begins, along.line, along.low)
    np.maximum.at(ends, along.line, along.high)
    found = []
    for edge in np.unique(along.line).tolist():
        lands = float(begins[edge]), float(asked.lengths[edge] - ends[edge])
        for vertex, land in zip(asked.pattern.edges[edge].tolist(), lands, strict=True):
            if land < score.setback - tolerances.UNEVEN_MM and not _goes_on(asked, edge, vertex):
                text = f"A cut comes within {max(land, 0.0):.2f} mm of the corner at "
                text += f"{at(asked.spots[vertex])}; a land of {score.setback:g} mm belongs there."
                x, y = asked.spots[vertex].tolist()
                found.append(replace(_error("dash-in-corner", asked.name(edge), text), at=(x, y)))
    return found


def _goes_on(asked: Asked, edge: int, vertex: int) -> bool:
    """Tell whether a row may go on straight through a vertex, into another crease."""
    if asked.stops_at[vertex]:
        return False
    node = asked.slits.node[vertex]
    nodes = asked.slits.node[asked.pattern.edges]
    others = np.flatnonzero((asked.score_face != NOWHERE) & (nodes == node).any(axis=1))
    turns = [_course(asked, other, node) for other in others.tolist() if other != edge]
    mine = _course(asked, edge, node)
    opposite = [abs((turn - mine) % 360 - 180) for turn in turns]
    return min(opposite, default=180.0) <= tolerances.NEARLY_STRAIGHT_DEG


def _course(asked: Asked, edge: int, node: int) -> float:
    """Return the direction in which an edge leaves a node, deg."""
    a, b = asked.pattern.edges[edge]
    step = asked.spots[b] - asked.spots[a]
    step = step if asked.slits.node[a] == node else -step
    return float(np.degrees(np.arctan2(step[1], step[0])))


def share(score: object) -> float:
    """Return which share of a scored crease strokes run along: 1, or a perforation's cuts."""
    if isinstance(score, Perforation):
        return float(np.divide(score.cut, score.cut + score.gap))
    return 1.0
