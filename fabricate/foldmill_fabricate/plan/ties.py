"""Where ties are left in the outline: on straight edges, and where those are few on short ones.

A tie lies as asked where it is ``tie_corner`` mm from every corner of a straight edge. Finely
stepped or rounded outlines have no such edge, or have them on some sides only. Where so few ties
find room that the part would be held badly, the rule is eased for the rest:

- a tie may lie across bends, of ``GENTLE_DEG`` in all, ``tie_corner`` mm from every greater bend;
- further than a quarter of a pitch from any place where that is possible, a tie may lie nearer to
  corners: in the middle between two, with its own width cut on either side of it.

Ends of creases and mouths of inner cuts count as corners then. Each such tie is told of.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.materials import ThroughCut

Floats = NDArray[np.float64]
Span = tuple[float, float]
"""From where to where along the rim, mm."""

LEAST_TIES = 3
"""Fewer let the part swing about the last one."""
GENTLE_DEG = 5.0
"""deg. A tie across an outline that bends by no more over the tie's width holds like a straight
one."""
NEAR = 0.25
"""Pitches. Where a place as asked for is so near, no tie lies nearer to corners."""
_SAME = 1e-6
"""mm. Edges whose lengths differ by less are equally long."""


@dataclass(frozen=True, eq=False)
class Rim:
    """The outline from corner to corner, once around."""

    points: Floats
    """(n, 2) mm: the vertices at which it bends, and mouths of inner cuts."""
    bends: Floats
    """(n,) deg, unsigned; 180 at a mouth."""
    ends: Floats
    """(k,) mm along it from the first point at which creases end."""

    @cached_property
    def reached(self) -> Floats:
        """Return the length (n+1,) up to each point, back to the start."""
        steps = np.roll(self.points, -1, axis=0) - self.points
        return np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])

    def at(self, length: float) -> Floats:
        """Return the point (2,) at a length along it."""
        closed = np.vstack([self.points, self.points[:1]])
        length %= self.reached[-1]
        return np.array([np.interp(length, self.reached, closed[:, k]) for k in (0, 1)])

    def stops(self, width: float) -> Floats:
        """Return the places (m,), ascending mm, that no eased tie of this width may reach."""
        reached = self.reached
        whole, at = float(reached[-1]), reached[:-1]
        round_twice = np.concatenate([at - whole, at, at + whole])
        bent = np.concatenate([[0.0], np.cumsum(np.tile(self.bends, 3))])
        low = np.searchsorted(round_twice, at - width, "left")
        high = np.searchsorted(round_twice, at + width, "right")
        sharp = at[bent[high] - bent[low] > GENTLE_DEG]
        return np.unique(np.concatenate([sharp, self.ends]))


def places(rim: Rim, cut: ThroughCut) -> list[float]:
    """Return the middle of each tie as a length along the rim, ascending.

    Raises CannotPlan where the outline has room for fewer than three, even by the eased rule.
    """
    whole = float(rim.reached[-1])
    asked = _as_asked(rim, cut)
    if len(asked) >= max(LEAST_TIES, int(whole / cut.tie_pitch)):
        return asked
    eased = _eased(rim, cut)
    found = eased if len(eased) > len(asked) else asked
    if len(found) < LEAST_TIES:
        raise CannotPlan(
            f"The outline has room for {len(found)} ties, and a part needs {LEAST_TIES}: they lie "
            f"on edges of {2 * (cut.tie_corner + cut.tie_width / 2):g} mm, or at least in the "
            f"middle of edges of {3 * cut.tie_width:g} mm. Enlarge the part, leave small tabs out, "
            f"or choose a material whose ties are smaller."
        )
    return found


def _as_asked(rim: Rim, cut: ThroughCut) -> list[float]:
    """Return places on straight edges only, about a pitch apart."""
    spans, whole = _straight(rim, cut), float(rim.reached[-1])
    if not spans:
        return []
    found: list[float] = []
    for want in _wanted(whole, cut):
        near = min((min(max(want, low), high) for low, high in spans), key=lambda s: abs(s - want))
        if not found or near - found[-1] > 2 * cut.tie_corner:
            found.append(near)
    return _once_round(found, whole, cut)


def _straight(rim: Rim, cut: ThroughCut) -> list[Span]:
    """Return where on straight edges the middle of a tie may be."""
    room = cut.tie_corner + cut.tie_width / 2
    return [(a + room, b - room) for a, b in pairwise(rim.reached) if b - a > 2 * room]


def _wanted(whole: float, cut: ThroughCut) -> list[float]:
    count = max(LEAST_TIES, round(whole / cut.tie_pitch))
    pitch = whole / count
    return [(k + 0.5) * pitch for k in range(count)]


def _once_round(found: list[float], whole: float, cut: ThroughCut) -> list[float]:
    """Leave the last one out where it has come round to the first."""
    if len(found) > 1 and found[0] + whole - found[-1] <= 2 * cut.tie_corner:
        return found[:-1]
    return found


def _eased(rim: Rim, cut: ThroughCut) -> list[float]:
    """Return places by the eased rule, at most one for each pitch along the rim."""
    whole = float(rim.reached[-1])
    good, short = _gentle(rim, cut)
    good = _round_the_start([*_straight(rim, cut), *good], whole)
    middles = [_modulo((low + high) / 2, whole) for low, high in short]
    far = [k for k, s in enumerate(middles) if _apart(s, good) > NEAR * cut.tie_pitch]
    wanted = _wanted(whole, cut)
    half = whole / len(wanted) / 2
    found: list[float] = []
    for want in wanted:
        place = _nearest(want, half, good)
        if place is None:
            place = _longest(want, half, [(middles[k], short[k]) for k in far])
        if place is not None and (not found or place - found[-1] > 2 * cut.tie_corner):
            found.append(place)
    return _once_round(found, whole, cut)


def _gentle(rim: Rim, cut: ThroughCut) -> tuple[list[Span], list[Span]]:
    """Return where middles of ties as far from stops as asked may be, and stretches too short."""
    room, whole = cut.tie_corner + cut.tie_width / 2, float(rim.reached[-1])
    stops = rim.stops(cut.tie_width).tolist()
    if not stops:
        return [(0.0, whole)], []
    runs = list(pairwise([*stops, stops[0] + whole]))
    good = [(a + room, b - room) for a, b in runs if b - a > 2 * room]
    return good, [(a, b) for a, b in runs if 3 * cut.tie_width <= b - a <= 2 * room]


def _round_the_start(spans: list[Span], whole: float) -> list[Span]:
    return [(low + turn, high + turn) for turn in (-whole, 0.0, whole) for low, high in spans]


def _modulo(place: float, whole: float) -> float:
    return place - whole if place >= whole else place


def _apart(place: float, spans: list[Span]) -> float:
    """Return how far a place is from the nearest of some spans, mm along the rim."""
    gaps = (max(low - place, place - high, 0.0) for low, high in spans)
    return min(gaps, default=np.inf)


def _nearest(want: float, half: float, spans: list[Span]) -> float | None:
    """Return the place on a span that is nearest to a wanted one, no further than half a pitch."""
    near = min(
        (min(max(want, low), high) for low, high in spans),
        key=lambda s: abs(s - want),
        default=np.inf,
    )
    return near if abs(near - want) < half else None


def _longest(want: float, half: float, short: list[tuple[float, Span]]) -> float | None:
    """Return the middle of the longest stretch within half a pitch, the nearest of equal ones."""
    near = [(place, high - low) for place, (low, high) in short if abs(place - want) < half]
    if not near:
        return None
    most = max(length for _, length in near)
    return min((p for p, length in near if length > most - _SAME), key=lambda p: abs(p - want))


def findings(rim: Rim, found: list[float], cut: ThroughCut) -> Iterator[Finding]:
    """Yield what a person should know about ties (places along the rim) not made as asked for."""
    whole = float(rim.reached[-1])
    apart = np.abs(np.array(found)[:, None] - rim.reached[None, :-1])
    gaps = np.minimum(apart, whole - apart) - cut.tie_width / 2
    near = gaps[:, rim.bends > GENTLE_DEG].min(axis=1, initial=np.inf)
    bent = np.where(gaps < 0, rim.bends, 0.0).sum(axis=1)
    if (short := near < cut.tie_corner - _SAME).any():
        yield _told(
            "ties-near-corners",
            f"{int(short.sum())} of {len(found)} ties lie nearer to corners than the "
            f"{cut.tie_corner:g} mm asked for, the nearest {near.min():.2f} mm from one: no edge "
            f"there is long enough.",
            rim.at(found[int(np.argmin(near))]),
        )
    if (across := bent > 0).any():
        yield _told(
            "ties-across-bends",
            f"{int(across.sum())} of {len(found)} ties lie across bends of the outline of up to "
            f"{bent.max():.1f}°: no straight edge there is long enough.",
            rim.at(found[int(np.argmax(bent))]),
        )


def _told(code: str, message: str, spot: Floats) -> Finding:
    remedy = "Part them with a sharp knife and trim what is left, or enlarge the design."
    x, y = float(spot[0]), float(spot[1])
    return Finding(code, Severity.WARNING, "outline", message, remedy, (x, y))
