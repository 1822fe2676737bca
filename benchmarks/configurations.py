"""How many tubes of six-crease bases a core solves and tests for penetration in a second.

    python benchmarks/configurations.py [ROWS]

Each row of the first table is one preset over a seeded grid of ROWS (default 200,000) different
(r_1, β): r_1 from 0 to where P_2 has no place, β all round. Every configuration is solved, its
box measured, and its half wedge tested by the exact rule; none is counted twice. Columns:

free, hits, lost, axis   shares of outcomes: free, penetrating, a point without a place, both sides
                         of the axis; "hits" and "lost" end early, so that a mix is faster
compiled   million configurations a second with numba; median of the rounds, and the slowest
NumPy      the same without numba, over columns
ratio      of both, in the same rounds

*free* takes only configurations that are free, which no test can end early; *even* takes as many of
each outcome as of any other, from tubes of all presets with branches at random.

The second table is the whole way through ``batch`` (bounds, sorting out, figures of each row): with
every (r_1, β) once, and with each by ten pairs of φ and L, where it is computed once. "one by one"
is generate and check of the same rows: what a family without a batch takes.

The last lines are the start of a new process up to the first verdict, compiled however few there
are to judge: with nothing kept from
before, and with what the process before has kept. All on one core, one thread, in seconds of
processor time, so that other work on the machine does not count.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from statistics import median
from typing import Any

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})

import numpy as np  # noqa: E402

from foldmill.axisymmetric.rows import Rows  # noqa: E402
from foldmill.configurations import one_by_one, outcomes, with_values  # noqa: E402
from foldmill.kernels import Limits, Strips, columns, is_compiling, strips  # noqa: E402
from foldmill.kernels.judging import judge_with  # noqa: E402
from foldmill_plugins.six_crease import DESIGN, solve  # noqa: E402
from foldmill_plugins.six_crease.batch import prepare  # noqa: E402
from foldmill_plugins.six_crease.params import SixCreaseParams  # noqa: E402

ROUNDS = 5
ROWS = int(sys.argv[1]) if len(sys.argv) > 1 else 200_000
FIRST = """
import time
import foldmill.kernels.judging
foldmill.kernels.judging.COMPILED_FROM = 0
began = time.process_time()
from foldmill.configurations import outcomes
from foldmill_plugins.six_crease import DESIGN
import numpy as np
ready = time.process_time()
outcomes(DESIGN, DESIGN.params(), {"beta": np.array([292.9, 200.0])})
print(ready - began, time.process_time() - ready)
"""


def upright(name: str) -> SixCreaseParams:
    """Return a preset with φ = 90°, where r_1 is L."""
    return with_values(DESIGN, DESIGN.preset(name), {"phi": 90.0, "L": 0.0})


def grid(base: SixCreaseParams, count: int, seed: int) -> dict[str, np.ndarray]:
    """Return a jittered grid over (r_1, β) as columns L and beta."""
    rng, side = np.random.default_rng(seed), int(np.ceil(np.sqrt(count)))
    place = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    share = (rng.permutation(place)[:count] + rng.random((count, 2))) / side
    return {"L": share[:, 0] * solve.longest(base) * (1 - 1e-9), "beta": 360 * share[:, 1]}


def strips_of(base: SixCreaseParams, given: dict[str, np.ndarray]) -> Strips:
    """Return the rows as the kernels take them."""
    task = prepare(Rows(base, given))
    assert task is not None
    return task.strips


def picked(made: Strips, rows: np.ndarray) -> Strips:
    """Return ROWS of some rows, all of them equally often, in a seeded order."""
    return made.take(np.random.default_rng(5).permutation(np.resize(rows, ROWS)))


def even() -> Strips:
    """Return as many of each outcome as of any other, from all presets with random branches."""
    rng, count = np.random.default_rng(6), 4 * ROWS
    names = list(DESIGN.presets)
    parts = [strips_of(base, grid(base, count // len(names), 7)) for base in map(upright, names)]
    papers = [np.broadcast_to(part.paper, (len(part), *part.paper.shape[1:])) for part in parts]
    start = np.concatenate([part.start for part in parts])
    signs = rng.choice([-1.0, 1.0], (len(start), parts[0].branches.shape[1]))
    made = Strips(parts[0].order, start, np.concatenate(papers), signs, is_first_on_l2=False)
    codes = judge_with(LOOPS[0], made, Limits()).codes
    rows = [np.resize(np.flatnonzero(codes == code), ROWS // 4) for code in range(4)]
    return picked(made, np.concatenate(rows))


def seconds(work: Callable[[], object]) -> float:
    """Return how much of the processor's time a call takes."""
    began = time.process_time()
    work()
    return time.process_time() - began


def rate(loop: Any, made: Strips) -> float:
    """Return how many million strips a second one form of the kernel judges."""
    return len(made) / seconds(lambda: judge_with(loop, made, Limits())) / 1e6


LOOPS: list[Any] = [strips.judge, columns.judge] if is_compiling() else [columns.judge]


def measure(label: str, made: Strips) -> None:
    """Print one row of the first table."""
    found = judge_with(LOOPS[0], made, Limits())
    mix = "".join(f"{100 * np.mean(found.codes == code):6.1f}" for code in (0, 1, 2, 3))
    rounds = [[rate(loop, made) for loop in LOOPS] for _ in range(ROUNDS)]
    rates = list(zip(*rounds, strict=True))
    said = f"{median(rates[0]):9.2f} {min(rates[0]):8.2f}"
    if len(LOOPS) > 1:
        ratios = [one / two for one, two in zip(*rates, strict=True)]
        said += f" {median(rates[1]):9.2f} {median(ratios):7.1f}"
    print(f"{label:17}{mix}  {said}")


def whole_way() -> None:
    """Print the second table."""
    base = upright("candlestick")
    given = grid(base, ROWS, 9)
    once = grid(base, ROWS // 10, 8)
    phi = np.tile([30, 45, 60, 75, 90, 105, 120, 135, 150, 165.0], ROWS // 10)
    beta, r = (np.repeat(once[name], 10) for name in ("beta", "L"))
    tenfold = {"L": r / np.sin(np.radians(phi)), "phi": phi, "beta": beta}
    few = {name: column[:200] for name, column in tenfold.items()}
    cases: list[tuple[str, int, Callable[[], object]]] = [
        ("each once", ROWS, lambda: outcomes(DESIGN, base, given)),
        ("ten of each", ROWS // 10 * 10, lambda: outcomes(DESIGN, base, tenfold)),
        ("one by one", 200, lambda: one_by_one(DESIGN, base, few)),
    ]
    for label, count, work in cases:
        rates = [count / seconds(work) for _ in range(3 if count < 1000 else ROUNDS)]
        print(f"{label:17}{median(rates):14,.0f} rows/s, slowest {min(rates):,.0f}")


def starts() -> None:
    """Print how long a new process takes to its first verdict."""
    with tempfile.TemporaryDirectory() as folder:
        for label, extra in (
            ("nothing kept", {"NUMBA_CACHE_DIR": folder}),
            ("kept before", {"NUMBA_CACHE_DIR": folder}),
            ("without numba", {"FOLDMILL_NO_JIT": "1"}),
        ):
            rounds = 1 if label == "nothing kept" else 5
            runs = [_first_verdict(extra) for _ in range(rounds)]
            imported, judged = (median(column) for column in zip(*runs, strict=True))
            print(
                f"{label:17}{judged:6.2f} s to the first verdict, after {imported:.2f} s of imports"
            )


def _first_verdict(extra: dict[str, str]) -> list[float]:
    run = subprocess.run(
        [sys.executable, "-c", FIRST],
        env=os.environ | extra,
        capture_output=True,
        text=True,
        check=True,
    )
    return [float(word) for word in run.stdout.split()]


def main() -> None:
    """Print the tables."""
    head = "" if len(LOOPS) > 1 else "   (numba is not installed: all is NumPy)"
    print(f"{'M/s on one core':17}{'free':>6}{'hits':>6}{'lost':>6}{'axis':>6}", end="")
    print(f"{'compiled':>11}{'slowest':>9}{'NumPy':>10}{'ratio':>8}{head}")
    for name in DESIGN.presets:
        base = upright(name)
        measure(name, strips_of(base, grid(base, ROWS, 1)))
    measure("even", even())
    base = upright("candlestick")
    made = strips_of(base, grid(base, 4 * ROWS, 2))
    free = np.flatnonzero(judge_with(LOOPS[0], made, Limits()).codes == 0)
    measure("free", picked(made, free))
    print("\nthrough batch")
    whole_way()
    print("\nstart")
    starts()


if __name__ == "__main__":
    main()
