"""The matching of hops: among near ends, and proved to be the shortest of all.

    python benchmarks/matching.py

For ends scattered over 500 × 500 mm, and the odd vertices of a Miura sheet of 9,940 creases: mm in
all of the matching among the twelve nearest and of the proved one, what nearest distances alone
bound it by, and the time of both (median of three; the proof of 2,000 ends once).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import hops, proven

Floats = NDArray[np.float64]


def scattered(count: int) -> Floats:
    """Return random ends (count, 2), mm."""
    return np.random.default_rng(count).uniform(0, 500, (count, 2))


def miura_rim(rows: int, columns: int) -> Floats:
    """Return the odd vertices of a Miura sheet: those on its rim but the corners."""
    x, y = np.meshgrid(np.linspace(0, 500, columns + 1), np.linspace(0, 500, rows + 1))
    y = y + 2.0 * (np.arange(columns + 1) % 2)
    inner = np.ones(x.shape, bool)
    inner[1:-1, 1:-1] = inner[0, 0] = inner[0, -1] = inner[-1, 0] = inner[-1, -1] = False
    return np.stack([x[inner], y[inner]], axis=1)


def timed(work: Callable[[], Any], runs: int) -> tuple[Any, float]:
    """Return what a function returns, and the median of its seconds."""
    seconds = []
    found = None
    for _ in range(runs):
        begun = time.perf_counter()
        found = work()
        seconds.append(time.perf_counter() - begun)
    return found, median(seconds)


def row(title: str, ends: Floats, runs: int) -> None:
    """Print one line."""
    places = np.vstack([ends, [np.nan, np.nan], [0.0, 0.0]])
    (_, near), quick = timed(lambda: hops.match(places), runs)
    found, slow = timed(lambda: proven.match(places), runs)
    sure = "proved" if found.bound == found.length else f"gap {found.length - found.bound:.1f} mm"
    print(
        f"{title:22} near {near:9.2f} mm {quick:6.2f} s   all {found.length:9.2f} mm {slow:6.2f} s "
        f"{sure}, {100 * (near / found.length - 1):.3f} % shorter, "
        f"floor {proven.least(places):8.1f} mm"
    )


if __name__ == "__main__":
    row("warm", scattered(120), 1)
    row("Miura 70 × 70", miura_rim(70, 70), 3)
    for number in (276, 500, 1000, 2000):
        row(f"{number} scattered", scattered(number), 1 if number == 2000 else 3)
