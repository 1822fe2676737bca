"""What the cells of a coupon must hold: strips, patches, and the figures of every score in them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.ladders import Coupon, Ladder, Rung
from foldmill_fabricate.materials import Perforation, ThroughCut
from foldmill_fabricate.passes import Face, Hole, Plan, Role
from foldmill_fabricate.verify.forces import settable

Floats = NDArray[np.float64]

WORDS_UNDER = 5.0
"""mm of a cell, from its lower edge to its cuts."""
RUN_ON = 2.0
"""mm by which a strip's cuts go on below its root."""
CREASES: dict[int, dict[int, str]] = {
    4: {30: "mountain", 90: "valley", 150: "mountain", 270: "mountain"},
    6: {0: "valley", 60: "mountain", 120: "mountain"}
    | {180: "valley", 240: "mountain", 300: "mountain"},
}
"""By how many meet: direction in degrees → fold."""
TIE_OFF_MIDDLE = 0.125
"""Share of a patch's side from its middle to its tie, counter-clockwise."""


@dataclass(frozen=True, eq=False)
class Wanted:
    """A stroke that must be there, and how it must be made."""

    name: str
    role: Role
    face: Face
    points: Floats
    process: str
    tool: int
    exposure: float
    force: float
    speed: float
    repeats: int
    hole: Hole | None = None
    """The hole whose rim it is, where its shape is left to the planner."""

    @property
    def middle(self) -> Floats:
        """(2,) mm: of its bounding box."""
        if self.hole is not None:
            return np.array([self.hole.x, self.hole.y])
        middle: Floats = (self.points.min(axis=0) + self.points.max(axis=0)) / 2
        return middle

    @property
    def loose(self) -> float:
        """mm by which the box of a hole's facets may lie off its middle."""
        return 0.0 if self.hole is None else self.hole.diameter / 4


def cells(plan: Plan, coupon: Coupon) -> Iterator[Wanted]:
    """Yield everything that ladders ask for."""
    for ladder in coupon.ladders:
        for rung in ladder.rungs:
            name = f"{ladder.kind} rung {rung.value:g}"
            if ladder.kind == "relief":
                yield from _patch(plan, coupon, rung, name)
            else:
                yield from _strip(plan, coupon, ladder, rung, name)


def cut(plan: Plan, name: str, role: Role, face: Face, points: list[tuple[float, float]]) -> Wanted:
    """Return a stroke with the figures of the material's cut."""
    made, tools = plan.material.cut, plan.machine.tools
    force = settable(made.force, tools)
    tool = tools.stations.get(made.kind, 0)
    figures = (made.exposure, force, made.speed, made.repeats)
    return Wanted(name, role, face, np.array(points, float), "cut", tool, *figures)


def _score(
    plan: Plan, name: str, face: Face, a: Floats, b: Floats, gap: float | None = None
) -> Iterator[Wanted]:
    """Yield a score with the preset's figures: one stroke, or the cuts of a row.

    gap : the land between those cuts, mm; None for the preset's.
    """
    made, tools = plan.material.score, plan.machine.tools
    force = settable(made.force, tools)
    figures = (made.exposure, force, made.speed, made.repeats)
    tool = tools.stations.get(made.kind, 0)
    pieces = [(a, b)]
    if isinstance(made, Perforation):
        pieces = _row(a, b, made, made.gap if gap is None else gap)
    for start, end in pieces:
        yield Wanted(name, Role.SCORE, face, np.array([start, end]), "score", tool, *figures)


def _row(a: Floats, b: Floats, made: Perforation, gap: float) -> list[tuple[Floats, Floats]]:
    """Return the cuts of a row from a to b.

    n cuts and n + 1 lands stretched to the length, n = round((L − gap) / (cut + gap)); where the
    lands at the ends come out shorter than asked, those are as asked and the rest is stretched.
    """
    length = float(np.linalg.norm(b - a))
    if length < 2 * made.setback + made.cut / 2:
        return []
    n = max(1, round((length - gap) / (made.cut + gap)))
    share = length / (n * made.cut + (n + 1) * gap)
    first, room = gap * share, length - 2 * gap * share
    if first < made.setback:
        first, room = made.setback, length - 2 * made.setback
        n = max(1, round((room + gap) / (made.cut + gap)))
    share = room / (n * made.cut + (n - 1) * gap)
    step, long = (made.cut + gap) * share, made.cut * share
    way = (b - a) / length
    return [(a + (first + k * step) * way, a + (first + k * step + long) * way) for k in range(n)]


def _strip(plan: Plan, coupon: Coupon, ladder: Ladder, rung: Rung, name: str) -> Iterator[Wanted]:
    x, y = rung.at
    wide, foot = coupon.strip_width, y + WORDS_UNDER
    root, head = foot + RUN_ON, foot + RUN_ON + coupon.strip_length
    rim = [(x, foot), (x, head), (x + wide, head), (x + wide, foot)]
    yield cut(plan, f"{name}, strip", Role.CUT_INNER, Face.REVERSE, rim)
    apart = [0.0, rung.value] if ladder.kind == "spacing" else [0.0]
    for up in apart:
        a, b = np.array([x, root + up]), np.array([x + wide, root + up])
        gap = rung.value if ladder.kind == "gap" else None
        for score in _score(plan, f"{name}, score", Face(rung.face), a, b, gap):
            yield _tried(score, ladder, rung)


def _tried(score: Wanted, ladder: Ladder, rung: Rung) -> Wanted:
    """Return a score with the figure that its rung tries."""
    if ladder.kind == "depth":
        return replace(score, exposure=rung.value)
    if ladder.kind == "force":
        return replace(score, force=rung.value)
    return replace(score, repeats=round(rung.value)) if ladder.kind == "repeats" else score


def _patch(plan: Plan, coupon: Coupon, rung: Rung, name: str) -> Iterator[Wanted]:
    side = coupon.patch
    middle = np.array([rung.at[0] + side / 2, rung.at[1] + WORDS_UNDER + side / 2])
    hole = Hole(x=float(middle[0]), y=float(middle[1]), diameter=rung.value) if rung.value else None
    if hole:
        rim = cut(plan, f"{name}, hole", Role.RELIEF, Face.REVERSE, [(hole.x, hole.y)])
        yield replace(rim, hole=hole)
    begin = rung.value / 2 if hole else plan.material.score.setback
    for degrees, fold in CREASES[coupon.degree].items():
        x, y = cos(radians(degrees)), sin(radians(degrees))
        reach = min(side / 2 / abs(c) for c in (x, y) if abs(c) > 1e-9)
        a, b = middle + begin * np.array([x, y]), middle + reach * np.array([x, y])
        yield from _score(plan, f"{name}, {fold} at {degrees}°", _face(plan, fold), a, b)
    yield from _square(plan, middle, side, name)


def _face(plan: Plan, fold: str) -> Face:
    """A groove on the outside: mountains in front; on the inside: the opposite; either: behind."""
    rule = plan.material.score.score_face
    if rule == "either":
        return Face.REVERSE
    return Face.FRONT if (fold == "mountain") == (rule == "outside") else Face.REVERSE


def _square(plan: Plan, middle: Floats, side: float, name: str) -> Iterator[Wanted]:
    """Four strokes round the corners, each from behind one side's tie to before the next's."""
    gap = plan.material.cut.tie_width if isinstance(plan.material.cut, ThroughCut) else 0.0
    half, tie = side / 2, TIE_OFF_MIDDLE * side
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    turn = np.eye(2)
    for _ in range(4):
        corner = [(half, tie + gap / 2), (half, half), (gap / 2 - tie, half)]
        points = [tuple((turn @ np.array(p) + middle).tolist()) for p in corner]
        yield cut(plan, f"{name}, patch", Role.CUT_OUTER, Face.REVERSE, points)
        turn = turn @ quarter
