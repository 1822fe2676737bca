"""From parameters to a fold: solve the strip, fill its blanks, state the creases that close."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from foldmill import Fold, InvalidParameters
from foldmill.axisymmetric import closed, rosette, strip
from foldmill.axisymmetric.rosette import EdgeSigns, HalfWedge, Rosette
from foldmill.check.intersection import penetrations
from foldmill_plugins.tuck import blanks, classify, flaps, handles, refusals, search
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.clearance import Surroundings
from foldmill_plugins.tuck.flaps import Flap
from foldmill_plugins.tuck.params import Tuck, TuckParams
from foldmill_plugins.tuck.search import Placed, Wish


def generate(params: TuckParams) -> Fold:
    """Return the fold; raises ImpossibleGeometry where a blank cannot be tucked."""
    solved = strip.solve(params.n, params.phi, dict(params.points))
    found = blanks.find(solved)
    tucks = _tucks(params, found)
    half, made = flaps.add(HalfWedge.of(solved), found)
    rose = rosette.assemble(half)
    # The two halves of a flap enclose nothing, wherever its corners are.
    inside = -1 if rosette.is_inside_out(rose) else 1
    wishes = [Wish.of(flap.blank, tucks, inside) for flap in made]
    placed = _place(rose, made, wishes, inside)
    rose = flaps.put(rose, made, placed)
    _check(rose, made, placed)
    # A flush flap lies on neither side; it is folded as if it came from the inside.
    pairs = zip(placed, wishes, strict=True)
    sides = [each.side or wish.side or inside for each, wish in pairs]
    signs = closed.signs(HalfWedge.of(solved), params.phi, params.points)
    fold, meta = _fold(rose, made, sides, signs, inside)
    meta["tucks"] = [entry for each in placed for entry in _report(each, inside)]
    meta["flaps"] = [_shape(each) for each in placed]
    meta["points"] = classify.figures(solved)
    dragged = handles.of(params, solved, made, placed, inside)
    return replace(fold, meta=meta, handles=dragged)


def _tucks(params: TuckParams, found: list[Blank]) -> Mapping[int, Tuck]:
    chosen = {tuck.point: tuck for tuck in params.tucks}
    if len(chosen) < len(params.tucks):
        raise InvalidParameters("Two tucks name the same point; leave one of them out.")
    idle = sorted(set(chosen) - {i for blank in found for i in blank.points})
    if idle:
        raise InvalidParameters(
            f"There is no blank beside point {idle[0]}, so it needs no tuck: leave that tuck out, "
            f"or move the point off its line by giving it r and z."
        )
    return chosen


def _place(rose: Rosette, made: list[Flap], wishes: list[Wish], inside: int) -> list[Placed]:
    """Place the flaps: first those whose corners are all given, then the others around them."""
    if not made:
        return []
    is_surface = np.ones(len(rose.half.faces), bool)
    for flap in made:
        is_surface[flap.faces] = False
    surface = rose.spatial[rose.faces[np.tile(is_surface, 2 * rose.half.order)]]
    order = sorted(range(len(made)), key=lambda k: not wishes[k].is_given)
    around = Surroundings.of(rose.half.order, surface)
    found = search.arrange([(made[k].blank, wishes[k]) for k in order], around, inside)
    return [found[order.index(k)] for k in range(len(made))]


def _check(rose: Rosette, made: list[Flap], placed: list[Placed]) -> None:
    """Give the exact rule the last word on what the quick screen found free."""
    for flap, each in zip(made, placed, strict=True):
        among = rose.wedge_faces(flap.faces)
        if len(penetrations(rose.spatial, rose.edges, rose.faces, among)):
            t = tuple(float(value) for value in each.corners.t[0])
            raise refusals.no_place(flap.blank, t, {}, None, 1)


def _fold(
    rose: Rosette, made: list[Flap], sides: list[int], signs: EdgeSigns, inside: int
) -> tuple[Fold, dict[str, Any]]:
    """Return the fold, and what is to be told of it: how the halves of its flaps are stacked."""
    stated = dict(signs)
    orders: list[list[int]] = []
    for flap, side in zip(made, sides, strict=True):
        stated |= flaps.closed(flap, side)
        orders += flaps.orders(rose, flap, side * inside)
    meta: dict[str, Any] = {"fold": {"folded": {"faceOrders": orders}}} if orders else {}
    return rosette.fold(rose, stated, wedge_decides=not made), meta


def _report(placed: Placed, inside: int) -> list[dict[str, object]]:
    lies = {1: "inside", -1: "outside", 0: "flush"}[placed.side * inside]
    return [
        {"point": i, "t": round(float(t), 6), "lies": lies}
        for i, t in zip(placed.blank.points, placed.corners.t[0], strict=True)
    ]


def _shape(placed: Placed) -> dict[str, object]:
    """Return what a flap's corners do not say: their sides, and what kind of blank it fills."""
    sides = [int(side) for side in placed.corners.sides[0]]
    return {"points": list(placed.blank.points), "sides": sides, "open": placed.blank.is_open}
