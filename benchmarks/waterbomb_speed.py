"""How long the search of waterbomb tessellations takes: beside a dense one, and as they grow.

Used by ``benchmarks/waterbomb.py``, which writes both tables into its page.
"""

from __future__ import annotations

import os
import platform
import resource
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.build import E_TOTAL, Build
from foldmill_plugins.waterbomb.linear import Factorised
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.solve import Developed, develop, e_total

ROUNDS = 3
PLAIN = {"start": "uniform", "boundary": "fixed", "rim": "outside"}
DENSE_STEPS = 60
SMALL = ("catenoid-8x6", "catenoid", "sphere", "torus")
SIZES = {
    "hyperbolic-paraboloid": [(10, 10), (20, 20), (40, 40), (80, 80), (160, 160), (224, 224)],
    "torus": [(55, 10), (110, 20), (220, 48), (500, 100)],
}


def best(run: Callable[[], Any], rounds: int = ROUNDS) -> tuple[float, Any]:
    """Return the shortest time in seconds, and what the last run gave."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        found = run()
        times.append(time.perf_counter() - start)
    return min(times), found


def solved(params: WaterbombParams) -> Developed:
    """Make start and base mesh, and search."""
    return Build(params).developed


def floor(build: Build) -> float:
    """Return the seconds of assembly, J Jᵀ and a factorisation with its solution."""

    def once() -> None:
        residual, jacobian = build.stars.linearised(build.base)
        gram = (jacobian @ jacobian.T).tocsc()
        Factorised().solve(gram, 1e-13 * float(gram.diagonal().mean()), residual)

    return best(once)[0]


def dense(build: Build) -> tuple[float, int]:
    """Solve by Levenberg-Marquardt with a dense Jacobian; return seconds and steps."""
    start, points, damping = time.perf_counter(), build.base, 1e-3
    residual, jacobian = build.stars.linearised(points)
    for step in range(DENSE_STEPS):
        if e_total(residual) <= E_TOTAL:
            return time.perf_counter() - start, step
        full = jacobian.toarray()
        moves = np.linalg.solve(full.T @ full + damping * np.eye(full.shape[1]), full.T @ residual)
        trial = build.stars.moved(points, -moves)
        after = build.stars.residual(trial)
        if after @ after < residual @ residual:
            points, damping = trial, max(damping / 10, 1e-15)
            residual, jacobian = build.stars.linearised(points)
        else:
            damping *= 10
    return time.perf_counter() - start, DENSE_STEPS


def peers() -> str:
    """Return the Markdown table of the search beside its floor and beside the dense one."""
    lines = [
        "| surface | bases | search ms | floor ms | in floors | dense ms | dense steps | times |",
        "|" + "---|" * 8,
    ]
    for name in SMALL:
        build = Build(DESIGN.presets[name].model_copy(update=PLAIN))
        build.base, build.stars.centre  # noqa: B018 - made before the clock runs
        quick, _ = best(lambda build=build: develop(build.stars, build.base, E_TOTAL, 40))  # type: ignore[misc]
        least, (slow, steps) = floor(build), dense(build)
        bases = build.params.n_u * build.params.n_v
        lines.append(
            f"| {name} | {bases} | {1e3 * quick:.1f} | {1e3 * least:.1f} | {quick / least:.1f} "
            f"| {1e3 * slow:.0f} | {steps} | {slow / quick:.0f} |"
        )
    return "\n".join(lines)


def timed(kind: str, n_u: int, n_v: int) -> tuple[float, int, float, float]:
    """Return seconds, iterations, e_total and MB of one search, in a process of its own."""
    params = DESIGN.validate({"surface": {"kind": kind}, "n_u": n_u, "n_v": n_v})
    solved(DESIGN.presets["catenoid-8x6"])  # whatever is loaded once is loaded
    seconds, found = best(lambda: solved(params), 1 if n_u * n_v > 20_000 else ROUNDS)
    return seconds, found.iterations, found.error, most_memory()


def most_memory() -> float:
    """Return the most MB this process held; what getrusage says may be its parent's."""
    try:
        text = Path("/proc/self/status").read_text(encoding="utf-8")
        return float(next(line for line in text.splitlines() if "VmHWM" in line).split()[1]) / 1e3
    except (OSError, StopIteration):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def growth(largest: int) -> str:
    """Return the Markdown table of how the search grows, without and with symmetry to help."""
    lines = ["| surface | bases | search s | it | e_total ° | exponent | MB |", "|" + "---|" * 7]
    for kind, sizes in SIZES.items():
        before: tuple[int, float] | None = None
        for n_u, n_v in [each for each in sizes if each[0] * each[1] <= 1.01 * largest]:
            with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as alone:
                seconds, steps, error, used = alone.submit(timed, kind, n_u, n_v).result()
            bases = n_u * n_v
            slope = np.log(seconds / before[1]) / np.log(bases / before[0]) if before else None
            before = (bases, seconds)
            lines.append(
                f"| {kind} {n_u} × {n_v} | {bases} | {seconds:.3g} | {steps} | {error:.0e} "
                f"| {'' if slope is None else f'{slope:.2f}'} | {used:.0f} |"
            )
    return "\n".join(lines)


def machine() -> str:
    """Return what the figures were taken on."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
        model = next(line for line in text.splitlines() if line.startswith("model name"))
        name = " ".join(model.split(":")[1].split())
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return (
        f"{name}, {os.cpu_count()} cores, Python {platform.python_version()}, "
        f"NumPy {np.__version__}, SciPy {scipy.__version__}"
    )


SPEED = """
## How long it takes

Figures of one machine ({machine}),
the shortest of three rounds; other programs may have run beside them, so that ratios say more than
times. All rows of Table 6.3 together are solved in {total:.2f} s.

*search*: Gauss-Newton of the thesis' own problem, to 1e-10°. *floor*: assembly, J Jᵀ and one
factorisation with its solution, what each step costs at least. *dense*: Levenberg-Marquardt with a
dense Jacobian of the same problem, as the benchmark has it; *times*: how many times as long.

{peers}

How the search of the defaults grows, each in a process of its own: *exponent*, of the time over the
bases, since the row before; *MB*, the most memory that process held, with Python and its libraries.
A surface of revolution is searched by one sector. The largest are timed by
`python benchmarks/waterbomb.py docs/waterbomb-tables.md 50000`.

{growth}
"""


def section(total: float, largest: int) -> str:
    """Return the page's part about speed; total : seconds of the rows of Table 6.3."""
    return SPEED.format(machine=machine(), total=total, peers=peers(), growth=growth(largest))
