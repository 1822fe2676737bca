"""Where everything lies on a coupon: bars round it, verniers along two edges, ladders between.

The *board* is what lies within the strips that registration holes, witness mark and lead-ins need.
Its lower left corner holds the bars' A; the verniers stand along the lower and the left edge; the
ladders fill what is left from the top down, in rows.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain

import numpy as np

from foldmill_fabricate.coupon import lettering
from foldmill_fabricate.coupon.trials import ANGLES
from foldmill_fabricate.errors import DoesNotFit
from foldmill_fabricate.kinds import FlipKind
from foldmill_fabricate.ladders import Bars, Ladder, LadderKind, Rung, Side, Vernier, Words
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Flip, Sheet
from foldmill_fabricate.plan.registration import DIFFERENCE, WITNESS, WITNESS_CLEARANCE
from foldmill_fabricate.sheet import flipped

EDGE = 5.0
"""mm from the blank's edge to the board where nothing else has to lie between."""
LEAD_IN = 12.0
"""mm. What lead-ins need beside the board."""
STRIP = (16.0, 30.0)
"""mm. Width and length of a strip that folds at its root."""
PATCH = 40.0
"""mm. Side of a patch."""
LABEL = 3.0
"""mm. Height of a rung's value."""
NUMBER = 2.5
"""mm. Height of a vernier's numbers."""
UNDER = 5.0
"""mm. What a cell gives its words, below its cuts."""
RUN = 2.0
"""mm by which a strip's cuts run on below its root."""
GAP = 8.0
"""mm between cells."""
ARM = 3.0
"""mm. Half a bar's cross."""
TICK = 5.0
"""mm. Length of a vernier's lines."""
PITCHES = (10.0, 10.1)
"""mm between a vernier's lines on the front and on the reverse."""
MOST_LINES = 10
"""Lines on either side of a vernier's zero."""
ROWS = (5, 3)
"""Verniers side by side along the axis that the flip mirrors, where a wrong scale shows double, and
along the other."""
LARGE = 250.0
"""mm. On a smaller board a wrong scale shows less, and fewer verniers do."""
LEAST = 160.0
"""mm. The least side of a board: bars and verniers fill it."""
TITLES: dict[LadderKind, str] = {
    "depth": "DEPTH MM",
    "force": "FORCE G",
    "repeats": "REPEATS",
    "gap": "GAP MM",
    "spacing": "SPACING MM",
    "hinge": "HINGE DEG",
    "relief": "RELIEF MM",
}

Box = tuple[float, float, float, float]
"""Left, bottom, right, top."""


@dataclass(frozen=True)
class Layout:
    """What lies where."""

    board: Box
    ladders: tuple[Ladder, ...]
    verniers: tuple[Vernier, ...]
    bars: Bars
    words: tuple[Words, ...]
    left_out: tuple[str, ...]


def strips(kind: FlipKind, material: Material) -> Box:
    """Return the widths at the left, bottom, right and top in which nothing is tried, mm.

    Holes that the flip maps to each other need two strips across its axis, one of them wider, so
    that a sheet turned the wrong way shows it.
    """
    holes = material.holes
    across = holes.part_clearance + holes.diameter + holes.edge_clearance
    mark = 2 * WITNESS_CLEARANCE + float(np.hypot(*WITNESS.reshape(-1, 2).max(axis=0)))
    strip = float(np.ceil(max(across, mark))) + 2.0
    wider = strip + DIFFERENCE
    if not material.cut.goes_through:  # then there are no holes, only lead-ins
        strip = wider = LEAD_IN
    return (EDGE, strip, EDGE, wider) if kind == "left-right" else (strip, EDGE, wider, EDGE)


def least_blank(kind: FlipKind, material: Material) -> tuple[float, float]:
    """Return width and height of the smallest blank that holds bars and verniers, mm."""
    left, bottom, right, top = strips(kind, material)
    return LEAST + left + right, LEAST + bottom + top


def board(sheet: Sheet, flip: Flip, material: Material) -> Box:
    """Return the area within which everything lies; raises DoesNotFit for a blank without one."""
    x, y, right, top = strips(flip.kind, material)
    found = (x, y, sheet.width - right, sheet.height - top)
    need = least_blank(flip.kind, material)
    if sheet.width < need[0] or sheet.height < need[1]:
        raise DoesNotFit(
            f"A coupon does not fit on a blank of {sheet.width:g} × {sheet.height:g} mm. The "
            f"smallest that holds its bars and verniers is {need[0]:g} × {need[1]:g} mm."
        )
    return found


def lay_out(
    values: Mapping[LadderKind, tuple[float, ...]],
    sides: tuple[Side, ...],
    area: Box,
    flip: Flip,
    titles: Mapping[Side, str],
) -> Layout:
    """Place everything within a board.

    values : the trials of each ladder; sides : the faces that hinges are tried on, the usual one
    first; titles : what each face is headed with. A ladder that finds no room is left out with a
    sentence.
    """
    left, low, right, high = area
    bars = _bars(area)
    many, few = ROWS if min(right - left, high - low) >= LARGE else (ROWS[1], ROWS[1])
    rows_x, rows_y = (many, few) if flip.kind == "left-right" else (few, many)
    across = _verniers("x", (left + 16, low + 12), right - left - 24, rows_x)
    x, y = left + 16, low + 12 + 18 * len(across)
    upward = _verniers("y", (x, y), high - y - 8, rows_y)
    room = (x + 22 * len(upward) + 4, y + 2, right - 12, high - 12)
    ladders, words, left_out = _ladders(values, sides, room, flip)
    headed = [_heading(text, side, (left + 10, high - 4), flip) for side, text in titles.items()]
    told = (*headed, *_bar_words(bars), *_numbers((*across, *upward)), *words)
    return Layout(area, tuple(ladders), (*across, *upward), bars, told, tuple(left_out))


def _bars(area: Box) -> Bars:
    left, low, right, high = area
    width, height = (float(10 * np.floor(s / 10)) for s in (right - left - 12, high - low - 18))
    return Bars(at=(left + 5, low + 5), width=width, height=height, reach=ARM)


def _bar_words(bars: Bars) -> Iterator[Words]:
    x, y = bars.at
    spots = {
        "A": (x + 4, y + 4),
        "B": (x + bars.width - 7, y + 4),
        "C": (x + bars.width - 7, y + bars.height - 7),
        "D": (x + 4, y + bars.height - 7),
    }
    for letter, spot in spots.items():
        yield Words(text=letter, at=spot, height=LABEL, face="front")


def _verniers(axis: str, corner: tuple[float, float], room: float, rows: int) -> list[Vernier]:
    """Return verniers side by side; corner : the lower left of their place."""
    front, reverse = PITCHES
    shift_each = 2 * (reverse - front)  # per line on either side: rows follow on each other
    n = MOST_LINES
    while 2 * n * reverse + rows * n * shift_each > room:
        n -= 1
    middle = n * reverse + rows * n * shift_each / 2
    found = []
    for row in range(rows):
        along, beside = middle, TICK + (18.0 if axis == "x" else 22.0) * row
        spot = (along, beside) if axis == "x" else (beside, along)
        found.append(
            Vernier(
                axis=axis,  # type: ignore[arg-type]
                at=(round(corner[0] + spot[0], 6), round(corner[1] + spot[1], 6)),
                shift=round((row - rows // 2) * n * shift_each, 6),
                each_way=n,
                front_pitch=front,
                reverse_pitch=reverse,
                tick=TICK,
            )
        )
    return found


def number(vernier: Vernier, k: int) -> int:
    """Return the number at line k: by how many tenths of a mm the reverse is off if it meets."""
    return -round(10 * vernier.shift) - k


def _numbers(verniers: tuple[Vernier, ...]) -> Iterator[Words]:
    for vernier in verniers:
        (x, y), n = vernier.at, vernier.each_way
        for k in range(-n, n + 1):
            text = str(number(vernier, k))
            if k % 5 and abs(k) != n:
                continue
            place = vernier.front_pitch * k
            half = lettering.width(text, NUMBER) / 2
            spot = (x + place - half + 0.4, y + TICK + 1)
            if vernier.axis == "y":
                spot = (x + TICK + 1, y + place - NUMBER / 2)
            yield Words(text=text, at=spot, height=NUMBER, face="front")


def _heading(text: str, side: Side, at: tuple[float, float], flip: Flip) -> Words:
    if side == "reverse":
        # where the eye finds it when the sheet is turned over: at the top left, as on the front
        seen = np.array([at])
        at = tuple(flipped(seen, flip)[0].tolist())
    return Words(text=text, at=at, height=LABEL, face=side)


def cell(kind: LadderKind) -> tuple[float, float]:
    """Return width and height of a cell, words included, mm."""
    if kind == "relief":
        return PATCH, UNDER + PATCH
    return STRIP[0], UNDER + RUN + STRIP[1]


def _ladders(
    values: Mapping[LadderKind, tuple[float, ...]], sides: tuple[Side, ...], room: Box, flip: Flip
) -> tuple[list[Ladder], list[Words], list[str]]:
    """Fill the room from the top down; each ladder begins a row."""
    left, low, right, y = room
    ladders, words, left_out = [], [], []
    for kind, tried in values.items():
        trials = _trials(kind, tried, sides)
        wide, high = cell(kind)
        per_row = max(1, int((right - left + GAP) // (wide + GAP)))
        rows = -(-len(trials) // per_row)
        bottom = y - (LABEL + 3) - rows * (high + GAP)
        if bottom < low - GAP or left + wide > right:
            left_out.append(
                f"The {kind} ladder is left out: the blank has no room for it. Take a larger one."
            )
            continue
        words.append(Words(text=TITLES[kind], at=(left, y - LABEL), height=LABEL, face="front"))
        rungs = []
        for k, (value, face) in enumerate(trials):
            row, column = divmod(k, per_row)
            spot = (left + column * (wide + GAP), y - (LABEL + 3) - row * (high + GAP) - high)
            rungs.append(Rung(value=value, at=spot, face=face))
            words.append(_value_words(rungs[-1], wide, flip))
        ladders.append(Ladder(kind=kind, rungs=tuple(rungs)))
        y = bottom
    return ladders, words, left_out


def _trials(
    kind: LadderKind, values: tuple[float, ...], sides: tuple[Side, ...]
) -> list[tuple[float, Side]]:
    if kind != "hinge":
        return [(value, sides[0]) for value in values]
    return list(chain.from_iterable(((value, side) for value in ANGLES) for side in sides))


def _value_words(rung: Rung, wide: float, flip: Flip) -> Words:
    """Return a rung's value under its cuts, on the face that its scores are on."""
    x, y = rung.at
    if Face(rung.face) is Face.REVERSE:
        x, y = (x + wide, y) if flip.kind == "left-right" else (x, y + LABEL)
    return Words(text=f"{rung.value:g}", at=(x, y), height=LABEL, face=rung.face)
