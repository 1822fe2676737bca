"""The transform attribute of SVG as an affine map."""

from __future__ import annotations

import re
from math import cos, radians, sin, tan

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.svg.lengths import numbers
from foldmill.pattern import Floats

Affine = tuple[float, float, float, float, float, float]
"""(a, b, c, d, e, f): x' = a x + c y + e, y' = b x + d y + f, as SVG writes a matrix."""
STILL: Affine = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
_CALL = re.compile(r"[\s,]*(\w+)\s*\(([^()]*)\)")


def after(outer: Affine, inner: Affine) -> Affine:
    """Return the map that does ``inner`` first."""
    a, b, c, d, e, f = outer
    p, q, r, s, t, u = inner
    return (
        *(a * p + c * q, b * p + d * q),
        *(a * r + c * s, b * r + d * s),
        *(a * t + c * u + e, b * t + d * u + f),
    )


def applied(affine: Affine, points: Floats) -> Floats:
    """Return points (n, 2) mapped."""
    a, b, c, d, e, f = affine
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused by its line
        moved: Floats = points @ np.array([[a, b], [c, d]]) + [e, f]
    return moved


def parse(text: str) -> Affine:
    """Return the map of a transform attribute; raises UnreadableFile for what is none."""
    found, end = STILL, 0
    for call in _CALL.finditer(text):
        if call.start() != end:
            break
        end = call.end()
        found = after(found, _one(call[1], numbers(call[2], "transform"), text))
    if text[end:].strip(" ,\t\r\n"):
        raise _unknown(text)
    return found


def _one(name: str, values: list[float], text: str) -> Affine:
    count = len(values)
    if name == "matrix" and count == 6:
        a, b, c, d, e, f = values
        return a, b, c, d, e, f
    if name == "translate" and count in {1, 2}:
        return 1.0, 0.0, 0.0, 1.0, values[0], values[1] if count == 2 else 0.0
    if name == "scale" and count in {1, 2}:
        return values[0], 0.0, 0.0, values[-1], 0.0, 0.0
    if name == "rotate" and count in {1, 3}:
        return _rotation(values[0], *values[1:])
    if name == "skewX" and count == 1:
        return 1.0, 0.0, tan(radians(values[0])), 1.0, 0.0, 0.0
    if name == "skewY" and count == 1:
        return 1.0, tan(radians(values[0])), 0.0, 1.0, 0.0, 0.0
    raise _unknown(text)


def _rotation(angle: float, x: float = 0.0, y: float = 0.0) -> Affine:
    c, s = cos(radians(angle)), sin(radians(angle))
    return c, s, -s, c, x - c * x + s * y, y - s * x - c * y


def _unknown(text: str) -> UnreadableFile:
    return UnreadableFile(f"The transform {text.strip()[:60]!r} is none that SVG knows.")
