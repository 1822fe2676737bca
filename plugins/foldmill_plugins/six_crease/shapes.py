"""Shapes with ten wedges and nine points; strips 10 mm wide.

The first seven fold flat along the arc without passing through themselves; in the last one a point
reaches the axis soon after the start.
"""

from __future__ import annotations

from foldmill_plugins.six_crease.params import SixCreaseParams, points_of


def _shape(
    heights: str, branches: str, L: float, phi: float, beta: float, n: int = 10
) -> SixCreaseParams:
    points = points_of(heights, branches)
    return SixCreaseParams(n=n, w=10.0, L=L, phi=phi, beta=beta, points=points)


SHAPES = {
    "candlestick": SixCreaseParams(),
    "rugby": _shape("0 14.1 20.7 35.4 41.2 56.5 61.5 77.4 81.7", "-+-++-+", 20.7, 85.3, 346.7),
    "vase": _shape("0 5 24.5 25.9 33.8 36.5 49.7 57.5 67.1", "++-+--+", 22.1, 92.9, 63.7),
    "lampshade": _shape("0 5.8 13.4 19.9 26.6 33.9 39.7 47.6 52.6", "+-+-+-+", 0, 47.5, 75.2),
    "bud": _shape("0 12.1 35.8 46 69.9 79 103.5 108.8 135", "+-+-++-", 0, 75.2, 50.3),
    "ball": _shape("0 6.5 17.5 24.8 33.5 42.1 48.6 58.1 62.8", "-+-++-+", 9.7, 146.9, 345.2),
    "cup": _shape("0 7.7 14.8 23.6 29.5 39.4 44.4 55.3 59.3", "-+-+-+-", 30.7, 164.0, 328.7),
    "vase-interrupted": _shape("0 4.7 14.6 21.3 29.4 41 52.7 63 67.7", "++-+--+", 26.6, 92.9, 56.1),
}
