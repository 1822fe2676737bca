"""What a coupon must show to be read: verniers, crosses and words, worked out again.

The alphabet is data that the builder reads as well; how letters come to stand on a face is not.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from importlib.resources import files

import numpy as np

from foldmill_fabricate.ladders import Coupon, Vernier, Words
from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.verify.coupon_cells import Wanted, cut

Point = tuple[float, float]


def signs(plan: Plan, coupon: Coupon) -> Iterator[Wanted]:
    """Yield the lines of verniers, bars and words."""
    for vernier in coupon.verniers:
        for name, face, a, b in vernier_lines(vernier):
            if coupon.slits:
                yield cut(plan, name, Role.VERNIER, face, [a, b])
            else:
                yield _drawn(coupon, name, Role.RULER, face, [a, b])
    for name, a, b in _crosses(coupon):
        yield _drawn(coupon, name, Role.RULER, Face.FRONT, [a, b])
    alphabet = tomllib.loads((files("foldmill_fabricate") / "letters.toml").read_text("utf-8"))
    for words in coupon.words:
        for points in _letters(words, alphabet, plan.flip.kind):
            yield _drawn(coupon, f'"{words.text}"', Role.LABEL, Face(words.face), points)


def _drawn(coupon: Coupon, name: str, role: Role, face: Face, points: list[Point]) -> Wanted:
    how = coupon.lettering
    figures = (how.tool, how.exposure, how.force, how.speed, 1)
    return Wanted(name, role, face, np.array(points, float), "score", *figures)


def vernier_lines(vernier: Vernier) -> Iterator[tuple[str, Face, Point, Point]]:
    """Yield name, face and ends of every line."""
    lines = range(-vernier.each_way, vernier.each_way + 1)
    for k in lines:
        name = f"vernier {vernier.axis}, line {-round(10 * vernier.shift) - k}"
        yield name, Face.FRONT, *_across(vernier, k * vernier.front_pitch, vernier.tick)
        place = vernier.shift + k * vernier.reverse_pitch
        yield name, Face.REVERSE, *_across(vernier, place, -vernier.tick)


def _across(vernier: Vernier, place: float, reach: float) -> tuple[Point, Point]:
    x, y = vernier.at
    if vernier.axis == "x":
        return (x + place, y), (x + place, y + reach)
    return (x, y + place), (x + reach, y + place)


def _crosses(coupon: Coupon) -> Iterator[tuple[str, Point, Point]]:
    """Yield the lines A-B and A-D, drawn out by an arm at both ends, and the crosses' others."""
    bars = coupon.bars
    (x, y), w, h, r = bars.at, bars.width, bars.height, bars.reach
    yield "bar A-B", (x - r, y), (x + w + r, y)
    yield "bar A-D", (x, y - r), (x, y + h + r)
    yield "cross B", (x + w, y - r), (x + w, y + r)
    yield "cross D", (x - r, y + h), (x + r, y + h)
    yield "cross C", (x + w - r, y + h), (x + w + r, y + h)
    yield "cross C", (x + w, y + h - r), (x + w, y + h + r)


def _letters(words: Words, alphabet: dict[str, str], flip: str) -> Iterator[list[Point]]:
    """Yield strokes that read from left to right with their face up, the sheet turned for it."""
    unit = words.height / 6
    right, up = 1.0, 1.0
    if words.face == "reverse":
        right, up = (-1.0, 1.0) if flip == "left-right" else (1.0, -1.0)
    for place, letter in enumerate(words.text.upper()):
        for stroke in filter(None, alphabet.get(letter, "").split(";")):
            yield [
                (
                    words.at[0] + right * unit * (6 * place + int(point[0])),
                    words.at[1] + up * unit * int(point[1]),
                )
                for point in stroke.split()
            ]
