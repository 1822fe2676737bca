"""The lines of a coupon: what is cut, scored and drawn for each of its parts, mm on the sheet."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.coupon import lettering
from foldmill_fabricate.coupon.layout import RUN, UNDER
from foldmill_fabricate.ladders import Bars, Coupon, Ladder, Rung, Vernier, Words
from foldmill_fabricate.materials import Material, Perforation, ThroughCut
from foldmill_fabricate.passes import Face, Flip, Hole, Role, Stroke, Tie
from foldmill_fabricate.plan.registration import hole_rim
from foldmill_fabricate.toolpath.perforation import Dashes, perforated

Floats = NDArray[np.float64]

RAYS: dict[int, tuple[tuple[float, str], ...]] = {
    4: ((30.0, "M"), (90.0, "V"), (150.0, "M"), (270.0, "M")),
    6: ((0.0, "V"), (60.0, "M"), (120.0, "M"), (180.0, "V"), (240.0, "M"), (300.0, "M")),
}
"""Creases of a patch by how many meet: their directions, deg, and folds. Both fold flat: opposite
sectors add up to 180° (Kawasaki), and mountains and valleys differ by two (Maekawa)."""
TIE_AT = 0.25
"""Where a patch's side is held: this share of half a side past its middle, clear of every ray."""


class Trial(NamedTuple):
    """Figures of a score that differ from the preset's; None where they do not."""

    exposure: float | None = None
    force: float | None = None
    repeats: int | None = None
    gap: float | None = None


USUAL = Trial()
"""The preset's figures."""


class Line(NamedTuple):
    """One stroke, what it is for, and on which face."""

    role: Role
    face: Face
    stroke: Stroke
    trial: Trial = USUAL


def lines(
    coupon: Coupon, material: Material, flip: Flip, offset: float
) -> tuple[list[Line], tuple[Hole, ...], tuple[Tie, ...]]:
    """Return every line of a coupon, its relief holes and its ties.

    offset : of a blade that programs make up for, mm.
    """
    found = [line for vernier in coupon.verniers for line in _vernier(vernier, coupon.slits)]
    found += _bars(coupon.bars)
    found += [line for words in coupon.words for line in _words(words, flip)]
    holes: list[Hole] = []
    ties: list[Tie] = []
    for ladder in coupon.ladders:
        for rung in ladder.rungs:
            if ladder.kind == "relief":
                hole = _hole(coupon, rung)
                holes += [hole] if hole else []
                found += _patch(coupon, rung, material, hole, offset)
                ties += _ties(coupon, rung, material)
            else:
                found += _strip(coupon, ladder, rung, material)
    return found, tuple(holes), tuple(ties)


def _stroke(*points: tuple[float, float]) -> Stroke:
    return Stroke(points=tuple((round(float(x), 6), round(float(y), 6)) for x, y in points))


def _vernier(vernier: Vernier, slits: bool) -> Iterator[Line]:
    role = Role.VERNIER if slits else Role.RULER
    n, (x, y) = vernier.each_way, vernier.at
    for face, pitch, shift, reach in (
        (Face.FRONT, vernier.front_pitch, 0.0, vernier.tick),
        (Face.REVERSE, vernier.reverse_pitch, vernier.shift, -vernier.tick),
    ):
        for k in range(-n, n + 1):
            along = shift + pitch * k
            if vernier.axis == "x":
                yield Line(role, face, _stroke((x + along, y), (x + along, y + reach)))
            else:
                yield Line(role, face, _stroke((x, y + along), (x + reach, y + along)))


def _bars(bars: Bars) -> Iterator[Line]:
    """Two long lines A-B and A-D, and crosses at their ends and at C."""
    (x, y), arm = bars.at, bars.reach
    right, top = x + bars.width, y + bars.height
    for a, b in (
        ((x - arm, y), (right + arm, y)),
        ((x, y - arm), (x, top + arm)),
        ((right, y - arm), (right, y + arm)),
        ((x - arm, top), (x + arm, top)),
        ((right - arm, top), (right + arm, top)),
        ((right, top - arm), (right, top + arm)),
    ):
        yield Line(Role.RULER, Face.FRONT, _stroke(a, b))


def _words(words: Words, flip: Flip) -> Iterator[Line]:
    """Letters as they are read with their face up, on the reverse with the sheet turned over."""
    face = Face(words.face)
    turned = (-1.0, 1.0) if flip.kind == "left-right" else (1.0, -1.0)
    sense = turned if face is Face.REVERSE else (1.0, 1.0)
    for letter in lettering.strokes(words.text, words.height):
        yield Line(Role.LABEL, face, _stroke(*(np.array(words.at) + letter * sense).tolist()))


def _strip(coupon: Coupon, ladder: Ladder, rung: Rung, material: Material) -> Iterator[Line]:
    (x, y), right = rung.at, rung.at[0] + coupon.strip_width
    low, root = y + UNDER, y + UNDER + RUN
    top = root + coupon.strip_length
    way = _stroke((x, low), (x, top), (right, top), (right, low))
    yield Line(Role.CUT_INNER, Face.REVERSE, way)
    heights = (root, root + rung.value) if ladder.kind == "spacing" else (root,)
    for height in heights:
        yield from _scored((x, height), (right, height), rung, material, trial(ladder, rung))


def trial(ladder: Ladder, rung: Rung) -> Trial:
    """Return the figures that a rung tries."""
    value = rung.value
    if ladder.kind == "depth":
        return Trial(exposure=value)
    if ladder.kind == "force":
        return Trial(force=value)
    if ladder.kind == "gap":
        return Trial(gap=value)
    return Trial(repeats=int(value)) if ladder.kind == "repeats" else Trial()


def _scored(
    a: tuple[float, float],
    b: tuple[float, float],
    rung: Rung,
    material: Material,
    figures: Trial = USUAL,
) -> Iterator[Line]:
    score, face = material.score, Face(rung.face)
    if not isinstance(score, Perforation):
        yield Line(Role.SCORE, face, _stroke(a, b), figures)
        return
    gap = score.gap if figures.gap is None else figures.gap
    dashes = Dashes(score.cut, gap, score.setback)
    for start, end in perforated(np.array(a), np.array(b), dashes).tolist():
        yield Line(Role.SCORE, face, _stroke(start, end), figures)


def _middle(coupon: Coupon, rung: Rung) -> Floats:
    half = coupon.patch / 2
    middle: Floats = np.array(rung.at) + np.array([half, UNDER + half])
    return middle


def _hole(coupon: Coupon, rung: Rung) -> Hole | None:
    x, y = _middle(coupon, rung)
    return Hole(x=float(x), y=float(y), diameter=rung.value) if rung.value else None


def _patch(
    coupon: Coupon, rung: Rung, material: Material, hole: Hole | None, offset: float
) -> Iterator[Line]:
    if hole:
        yield Line(Role.RELIEF, Face.REVERSE, hole_rim(hole, offset))
    yield from _rim(coupon, rung, material)
    middle, half = _middle(coupon, rung), coupon.patch / 2
    begin = hole.diameter / 2 if hole else material.score.setback
    for degrees, fold in RAYS[coupon.degree]:
        course = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
        a, b = middle + begin * course, middle + half / np.abs(course).max() * course
        side = rung if fold == "M" else rung.model_copy(update={"face": _other(rung, material)})
        yield from _scored(tuple(a.tolist()), tuple(b.tolist()), side, material)


def _other(rung: Rung, material: Material) -> str:
    """Return the face of valleys, given that of mountains."""
    if material.score.score_face == "either":
        return rung.face
    return "reverse" if rung.face == "front" else "front"


def _sides(coupon: Coupon, rung: Rung) -> list[tuple[Floats, Floats]]:
    """Return the middle of each side of a patch and the way along it, counter-clockwise."""
    half = coupon.patch / 2
    ways = [np.array(way, float) for way in ((0, 1), (-1, 0), (0, -1), (1, 0))]
    return [(_middle(coupon, rung) + half * np.array([w[1], -w[0]]), w) for w in ways]


def _rim(coupon: Coupon, rung: Rung, material: Material) -> Iterator[Line]:
    """The four sides of a patch, as strokes from tie to tie round its corners."""
    assert isinstance(material.cut, ThroughCut)
    half, tie = coupon.patch / 2, material.cut.tie_width
    sides = _sides(coupon, rung)
    for (middle, way), (after, onward) in zip(sides, [*sides[1:], sides[0]], strict=True):
        a = middle + (TIE_AT * half + tie / 2) * way
        b = after + (TIE_AT * half - tie / 2) * onward
        corner = middle + half * way
        yield Line(Role.CUT_OUTER, Face.REVERSE, _stroke(*map(tuple, (a, corner, b))))


def _ties(coupon: Coupon, rung: Rung, material: Material) -> Iterator[Tie]:
    assert isinstance(material.cut, ThroughCut)
    for middle, way in _sides(coupon, rung):
        x, y = middle + TIE_AT * coupon.patch / 2 * way
        yield Tie(x=float(x), y=float(y), width=material.cut.tie_width)
