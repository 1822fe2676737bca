"""Lines that cross, split where they do: against the noding of GEOS, and what is refused.

    python benchmarks/crossings.py

For lines across a sheet of 400 mm, all of one kind, in a grid and at random: crossings, pieces,
seconds (median of three) of ``planarise`` and of shapely's ``node``, which splits but joins no near
ends, keeps no kinds and tells nothing; seconds per 10,000 crossings, which stay alike where the
work grows with the crossings. Then how long it takes to refuse a million crossings, and the
greatest memory of the whole run.
"""

from __future__ import annotations

import resource
import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from foldmill.errors import InvalidPattern
from foldmill.planarise import planarise

Floats = NDArray[np.float64]
MOST = 200_000
"""Pieces up to which drawings are read."""


def across(left: Floats, right: Floats) -> Floats:
    """Return lines (n, 2, 2) from the left side of the sheet to the right one, mm."""
    zero, wide = np.zeros(len(left)), np.full(len(left), 400.0)
    return np.stack([np.stack([zero, left], axis=1), np.stack([wide, right], axis=1)], axis=1)


def at_random(count: int) -> Floats:
    """Return lines that cross a quarter of count² times."""
    return across(*np.random.default_rng(count).uniform(0, 400, (2, count)))


def grid(count: int) -> Floats:
    """Return half as many lines across as there are, and as many up."""
    levels = 400 * (np.arange(count // 2) + 0.5) / (count // 2)
    level = across(levels, levels)
    return np.concatenate([level, level[:, :, ::-1]])


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """Return what a function returns, and the median of its seconds in three runs."""
    seconds = []
    found = None
    for _ in range(3):
        begun = time.perf_counter()
        found = work()
        seconds.append(time.perf_counter() - begun)
    return found, median(seconds)


def row(title: str, lines: Floats) -> None:
    """Print one line."""
    found, own = timed(lambda: planarise(lines, most=MOST))
    drawn = shapely.multilinestrings(shapely.linestrings(lines))
    _, peer = timed(lambda: shapely.node(drawn))
    crossings = (len(found.edges) - len(lines)) // 2
    print(
        f"{title:12} {crossings:7,} crossings {len(found.edges):8,} pieces   planarise {own:6.2f} s"
        f"   node {peer:6.2f} s   ratio {own / peer:5.2f}   {1e4 * own / crossings:5.2f} s / 10,000"
    )


def refused(count: int) -> None:
    """Print how long it takes to refuse so many lines."""
    begun = time.perf_counter()
    try:
        planarise(at_random(count), most=MOST)
    except InvalidPattern as error:
        print(f"{time.perf_counter() - begun:6.2f} s: {error}")


def main() -> None:
    """Print the table."""
    for count in (100, 200, 400, 600):
        row(f"grid {count}", grid(count))
    for count in (100, 200, 400):
        row(f"random {count}", at_random(count))
    refused(2000)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(f"greatest memory {peak:.0f} MB")


if __name__ == "__main__":
    main()
