"""Can the layers of a sheet that is folded flat be put in an order, so that none passes another?

Kawasaki's and Maekawa's theorems look at one vertex; this looks at the whole sheet. For every two
facets that lie upon each other one is above. Bern and Hayes (1996) show that finding an order is
hard in general; the conditions are those of Justin (1997), as programs for flat folding state them:

* a crease holds its two facets together, the one a valley turns up lies above;
* a facet that lies across a crease is not between the two facets of it;
* of two creases along each other the facets do not interleave;
* facets at one place are in one order.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import permutations

import numpy as np

from foldmill.check.flat_state import (
    FlatState,
    flat_state,
    overlapping,
    stacked,
    through,
    upon,
)
from foldmill.check.ordering import Rule, Search, Verdict
from foldmill.check.report import Figure, Report, edge_name
from foldmill.design import Fold
from foldmill.finding import Finding, Severity
from foldmill.pattern import Assignment, CreasePattern
from foldmill.tolerances import CLOSED_DEG

MOST_FACETS = 120
"""Facets up to which an order of layers is searched; it takes seconds there, and then grows by the
cube of their number."""
_CLOSES = 1e-3
"""Share of the size by which a sheet that folds flat may fail to close: files are rounded."""


def layers(fold: Fold) -> Report:
    """Say whether a sheet whose creases all fold by 180° can be folded flat as a whole."""
    pattern = fold.pattern
    reason = _not_asked(pattern)
    if reason:
        finding = Finding("layers-not-checked", Severity.INFO, "", f"Layers not checked: {reason}.")
        return Report((finding,), {"layer_order": "not checked"})
    state = flat_state(pattern)
    figures: dict[str, Figure] = {"flat_facets": len(state.facets), "flat_gap_mm": state.error}
    if state.error > _CLOSES * pattern.size:
        message = f"Folded flat, the sheet fails to close by {state.error:.4g} mm."
        remedy = "Look at the vertices where Kawasaki's theorem does not hold."
        finding = Finding("flat-open", Severity.ERROR, "", message, remedy)
        return Report((finding,), figures | {"layer_order": "none"})
    found = _search(state).run()
    figures["layer_order"] = {
        Verdict.FOUND: "found",
        Verdict.NONE: "none",
        Verdict.OPEN: "not checked",
    }[found.verdict]
    return Report(tuple(_findings(pattern, state, found.verdict, found.blamed)), figures)


def _not_asked(pattern: CreasePattern) -> str:
    """Return why a sheet is not asked for its layers; nothing where it is."""
    codes, angles = pattern.assignments, np.abs(pattern.fold_angles)
    crease = np.isin(codes, [Assignment.M, Assignment.V])
    if (codes == Assignment.U).any():
        return "some creases are neither mountain nor valley"
    if not crease.any():
        return "there are no creases"
    if (angles[crease] < 180 - CLOSED_DEG).any():
        return "some creases fold only partly"
    count = len(pattern.faces) - int((codes == Assignment.F).sum())
    return f"there are more than {MOST_FACETS} facets" if count > MOST_FACETS else ""


def _search(state: FlatState) -> Search:
    pairs = overlapping(state)
    number = {pair: k for k, pair in enumerate(pairs)}
    rules: list[Rule] = []
    for k, crease in enumerate(state.creases):
        upper = crease.is_valley != state.is_turned[crease.left]
        rules += _rules(number, (crease.left, crease.right), [(1, 0) if upper else (0, 1)], k)
    for k, facet in through(state):
        crease = state.creases[k]
        three = (crease.left, crease.right, facet)
        rules += _rules(number, three, [o for o in permutations(range(3)) if o[1] != 2], k)
    for one, two in upon(state):
        first, second = state.creases[one], state.creases[two]
        four = (first.left, first.right, second.left, second.right)
        if len(set(four)) == 4:
            orders = [o for o in permutations(range(4)) if not _interleave(o)]
            rules += _rules(number, four, orders, one)
    for three in stacked(state, pairs):
        rules += _rules(number, three, permutations(range(3)), -1)
    return Search(len(pairs), rules)


def _interleave(order: Sequence[int]) -> bool:
    """Tell whether the pairs (0, 1) and (2, 3) alternate in an order from top to bottom."""
    first = [place in {0, 1} for place in order]
    return first in ([True, False, True, False], [False, True, False, True])


def _rules(
    number: dict[tuple[int, int], int],
    facets: Sequence[int],
    orders: Iterable[Sequence[int]],
    blamed: int,
) -> list[Rule]:
    """Return the rule that some facets lie in one of some orders, each from top to bottom.

    blamed : the crease to name where it cannot be kept. Facets that do not overlap have no order,
    so the rule is only about the pairs that do.
    """
    names = [
        (i, j)
        for i in range(len(facets))
        for j in range(i + 1, len(facets))
        if tuple(sorted((facets[i], facets[j]))) in number
    ]
    if not names:
        return []
    variables = [number[min(facets[i], facets[j]), max(facets[i], facets[j])] for i, j in names]
    allowed = set()
    for order in orders:
        place = {facet: k for k, facet in enumerate(order)}
        allowed.add(tuple((place[i] < place[j]) == (facets[i] < facets[j]) for i, j in names))
    return [Rule(tuple(variables), frozenset(allowed), blamed)]


def _findings(
    pattern: CreasePattern, state: FlatState, verdict: Verdict, blamed: int
) -> Iterable[Finding]:
    if verdict is Verdict.OPEN:
        message = "Whether the layers can be put in order was not settled; the search was too long."
        yield Finding("layers-not-checked", Severity.INFO, "", message)
    if verdict is Verdict.NONE:
        edge = state.creases[max(blamed, 0)].edge
        a, b = pattern.vertices[pattern.edges[edge]]
        middle = (float((a[0] + b[0]) / 2), float((a[1] + b[1]) / 2))
        yield Finding(
            "layer-order",
            Severity.ERROR,
            edge_name(pattern, edge),
            "The sheet cannot be folded flat: its layers would have to pass through each other, "
            "whatever their order; here an order breaks.",
            "Turn some mountains into valleys, or some valleys into mountains.",
            at=middle,
        )
