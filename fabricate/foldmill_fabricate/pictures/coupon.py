"""A coupon explained: the whole sheet with its parts named, one cell of each kind, one vernier."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from foldmill_fabricate.ladders import Coupon, Vernier
from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.pictures.sheet import Floats
from foldmill_fabricate.sheet import strokes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOKS: tuple[tuple[tuple[Role, ...], Face, str, float], ...] = (
    ((Role.HOLE, Role.WITNESS), Face.FRONT, "#808080", 0.9),
    ((Role.LABEL, Role.RULER, Role.SCORE, Role.VERNIER), Face.REVERSE, "#f07800", 0.9),
    ((Role.LABEL, Role.RULER, Role.SCORE, Role.VERNIER), Face.FRONT, "#0050d0", 0.9),
    ((Role.CUT_INNER, Role.CUT_OUTER, Role.RELIEF), Face.REVERSE, "#d01010", 0.9),
)
"""Which lines of which face look how: front blue, reverse orange, cuts red."""
SHOWN = 0.3
"""mm by which the reverse is off in the picture of a vernier."""
_KEY = "blue: on the front   orange: on the reverse   red: cut through   seen from the front"


def coupon_picture(plan: Plan, coupon: Coupon) -> bytes:
    """Return a PNG of the whole sheet, seen from the front, each part with its name."""
    with canvas.own_style():
        figure = canvas.figure(200, 215)
        axes = canvas.flat_axes(figure, (0.02, 0.05, 0.96, 0.93))
        w, h = plan.sheet.width, plan.sheet.height
        axes.fill([0, w, w, 0], [0, 0, h, h], facecolor="#fafafa", edgecolor="#606060")
        _draw(axes, plan)
        for text, spot in _names(plan, coupon):
            axes.text(*spot, text, fontsize=8, va="center", color="#202020")
        axes.set_xlim(-0.02 * w, 1.02 * w)
        axes.set_ylim(-0.02 * h, 1.02 * h)
        figure.text(0.5, 0.02, _KEY, ha="center", fontsize=8)
        return canvas.png(figure)


def _draw(axes: Axes, plan: Plan, off: float = 0.0) -> None:
    """Draw all lines; off : mm by which those of the reverse lie to the right."""
    for roles, face, colour, width in LOOKS:
        found = [line for role in roles for line in strokes(plan, role, face)]
        shift = np.array([off if face is Face.REVERSE else 0.0, 0.0])
        canvas.add_lines(axes, [line + shift for line in found], color=colour, linewidth=width)


def _names(plan: Plan, coupon: Coupon) -> list[tuple[str, tuple[float, float]]]:
    """Return the name of each part and where it stands, right of the part."""
    about = {
        "depth": "depth: how far the blade stands out",
        "gap": "gap: the land between two cuts",
        "force": "force: how hard it is pressed",
        "repeats": "repeats: how often it goes over",
        "spacing": "spacing: two scores side by side",
        "hinge": "hinges: fold to 90° and 180°",
        "relief": "relief: holes where creases meet",
    }
    found = []
    for ladder in coupon.ladders:
        wide = coupon.patch if ladder.kind == "relief" else coupon.strip_width
        right = max(rung.at[0] for rung in ladder.rungs) + wide + 8
        found.append((about[ladder.kind], (right, ladder.rungs[0].at[1] + 22)))
    for axis in ("x", "y"):
        rows = [vernier for vernier in coupon.verniers if vernier.axis == axis]
        x = max(v.at[0] for v in rows) + (rows[0].each_way * 10 + 12 if axis == "x" else 0)
        y = float(np.mean([v.at[1] for v in rows])) + (
            rows[0].each_way * 10 + 22 if axis == "y" else 0
        )
        spot = (x, y) if axis == "x" else (min(v.at[0] for v in rows) - 4, y)
        found.append((f"vernier {axis}", spot))
    x, y = coupon.bars.at
    found.append(("bars: A to B, A to D, A to C, B to D", (x + 0.5 * coupon.bars.width, y + 5)))
    found += [("registration holes", (hole.x - 75, hole.y)) for hole in plan.holes[:1]]
    return found


def cells_picture(plan: Plan, coupon: Coupon) -> bytes:
    """Return a PNG of the first two strips and of a patch, large."""
    ladders = {ladder.kind: ladder.rungs for ladder in coupon.ladders}
    spots = [ladders["depth"][0].at, ladders["spacing"][-1].at, ladders["relief"][-1].at]
    names = ("a strip: bend it at its root", "two scores on a strip", "a patch on its four ties")
    with canvas.own_style():
        figure = canvas.figure(200, 80)
        for k, ((x, y), name) in enumerate(zip(spots, names, strict=True)):
            axes = canvas.flat_axes(figure, (0.01 + 0.33 * k, 0.1, 0.31, 0.8))
            _draw(axes, plan)
            axes.set_xlim(x - 3, x + 43)
            axes.set_ylim(y - 2, y + 46)
            axes.set_title(name, fontsize=9)
        figure.text(0.5, 0.03, _KEY, ha="center", fontsize=8)
        return canvas.png(figure)


def vernier_picture(plan: Plan, coupon: Coupon) -> bytes:
    """Return a PNG of part of a vernier whose reverse lies 0.3 mm to the right, and its reading."""
    row = next(v for v in coupon.verniers if v.axis == "x" and v.shift == 0)
    with canvas.own_style():
        figure = canvas.figure(200, 50)
        axes = canvas.flat_axes(figure, (0.01, 0.25, 0.98, 0.73))
        _draw(axes, plan, SHOWN)
        x, y = row.at
        place = x - 10 * SHOWN * row.front_pitch
        _mark(axes, place, y, row)
        axes.set_xlim(x - 62, x + 62)
        axes.set_ylim(y - 9, y + 10)
        told = f"the reverse lies {SHOWN:g} mm to the right: its lines meet the front's at 3"
        figure.text(0.5, 0.14, told, ha="center", fontsize=9)
        figure.text(0.5, 0.03, _KEY, ha="center", fontsize=8)
        return canvas.png(figure)


def _mark(axes: Axes, place: float, y: float, row: Vernier) -> None:
    turns: Floats = np.radians(np.linspace(0, 360, 60))
    ring = np.column_stack([place + 2.6 * np.cos(turns), y + 1.4 * row.tick * np.sin(turns)])
    axes.plot(*ring.T, color="#109030", linewidth=1.4)
    axes.text(place + 3.2, y - 1.6 * row.tick, "one straight line: 3", fontsize=9, color="#109030")
