"""How long a dragged point takes: from the moved handle to pattern, form, M/V and the full check.

    python benchmarks/drag.py [DRAGS] [PRESET]

A handle of the tucked stool (PRESET, default stool-n8) is taken at random and moved by up to 6 mm
along its locus, until DRAGS (default 100) of them gave a fold; moves that the family refuses are
timed apart. Each is timed five times, the least taken, in seconds of this process (it is the only
one at work), so that what else the machine does is left out. Rows:

drag + generate   Handle.drag, then Design.run: pattern, folded form, mountains and valleys, handles
check             every rule of ``foldmill.check`` over the result
both              their sum; a page at 60 pictures a second has 16.7 ms for this and for drawing
refused           from the moved handle to the sentence
floor             the bare numbers in NumPy: boxes, sides of planes and fold angles of one form,
                  without a rule, a sentence or a search

Then the medians of both by handle: those that leave a second blank search for a place of its flap.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from statistics import median

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold, InvalidInput, Params
from foldmill.check import check
from foldmill.folded import fold_angles
from foldmill.handle import Circle, Handle, Line, Plane
from foldmill_plugins.tuck import DESIGN
from foldmill_plugins.tuck.params import TuckParams

Floats = NDArray[np.float64]

STEP_MM = 6.0
REPEATS = 5


def moved(handle: Handle, rng: np.random.Generator) -> Floats:
    """Return where the pointer takes a handle: up to STEP_MM along its locus."""
    locus, (one, two) = handle.locus, rng.uniform(-STEP_MM, STEP_MM, 2)
    if isinstance(locus, Line):
        spot: Floats = handle.position + one * locus.along
    elif isinstance(locus, Plane):
        spot = handle.position + one * locus.u + two * locus.v
    else:
        spot = _round(locus, handle.position, one)
    return spot


def _round(locus: Circle, position: Floats, step: float) -> Floats:
    angle = locus.angle(position) + step / max(locus.radius, STEP_MM)
    spot: Floats = locus.centre + locus.radius * (np.cos(angle) * locus.u + np.sin(angle) * locus.v)
    return spot


def drags(preset: str, seed: int = 6) -> Iterator[tuple[TuckParams, Handle, Floats]]:
    """Yield, without end, the parameters before, a handle, and the point it is moved to."""
    rng, params = np.random.default_rng(seed), DESIGN.preset(preset)
    handles = DESIGN.run(params).handles
    while True:
        handle = handles[int(rng.integers(len(handles)))]
        yield params, handle, moved(handle, rng)


@dataclass
class Times:
    """ms of each drag."""

    generate: list[float] = field(default_factory=list)
    check: list[float] = field(default_factory=list)
    both: list[float] = field(default_factory=list)
    refused: list[float] = field(default_factory=list)
    floor: list[float] = field(default_factory=list)
    by_handle: dict[str, list[float]] = field(default_factory=dict)

    def add(self, params: Params, handle: Handle, point: Floats) -> None:
        """Time one drag."""

        def drag() -> Fold:
            return DESIGN.run(handle.drag(params, point))

        try:
            fold = drag()
        except InvalidInput:
            self.refused.append(_least(lambda: _to_sentence(drag)))
            return
        # A fold remembers what was asked of it: each check gets one that was not asked before.
        fresh = iter([drag() for _ in range(REPEATS)])
        self.generate.append(_least(drag))
        self.check.append(_least(lambda: check(next(fresh))))
        self.both.append(self.generate[-1] + self.check[-1])
        self.floor.append(_least(lambda: _bare(fold)))
        self.by_handle.setdefault(handle.name, []).append(self.both[-1])


def _to_sentence(drag: Callable[[], Fold]) -> None:
    with suppress(InvalidInput):
        drag()


def _least(work: Callable[[], object]) -> float:
    found = []
    for _ in range(REPEATS):
        start = time.process_time()
        work()
        found.append(1e3 * (time.process_time() - start))
    return min(found)


def _bare(fold: Fold) -> None:
    pattern, folded = fold.pattern, fold.folded
    assert folded is not None
    points, faces = folded.vertices, pattern.faces
    fold_angles(points, pattern.edges, faces, pattern.edge_faces)
    corners = points[faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    near = ((low[:, None] <= high) & (high[:, None] >= low)).all(axis=2)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    height = points @ normal.T - (normal * corners[:, 0]).sum(axis=1)
    across = (height[faces].min(axis=1) < 0) & (height[faces].max(axis=1) > 0)
    np.count_nonzero(near & across & across.T)


def main(count: int = 100, preset: str = "stool-n8") -> None:
    """Print both tables."""
    times = Times()
    for params, handle, point in drags(preset):
        times.add(params, handle, point)
        if len(times.both) == count:
            break
    print(f"{preset}: {count} drags, {len(times.refused)} more refused by the family")
    print(f"{'ms':20}{'median':>8}{'p95':>8}{'longest':>9}")
    rows = {"drag + generate": times.generate, "check": times.check, "both": times.both}
    for name, found in {**rows, "refused": times.refused, "floor": times.floor}.items():
        if found:
            low, high = np.percentile(found, (50, 95))
            print(f"{name:20}{low:8.2f}{high:8.2f}{max(found):9.2f}")
    print(f"both / floor: {median(times.both) / median(times.floor):.1f}")
    for name, found in sorted(times.by_handle.items()):
        print(f"  {name:18}{median(found):8.2f}   {len(found)} drags")


if __name__ == "__main__":
    main(int((sys.argv[1:2] or ["100"])[0]), (sys.argv[2:3] or ["stool-n8"])[0])
