"""Curves as chords: as many as keep within a share of the curve's own length, at any scale."""

from __future__ import annotations

from itertools import pairwise
from math import acos, ceil, cos, hypot, pi, radians, sin, sqrt, tau

import numpy as np

from foldmill.pattern import Floats

_SHARE = 1 / 2000
"""Of a curve's length that a chord may stray from it: 0.04 mm on a quarter circle of 50 mm."""
_NOTHING = 1e-9
"""A radius or an arc's span below this, in units of the path, is none: its square is no number."""
_MOST = 1000
"""Chords of one curve, whatever it is."""


def bezier(points: Floats) -> Floats:
    """Return the chords' ends (n, 2) of a quadratic or cubic curve, without its begin.

    points : (3, 2) or (4, 2) control points. Of n even chords none strays farther than an eighth of
    the largest second derivative over n².
    """
    order = len(points) - 1
    bend = np.abs(np.diff(points, 2, axis=0)).max() * order * (order - 1) * sqrt(2)
    length = float(np.hypot(*np.diff(points, axis=0).T).sum())
    if length == 0 or not np.isfinite(bend):
        return points[-1:]
    count = min(max(ceil(sqrt(bend / (8 * _SHARE * length))), 1), _MOST)
    t = np.arange(1, count + 1)[:, None] / count
    levels = list(points)
    while len(levels) > 1:  # de Casteljau
        levels = [p * (1 - t) + q * t for p, q in pairwise(levels)]
    chords: Floats = levels[0]
    chords[-1] = points[-1]
    return chords


def turn(
    centre: tuple[float, float], rx: float, ry: float, tilt: float, a: float, b: float
) -> Floats:
    """Return the chords' ends (n, 2) of an ellipse's arc from angle a to b, rad, without its begin.

    tilt : rad by which its first axis is turned.
    """
    sweep = abs(b - a)
    if sweep == 0 or max(rx, ry) == 0:
        step = np.array([b])
    else:
        sagitta = min(_SHARE * sweep, 1.0)
        count = min(max(ceil(sweep / (2 * acos(1 - sagitta))), 1), _MOST)
        step = a + (b - a) * np.arange(1, count + 1) / count
    x, y = rx * np.cos(step), ry * np.sin(step)
    c, s = cos(tilt), sin(tilt)
    with np.errstate(over="ignore", invalid="ignore"):  # what is no number is refused by its reader
        chords: Floats = np.stack([centre[0] + c * x - s * y, centre[1] + s * x + c * y], axis=1)
    return chords


def arc(
    begin: tuple[float, float],
    end: tuple[float, float],
    rx: float,
    ry: float,
    tilt: float,
    large: bool,
    sweep: bool,
) -> Floats:
    """Return the chords' ends of an arc as SVG's path says it (its appendix B.2.4), tilt in deg."""
    rx, ry, phi = abs(rx), abs(ry), radians(tilt)
    dx, dy = (begin[0] - end[0]) / 2, (begin[1] - end[1]) / 2
    if min(rx, ry, hypot(dx, dy)) < _NOTHING:
        return np.array([end], float)
    c, s = cos(phi), sin(phi)
    x, y = c * dx + s * dy, -s * dx + c * dy
    stretch = sqrt(max((x / rx) ** 2 + (y / ry) ** 2, 1.0))
    rx, ry = rx * stretch, ry * stretch
    below = (rx * y) ** 2 + (ry * x) ** 2
    root = sqrt(max((rx * ry) ** 2 - below, 0.0) / below) * (1 if large != sweep else -1)
    u, v = root * rx * y / ry, -root * ry * x / rx
    centre = (
        c * u - s * v + (begin[0] + end[0]) / 2,
        s * u + c * v + (begin[1] + end[1]) / 2,
    )
    a = float(np.arctan2((y - v) / ry, (x - u) / rx))
    b = float(np.arctan2((-y - v) / ry, (-x - u) / rx))
    if sweep and b < a:
        b += tau
    if not sweep and b > a:
        b -= tau
    chords = turn(centre, rx, ry, phi, a, b)
    chords[-1] = end
    return chords


def ellipse(x: float, y: float, rx: float, ry: float) -> Floats:
    """Return the corners (n, 2) of a closed ellipse, the last equal to the first."""
    quarters = [turn((x, y), rx, ry, 0.0, k * pi / 2, (k + 1) * pi / 2) for k in range(4)]
    rim = np.concatenate(quarters)
    closed: Floats = np.concatenate([rim[-1:], rim])
    return closed
