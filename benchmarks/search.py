"""Does the search find a stool of its own in under two minutes on two cores, and other forms?

    python benchmarks/search.py [EVALUATIONS]

Each row is one search with the default effort (or EVALUATIONS) on two processes. Columns:

s           seconds from start to results, by the clock; what else the machine does is in it
CPU s       processor seconds of all processes together: half of it is the time on two idle cores
ms          processor milliseconds per form that is folded and measured
met         how many of the five results meet every target within 1 %
error       of the best one: how far all targets are missed, added up, in shares of their values
start       the same for the nearest preset when it is merely resized: what a search has to beat;
            - where no resized preset folds on the sheet
"""

from __future__ import annotations

import os
import sys
import time
from dataclasses import replace

from foldmill import installed
from foldmill_fabricate.explore.search import Request, Target, search
from foldmill_fabricate.explore.search.fit import Room
from foldmill_fabricate.explore.search.island import settle
from foldmill_fabricate.explore.search.request import EVALUATIONS
from foldmill_fabricate.explore.search.score import Judge
from foldmill_fabricate.explore.search.starts import frames

SEARCHES: tuple[tuple[str, str, tuple[float, float], dict[str, float]], ...] = (
    ("tuck", "height=150 width=220", (500, 500), {}),
    ("tuck", "height=180 width=250", (600, 600), {}),
    ("tuck", "height=150 seat=200", (500, 500), {"n": 6.0}),
    ("tuck", "height=120 seat=180", (500, 500), {"n": 7.0}),
    ("rotational", "height=80 width=200", (500, 500), {}),
    ("six-crease", "height=120 width=70", (500, 500), {}),
)


def _seconds() -> float:
    """Return the processor seconds of this process and of those that have ended."""
    spent = os.times()
    return spent.user + spent.system + spent.children_user + spent.children_system


def _floor(family: str, request: Request) -> float | None:
    """Return the least error of any preset that is merely resized."""
    judge = Judge(installed().design(family), request)
    errors = []
    for number, frame in enumerate(frames(judge.design, request)):
        for member in settle(judge, number, frame, 1).found:
            errors += [judge.distance(figures) for figures in [member.verdict.figures] if figures]
    return min(errors, default=None)


def measure(family: str, targets: str, sheet: tuple[float, float], request: Request) -> str:
    """Search once; return the row."""
    from joblib.externals.loky import get_reusable_executor

    floor = _floor(family, request)
    start, spent = time.perf_counter(), _seconds()
    outcome = search(installed().design(family), request, jobs=2)
    took = time.perf_counter() - start
    get_reusable_executor().shutdown(wait=True)  # so that its processor time is counted
    spent = _seconds() - spent
    met = sum(not each.missed for each in outcome.results)
    error = f"{100 * outcome.results[0].error:.3f} %" if outcome.results else "-"
    given = "".join(f" {name}={value:g}" for name, value in request.fixed.items())
    name = f"{family} {targets}{given} on {sheet[0]:g} × {sheet[1]:g}"
    least = "-" if floor is None else f"{100 * floor:.2f} %"
    each = 1e3 * spent / outcome.evaluations
    return f"{name:48}{took:6.0f}{spent:7.0f}{each:7.1f}{met:5}{error:>10}{least:>9}"


def main(evaluations: int = EVALUATIONS) -> None:
    """Print the table."""
    titles = ("s", "CPU s", "ms", "met", "error", "start")
    widths = (6, 7, 7, 5, 10, 9)
    print(" " * 48 + "".join(f"{t:>{w}}" for t, w in zip(titles, widths, strict=True)), flush=True)
    for family, targets, sheet, fixed in SEARCHES:
        wanted = tuple(Target.read(text) for text in targets.split())
        request = Request(wanted, Room(*sheet, 1.0), 4.5, fixed=fixed)
        request = replace(request, evaluations=evaluations)
        print(measure(family, targets, sheet, request), flush=True)


if __name__ == "__main__":
    main(*(int(each) for each in sys.argv[1:2]))
