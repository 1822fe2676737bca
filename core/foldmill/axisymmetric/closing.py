"""Does a form fold flat when its planes close on each other? The report ``flat-foldability``.

First the limit rule at every inner vertex, once for all its copies: the centre and the vertices on
the cut line are left out, as the sheet is open there. It is necessary and not sufficient; so the
way there is looked at as well, from Θ' = 180°/N down to a thousandth of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import planar
from foldmill.axisymmetric import flattened
from foldmill.axisymmetric.rosette import Rosette, Seat
from foldmill.check.flat_foldability import FlatVertex, flat_vertex
from foldmill.check.intersection import penetrations
from foldmill.tolerances import ON_LINE

Floats = NDArray[np.float64]

STEPS = 100
"""Places looked at on the way: one percent of the folding rate apart."""
LAST = 0.999
"""Share of the way at which the last look is taken: at its very end everything is in one plane."""
PASSES, FAILS, UNDECIDED = "passes", "fails", "undecided"
FLAT, NOT_FLAT = "folds flat", "does not fold flat"


@dataclass(frozen=True, eq=False)
class Closing:
    """A form whose planes can close on each other while every branch stays."""

    whole: Rosette
    """The form at Θ' = Θ, without tabs."""
    branches: Mapping[int, int]
    """b by the number of the point in the half wedge, for every point that has one."""
    places: Callable[[Floats], Floats]
    """Θ' (K,) in rad → the half wedge's points (K, m, 2) as (r, z), mm; NaN from the first point
    without one place on."""
    first: int
    """The number that people give the half wedge's first point: 0 or 1."""
    front: int
    """+1 where the front of the sheet is its upper side, -1 where it was turned over."""


def report(closing: Closing) -> dict[str, Any]:
    """Return verdict, reason, what each of both looks says, and a row for every inner point."""
    meridian = closing.places(np.zeros(1))[0]
    rows = list(_rows(closing, meridian))
    rule, why = _by_rule(rows)
    stop = _first_fault(closing)
    way = stop or f"No facet passes through another at the {STEPS + 1} places looked at on the way."
    return {
        "verdict": NOT_FLAT if stop or rule == FAILS else UNDECIDED if rule == UNDECIDED else FLAT,
        "why": f"{why} {way}",
        "limit_rule": rule,
        "way_is_free": not stop,
        "looked_at": STEPS + 1,
        "points": rows,
    }


def _rows(closing: Closing, meridian: Floats) -> Iterator[dict[str, Any]]:
    whole = closing.whole
    folded = flattened.ends_folded(whole, closing.branches)
    signs = closing.front * flattened.folded_signs(whole, meridian)
    inner = ~np.isin(np.arange(len(whole.origin)), whole.edges[(whole.edge_faces < 0).any(axis=1)])
    # The second wedge has neighbours on both sides, whether the sheet is a disc or a band.
    own = np.flatnonzero(inner & (whole.turn == 1) & ~whole.mirrored)
    for vertex in own[np.argsort(whole.origin[own])].tolist():
        if closing.whole.half.seats[whole.origin[vertex]] is Seat.CENTRE:
            continue
        creases = (whole.edges == vertex).any(axis=1)
        seen = flat_vertex(whole.flat, whole.edges, vertex, np.where(folded, signs, 0))
        yield {
            "point": int(whole.origin[vertex]) + closing.first,
            "folded": int((creases & folded).sum()),
            "flat": int((creases & ~folded).sum()),
            "kawasaki_deg": seen.kawasaki_deg,
            "M_minus_V": seen.mountains_minus_valleys,
            "verdict": _judged(seen, bool((signs[creases & folded] == 0).any())),
        }


def _judged(seen: FlatVertex, is_open: bool) -> str:
    return UNDECIDED if is_open else PASSES if seen.holds else FAILS


def _by_rule(rows: list[dict[str, Any]]) -> tuple[str, str]:
    for verdict in (FAILS, UNDECIDED):
        those = [row for row in rows if row["verdict"] == verdict]
        if those:
            return verdict, " ".join(_reason(row) for row in those)
    if not rows:
        return PASSES, "There is no inner vertex to judge."
    return PASSES, f"Kawasaki and Maekawa hold in the limit, at each of {len(rows)} inner points."


def _reason(row: dict[str, Any]) -> str:
    if row["verdict"] == UNDECIDED:
        return f"At point {row['point']} two facets end equally deep: mountain or valley is open."
    return (
        f"At point {row['point']} mountains less valleys are {row['M_minus_V']} in the limit, not "
        "2 or −2: there its facets cannot all lie flat without passing through each other."
    )


def _first_fault(closing: Closing) -> str:
    """Return what first goes wrong on the way, or nothing."""
    full = np.pi / closing.whole.half.order
    rates = np.append(np.arange(STEPS) / STEPS, LAST)
    for rate, meridian in zip(rates, closing.places(full * (1 - rates)), strict=True):
        fault = _fault(closing, meridian, full * (1 - rate))
        if fault:
            return f"At a folding rate of {100 * rate:.4g} % {fault}."
    return ""


def _fault(closing: Closing, meridian: Floats, theta: float) -> str:
    lost = np.flatnonzero(np.isnan(meridian[:, 0]))
    if len(lost):
        return f"point {lost[0] + closing.first} has no place, or turns freely"
    r = meridian[:, 0]
    slack = ON_LINE * float(np.abs(meridian).max())
    if (r > slack).any() and (r < -slack).any():
        return f"the form lies on both sides of its axis (point {int(r.argmin()) + closing.first})"
    half = replace(closing.whole.half, spatial=_spatial(closing.whole, meridian, theta))
    sides, _ = planar.face_sides(half.faces)
    pairs = penetrations(half.spatial, np.unique(np.sort(sides, axis=1), axis=0), half.faces)
    if not len(pairs):
        return ""
    names = [_facet(half.faces[k], closing.first) for k in pairs[0]]
    return f"the facets {names[0]} and {names[1]} pass through each other"


def _spatial(whole: Rosette, meridian: Floats, theta: float) -> Floats:
    azimuth = np.where([seat is Seat.L2 for seat in whole.half.seats], theta, 0.0)
    r, z = meridian.T
    return np.column_stack([r * np.cos(azimuth), r * np.sin(azimuth), z])


def _facet(corners: NDArray[np.intp], first: int) -> str:
    return "-".join(str(k + first) for k in sorted(corners.tolist()))
