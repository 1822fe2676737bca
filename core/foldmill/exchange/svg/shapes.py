"""The shapes of SVG as polylines in their own coordinates."""

from __future__ import annotations

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.safe_xml import Element
from foldmill.exchange.svg import curves
from foldmill.exchange.svg.lengths import numbers, px
from foldmill.exchange.svg.paths import Traced, trace
from foldmill.pattern import Floats

SHAPES = ("path", "line", "polyline", "polygon", "rect", "circle", "ellipse")


def traced(element: Element, most: int) -> Traced:
    """Return the polylines of a shape; raises UnreadableFile where its numbers are none.

    most : pieces it may have.
    """
    if element.name == "path":
        return trace(element.attributes.get("d", ""), most)
    if element.name in {"circle", "ellipse"}:
        return Traced([_ellipse(element)], 1)
    if element.name == "rect":
        return _rect(element)
    if element.name == "line":
        ends = [px(element.attributes, name) for name in ("x1", "y1", "x2", "y2")]
        return Traced([np.array(ends).reshape(2, 2)])
    return Traced([_poly(element)])


def _poly(element: Element) -> Floats:
    values = numbers(element.attributes.get("points", ""), "points")
    if len(values) % 2:
        raise UnreadableFile(f"The points of a {element.name} are an odd count of numbers.")
    points = np.array(values).reshape(-1, 2)
    return np.concatenate([points, points[:1]]) if element.name == "polygon" else points


def _ellipse(element: Element) -> Floats:
    said = element.attributes
    both = px(said, "r")
    rx, ry = (both, both) if element.name == "circle" else (px(said, "rx"), px(said, "ry"))
    return curves.ellipse(px(said, "cx"), px(said, "cy"), rx, ry)


def _rect(element: Element) -> Traced:
    said = element.attributes
    x, y, w, h = (px(said, name) for name in ("x", "y", "width", "height"))
    rx = px(said, "rx", px(said, "ry") if "ry" in said else 0.0)
    rx, ry = min(rx, w / 2), min(px(said, "ry", rx), h / 2)
    if not (w > 0 and h > 0):
        return Traced()
    if rx <= 0 or ry <= 0:
        return Traced([np.array([[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y]])])
    data = (
        f"M{x + rx} {y}H{x + w - rx}A{rx} {ry} 0 0 1 {x + w} {y + ry}V{y + h - ry}"
        f"A{rx} {ry} 0 0 1 {x + w - rx} {y + h}H{x + rx}A{rx} {ry} 0 0 1 {x} {y + h - ry}"
        f"V{y + ry}A{rx} {ry} 0 0 1 {x + rx} {y}Z"
    )
    return trace(data, 20)
