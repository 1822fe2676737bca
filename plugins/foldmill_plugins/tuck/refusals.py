"""The sentences that refuse a tuck: what, where, by how much, what to do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from foldmill import ImpossibleGeometry, InvalidParameters
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.corners import place


class NoPlace(ImpossibleGeometry):
    """A flap that has no place beside the surface and the flaps already there."""


def both_sides(blank: Blank) -> InvalidParameters:
    """Refuse a flap that is asked to lie on both sides."""
    return InvalidParameters(
        f"The tuck beside {blank.name} cannot lie inside and outside; say one for all its corners."
    )


def check_given(blank: Blank, given: Sequence[float | None]) -> None:
    """Refuse corners off their segment or out of order."""
    before, other = blank.start, blank.first
    for i, t in zip(blank.points, given, strict=True):
        is_rim = blank.is_open and i == blank.points[-1]
        if t is None:
            break
        end = np.inf if is_rim else blank.end
        if not before < t < end:
            _refuse_segment(blank, i, t, before, other)
        before, other = t, i


def _refuse_segment(blank: Blank, i: int, t: float, before: float, other: int) -> None:
    of = f"the corner beside point {i}" if len(blank.points) > 1 else f"the tuck beside point {i}"
    said = f"{of[0].upper()}{of[1:]} has t = {t:g} mm, "
    if before >= t > blank.start:
        raise ImpossibleGeometry(
            f"{said}out of order: the corner beside point {other} is at {before:.6g} mm. Give it "
            f"more than that."
        )
    if blank.is_open and i == blank.points[-1]:
        raise ImpossibleGeometry(f"{said}off its line: give it more than {before:.6g} mm.")
    raise ImpossibleGeometry(
        f"{said}off its segment: give it a value between {before:.6g} and {blank.end:.6g} mm."
    )


def check_reach(
    blank: Blank, given: Sequence[float | None], patterns: Sequence[tuple[int, ...]]
) -> None:
    """Refuse where the leading given corners, on whatever sides, have no place in space."""
    if len(blank.points) > 1 and all(t is None for t in given):
        return
    leading = 0
    while leading < len(given) and given[leading] is not None:
        leading += 1
    shares = np.full((len(patterns), len(blank.points)), 0.5)
    found = place(blank, shares, np.array(patterns, float), given)
    for j, i in enumerate(blank.points[: max(leading, 1)]):
        t, low, high = found.t[:, j], found.low[:, j], found.high[:, j]
        if blank.is_open and i == blank.points[-1]:
            continue
        if not (high > low).any():
            _refuse_blank(blank)
        if not ((t > low) & (t < high)).any():
            best = int(np.argmax(high - low))
            raise ImpossibleGeometry(
                f"The tuck beside point {i} has no place in space at t = {t[best]:g} mm: give it "
                f"a value between {low[best]:.6g} and {high[best]:.6g} mm."
            )


def _refuse_blank(blank: Blank) -> None:
    a, b = blank.chain[0], blank.chain[-1]
    raise ImpossibleGeometry(
        f"The blank beside {blank.name} cannot be tucked: no place of its corners between points "
        f"{a} and {b} reaches the points in space. Move {blank.name}, or points {b} and beyond."
    )


def no_place(
    blank: Blank,
    given: Sequence[float | None],
    ranges: Mapping[int, tuple[float, float]],
    side: int | None,
    inside: int,
) -> NoPlace:
    """Refuse a flap that is nowhere free, or not where it is asked to be.

    ranges : side → free values of the first t, mm, over all its other corners.
    """
    names = {inside: "inside", -inside: "outside", 0: "inside and outside, flush"}
    if side is not None and ranges and side not in ranges:
        allowed = " and ".join(
            f"{names[s]} ({_range(blank, *run)})" for s, run in sorted(ranges.items())
        )
        return NoPlace(
            f"The tuck beside {blank.name} cannot lie {names[side]}: the shape allows it {allowed}."
        )
    if side is not None and None not in given and side in ranges:
        at = " and ".join(f"{t:g}" for t in given)
        return NoPlace(
            f"The tuck beside {blank.name} does not lie {names[side]} at t = {at} mm; it does "
            f"{_range(blank, *ranges[side])}."
        )
    if None not in given:
        return _given(blank, given, ranges)
    low, high = _span(blank)
    several = len(blank.points) > 1
    where = "corners lie" if several else "corner lies"
    return NoPlace(
        f"The tuck beside {blank.name} penetrates the form wherever its {where} between "
        f"t = {low:.6g} and {high:.6g} mm. Move {blank.name}."
    )


def _given(
    blank: Blank, given: Sequence[float | None], ranges: Mapping[int, tuple[float, float]]
) -> NoPlace:
    runs = " and ".join(_range(blank, *run) for _, run in sorted(ranges.items()))
    hint = f"{runs} it is free" if ranges else f"no other t is free either, so move {blank.name}"
    at = " and ".join(f"{t:g}" for t in given)
    return NoPlace(f"The tuck beside {blank.name} penetrates the form at t = {at} mm; {hint}.")


def _range(blank: Blank, low: float, high: float) -> str:
    if low < high:
        return f"between {low:.6g} and {high:.6g} mm"
    return f"at {low:.6g} mm" if len(blank.points) == 1 else f"with a first t of {low:.6g} mm"


def _span(blank: Blank) -> tuple[float, float]:
    """Return between which places the corners of a blank can be, mm."""
    if len(blank.points) > 1:
        return blank.start, blank.end
    shares = np.full((1, 1), 0.5)
    found = place(blank, shares, np.ones((1, 1)), [None])
    return float(found.low[0, 0]), float(found.high[0, 0])
