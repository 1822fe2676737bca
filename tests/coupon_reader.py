"""A person with a steel rule who reads a coupon from what a plotter drew of it.

They look at pictures of both faces, turn the reverse over as the sheet was turned, find crosses and
lines by eye and read lengths to a tenth of a millimetre. What the coupon should look like they know
from its job sheet; where its lines really are they take from the drawing alone.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.ladders import Coupon, Vernier
from foldmill_fabricate.passes import Plan

Floats = NDArray[np.float64]
SVG = "{http://www.w3.org/2000/svg}"
RULE = 0.1
"""mm to which a steel rule is read."""
ALIKE = 0.03
"""mm: two gaps that differ by less look the same through a lens."""


def lines_on(path: Path) -> list[Floats]:
    """Return the polylines of a picture, mm of the mat, y up, its background left out."""
    root = ET.parse(path).getroot()
    height = float(root.attrib["viewBox"].split()[3])
    found = []
    for group in root.iter(f"{SVG}g"):
        for each in group.iter(f"{SVG}path"):
            words = each.attrib["d"].lstrip("M").split()
            points = np.array([[float(v) for v in word.split(",")] for word in words])
            found.append(np.column_stack([points[:, 0], height - points[:, 1]]))
    return found


class Reader:
    """Both faces of a coupon as they lie on the sheet, seen from the front."""

    def __init__(self, plan: Plan, coupon: Coupon, pictures: Path) -> None:
        self.coupon = coupon
        corner = np.array([plan.sheet.dx, plan.sheet.dy])
        self.front = [line - corner for line in lines_on(pictures / "front.svg")]
        over = [line - corner for line in lines_on(pictures / "reverse.svg")]
        size = np.array([plan.sheet.width, plan.sheet.height])
        turned = np.array([1, 0]) if plan.flip.kind == "left-right" else np.array([0, 1])
        self.reverse = [np.where(turned, size - line, line) for line in over]

    def bars(self) -> dict[str, float]:
        """Measure from cross to cross."""
        (x, y), w, h = self.coupon.bars.at, self.coupon.bars.width, self.coupon.bars.height
        a, b, c, d = (self._cross(s) for s in ((x, y), (x + w, y), (x + w, y + h), (x, y + h)))
        pairs = {"ab": (a, b), "ad": (a, d), "ac": (a, c), "bd": (b, d)}
        return {
            name: round(round(float(np.hypot(*(p - q))) / RULE) * RULE, 6)
            for name, (p, q) in pairs.items()
        }

    def _cross(self, about: tuple[float, float]) -> Floats:
        """Return where a level and an upright line cross, near a place."""
        level, upright = None, None
        for line in self.front:
            if len(line) != 2:
                continue
            way = np.abs(line[1] - line[0])
            near = self._distance(line, np.array(about)) < 4.0
            if near and way[0] > 20 * way[1] and way[0] >= 5.9:
                level = line
            if near and way[1] > 20 * way[0] and way[1] >= 5.9:
                upright = line
        assert level is not None, f"no cross near {about}"
        assert upright is not None, f"no cross near {about}"
        ways = np.column_stack([level[1] - level[0], upright[0] - upright[1]])
        t, _ = np.linalg.solve(ways, upright[0] - level[0])
        crossing: Floats = level[0] + t * (level[1] - level[0])
        return crossing

    @staticmethod
    def _distance(line: Floats, spot: Floats) -> float:
        way = line[1] - line[0]
        t = np.clip((spot - line[0]) @ way / (way @ way), 0, 1)
        return float(np.hypot(*(line[0] + t * way - spot)))

    def vernier(self, axis: str) -> float:
        """Return the number at which the lines of both faces are one, half-way between two."""
        gaps: dict[int, float] = {}
        for vernier in (v for v in self.coupon.verniers if v.axis == axis):
            gaps |= self._gaps(vernier)
        best = min(gaps, key=lambda number: abs(gaps[number]))
        for beside in (best - 1, best + 1):
            if beside in gaps and abs(abs(gaps[beside]) - abs(gaps[best])) < ALIKE:
                return (best + beside) / 2
        return float(best)

    def _gaps(self, vernier: Vernier) -> dict[int, float]:
        """Return by number how far the reverse's line is beside the front's, of one row."""
        k = 0 if vernier.axis == "x" else 1
        front, reverse = (
            self._ticks(lines, vernier, sign)
            for lines, sign in ((self.front, 1), (self.reverse, -1))
        )
        found = {}
        for place in front:
            beside = reverse[np.argmin(np.abs(reverse - place))]
            line = round((place - vernier.at[k]) / vernier.front_pitch)
            found[-round(10 * vernier.shift) - line] = float(beside - place)
        return found

    @staticmethod
    def _ticks(lines: list[Floats], vernier: Vernier, side: int) -> Floats:
        """Return where the short lines of one row stand along its axis."""
        k = 0 if vernier.axis == "x" else 1
        reach = vernier.each_way * vernier.reverse_pitch + abs(vernier.shift) + 6
        middle = vernier.at[1 - k] + side * vernier.tick / 2
        found = set()
        for line in lines:
            low, high = line.min(axis=0), line.max(axis=0)
            straight = high[k] - low[k] < 0.2 and abs(high[1 - k] - low[1 - k] - vernier.tick) < 0.2
            here = abs((low + high)[1 - k] / 2 - middle) < vernier.tick / 2
            if straight and here and abs(line[0, k] - vernier.at[k]) < reach:
                found.add(float((low + high)[k] / 2))
        return np.array(sorted(found))
