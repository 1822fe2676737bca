"""How many random edits of a stool the automatic placement of tucks solves.

    python benchmarks/tucks.py [SINGLE] [DOUBLE]

SINGLE (default 250) edits move P_4 of the eight-footed stool anywhere; DOUBLE (default 100) edits
move P_5 and P_7 of a random rotational form, so that both share one blank. Only edits with a valid
pattern count, whose surface does not pass through itself before there is any flap, and whose points
lie at least 2 mm inside their lines: less is no paper to fold. Columns:

solved      a place of the flap where it passes through nothing
too short   the blank's ends are farther apart in space than in the pattern: no flap exists
no place    there are flaps, and none that was tried is free
inside, outside, flush   where the solved ones lie
ms          median and longest time of one edit
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from statistics import median

import numpy as np

from foldmill import InvalidInput
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.axisymmetric.rosette import HalfWedge
from foldmill.check.intersection import penetrations
from foldmill_plugins.tuck import DESIGN
from foldmill_plugins.tuck.generate import generate
from foldmill_plugins.tuck.params import TuckParams


@dataclass
class Outcome:
    """What became of a set of edits."""

    counts: Counter[str] = field(default_factory=Counter)
    seconds: list[float] = field(default_factory=list)
    unsolved: list[TuckParams] = field(default_factory=list)


def single(count: int, seed: int = 1) -> Iterator[TuckParams]:
    """Yield stools with P_4 somewhere else, a blank beside it."""
    rng, stool = np.random.default_rng(seed), DESIGN.preset("stool-n8")
    while count:
        spot = FreePoint(r=float(rng.uniform(40, 170)), z=float(rng.uniform(-140, 0)))
        params = TuckParams(n=stool.n, phi=stool.phi, points={**stool.points, 4: spot})
        if _blanks(params) == (4,):
            count -= 1
            yield params


def double(count: int, seed: int = 2) -> Iterator[TuckParams]:
    """Yield forms with a blank of two points, P_5 and P_7, between P_3 and P_9."""
    rng = np.random.default_rng(seed)
    while count:
        params = _tower(rng)
        if _blanks(params) == (5, 7):
            count -= 1
            yield params


def _tower(rng: np.random.Generator) -> TuckParams:
    """Return a random rotational form of nine points, P_5 and P_7 moved by up to 25 mm."""
    n, phi = int(rng.integers(5, 11)), float(rng.uniform(60, 120))
    a = np.cumsum(rng.uniform(20, 45, 9)) + 30
    branches = rng.choice([-1, 1], 9)
    spots: dict[int, LinePoint | FreePoint] = {
        i: LinePoint.model_validate({"a": a[i - 1], "branch": int(branches[i - 1])})
        for i in range(1, 10)
    }
    for i in (5, 7):
        step = rng.uniform(-25, 25, 2)
        try:
            r, z = strip.solve(n, phi, spots).meridian[i] + step
        except InvalidInput:
            break
        spots[i] = FreePoint(r=float(r), z=float(z))
    return TuckParams(n=n, phi=phi, points=spots)


def _blanks(params: TuckParams) -> tuple[int, ...]:
    """Return the points off their lines; none where the form is no edit that counts."""
    try:
        solved = strip.solve(params.n, params.phi, dict(params.points))
    except InvalidInput:
        return ()
    if not solved.off_line or min(_beside(solved, i) for i in solved.off_line) < 2:
        return ()
    form = rosette.assemble(HalfWedge.of(solved))
    return () if len(penetrations(form.spatial, form.edges, form.faces)) else solved.off_line


def _beside(solved: strip.Strip, i: int) -> float:
    """Return how far a point lies inside its line, mm."""
    x, y = solved.flat[i]
    angle = solved.theta if i % 2 == 0 else 0.0
    return float(abs(y * np.cos(angle) - x * np.sin(angle)))


def measure(edits: Iterator[TuckParams]) -> Outcome:
    """Fold every edit, and sort what comes of it."""
    out = Outcome()
    for params in edits:
        start = time.perf_counter()
        try:
            fold = generate(params)
        except InvalidInput as error:
            kind = "too short" if "too short" in str(error) else "no place"
            if kind == "no place":
                out.unsolved.append(params)
            out.counts[kind] += 1
        else:
            out.counts["solved"] += 1
            out.counts[fold.meta["tucks"][0]["lies"]] += 1
        out.seconds.append(time.perf_counter() - start)
    return out


COLUMNS = ("solved", "too short", "no place", "inside", "outside", "flush")


def main(singles: int = 250, doubles: int = 100) -> None:
    """Print both tables."""
    print(f"{'edits':24}" + "".join(f"{name:>10}" for name in COLUMNS) + "        ms")
    for name, edits, count in (
        ("one point off its line", single(singles), singles),
        ("two points", double(doubles), doubles),
    ):
        out = measure(edits)
        row = "".join(f"{out.counts[column]:10}" for column in COLUMNS)
        times = f"{1e3 * median(out.seconds):8.0f} / {1e3 * max(out.seconds):.0f}"
        print(f"{count:4} {name:19}{row}{times}")


if __name__ == "__main__":
    main(*(int(each) for each in sys.argv[1:3]))
