"""How well strokes are ordered, beside vpype, exact optima and lower bounds, in one run.

    python benchmarks/toolpath.py [miura] [setback] [random] [trailing] [growth]

All sections without arguments. vpype (MIT) is installed into a throw-away virtual environment and
runs `linemerge linesort --two-opt`; where pip cannot install it, its rows say so. Times are medians
of three runs: `s` processor seconds of ordering alone, both programs loaded and ours compiled by an
earlier process, `whole` of the clock for the command with start and import. Sections:

miura     9,940 creases that touch: strokes and travel beside the exact optimum, and vpype's
setback   the same creases, each 0.75 mm short of both its ends: separate strokes
random    500 and 1,000 separate lines: travel above the bound of Held and Karp
trailing  machine time of a knife: lifts where they pay, beside all lifts, none, and Euler's way
growth    a tessellation of up to 200,000 creases: s, memory, and the exponent of both
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, installed
from foldmill.planarise import planarise
from foldmill_fabricate.machines import Machine, Motion
from foldmill_fabricate.toolpath import corners, motion, order, sequence
from foldmill_fabricate.toolpath.bounds import travel_bound
from foldmill_fabricate.toolpath.routing import route

Floats = NDArray[np.float64]
Graph = tuple[Floats, NDArray[np.intp]]

RUNS = 3
SPEED = 120.0
"""mm/s with the tool down."""
PEER = """
import json, sys, time
import numpy as np, vpype as vp
from vpype_cli import execute
doc = vp.Document()
doc.add(vp.LineCollection([row[:, 0] + 1j * row[:, 1] for row in np.load(sys.argv[1])]), 1)
start = time.process_time()
doc = execute("linemerge linesort --two-opt", doc)
seconds = time.process_time() - start
lines = doc.layers[1]
print(json.dumps([len(lines), lines.pen_up_length()[0], seconds]))
"""


def miura(rows: int, columns: int, size: float = 500.0) -> Graph:
    """Return a Miura sheet with its outline: 2·rows·columns + rows + columns edges."""
    x, y = np.meshgrid(np.linspace(0, size, columns + 1), np.linspace(0, size, rows + 1))
    y = y + 0.3 * size / rows * (np.arange(columns + 1) % 2)
    number = np.arange(x.size).reshape(x.shape)
    across = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1)
    along = np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1)
    return np.stack([x.ravel(), y.ravel()], axis=1), np.vstack([across, along])


def waterbomb(rows: int, columns: int, cell: float = 15.0) -> Graph:
    """Return a grid of waterbomb bases: squares with both diagonals, every other row shifted."""
    lines = []
    for i in range(rows):
        for j in range(columns):
            x, y = cell * (j + (i % 2) / 2), cell * i
            a, b, c, d = (x, y), (x + cell, y), (x + cell, y + cell), (x, y + cell)
            lines += [(a, b), (b, c), (c, d), (d, a), (a, c), (b, d)]
    found = planarise(np.array(lines))
    return found.points, found.edges


def random_planar(vertices: int, share: float = 0.6, seed: int = 3) -> Graph:
    """Return part of the triangulation of random points."""
    from scipy.spatial import Delaunay

    rng = np.random.default_rng(seed)
    points = 500 * rng.random((vertices, 2))
    sides = Delaunay(points).simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    edges = np.unique(np.sort(sides, axis=1), axis=0)
    return points, edges[rng.random(len(edges)) < share].astype(np.intp)


def stool() -> Graph:
    """Return the creases of the stool."""
    design = installed().design("tuck")
    pattern = design.run(design.preset("stool-n8")).pattern
    creases = np.isin(pattern.assignments, (Assignment.M, Assignment.V))
    return pattern.vertices, pattern.edges[creases]


def random_lines(count: int) -> Floats:
    """Return separate lines (n, 2, 2) of up to 12 mm on a sheet of 500 mm."""
    rng = np.random.default_rng(count)
    middle, angle = 500 * rng.random((count, 2)), 2 * np.pi * rng.random(count)
    half = 6 * rng.random((count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.stack([middle - half, middle + half], axis=1)


def peer_python() -> Path | None:
    """Return an interpreter that has vpype, installed on the first run; None where pip cannot."""
    folder = Path(tempfile.gettempdir()) / "foldmill-peer-vpype"
    python = folder / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    command = [str(python), "-m", "pip", "install", "--quiet", "vpype"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return python if done.returncode == 0 else None


def timed(command: list[str | Path]) -> tuple[int, float, float, float]:
    """Return strokes, travel, median s of ordering and of the whole command."""
    rows = []
    for _ in range(RUNS):
        start = time.perf_counter()
        out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        rows.append([*json.loads(out.splitlines()[-1]), time.perf_counter() - start])
    strokes, travel = rows[0][:2]
    return strokes, travel, median(r[2] for r in rows), median(r[3] for r in rows)


def own(segments: Floats) -> tuple[int, float, float]:
    """Order lines as for a pen, planarised first; return strokes, travel and s."""
    _ordered(random_lines(20))  # loads what is compiled and imported late, as the peer's is loaded
    start = time.process_time()
    ways = _ordered(segments)
    seconds = time.process_time() - start
    return len(ways), order.travel(ways, ways[0][0]), seconds


def _ordered(segments: Floats) -> list[Floats]:
    """Return the strokes of a pen over lines, planarised first, in order of work."""
    planar = planarise(segments)
    trails = route(planar.points, planar.edges, None, corners.free_turning()).trails
    return [planar.points[list(trail)] for trail in trails]


def shuffled(segments: Floats) -> Floats:
    """Return lines in no order and no direction, as a drawing program may write them."""
    rng = np.random.default_rng(0)
    lines = rng.permutation(segments)
    back = rng.random(len(lines)) < 0.5
    lines[back] = lines[back, ::-1]
    return lines


def beside_peer(title: str, segments: Floats, bound: float, peer: Path | None) -> None:
    """Print our row, vpype's, and the ratios."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "lines.npy"
        np.save(file, shuffled(segments))
        ours = timed([sys.executable, __file__, "own", file])
        theirs = timed([peer, "-c", PEER, file]) if peer else None
    print(f"{title}: lower bound {bound:.0f} mm")
    for name, row in (("foldmill", ours), ("vpype", theirs)):
        if row is None:
            print(f"  {name:10} not installed: pip could not fetch it")
            continue
        strokes, travel, seconds, whole = row
        above = f"{100 * (travel / bound - 1):+.2f} %"
        print(
            f"  {name:10} {strokes:6} strokes {travel:9.1f} mm {above:>10} above the bound"
            f"{seconds:8.2f} s {whole:8.2f} s whole"
        )
    if theirs is not None:
        parts = [f"{ours[k] / theirs[k]:.2f}" for k in (1, 2, 3)]
        print(f"  ratio      travel {parts[0]}, s {parts[1]}, whole {parts[2]}")


def run_miura() -> None:
    """Print the Miura sheet without setback."""
    points, edges = miura(70, 70)
    found = route(points, edges, None, corners.free_turning())
    odd = int((np.bincount(edges.ravel()) % 2).sum())
    title = f"Miura, {len(edges)} creases, exact: {odd // 2} strokes, {found.bound:.1f} mm"
    beside_peer(title, points[edges], found.bound, peer_python())


def run_setback(back: float = 0.75) -> None:
    """Print the Miura sheet with every crease held back from its ends."""
    points, edges = miura(70, 70)
    lines = points[edges]
    step = lines[:, 1] - lines[:, 0]
    step *= back / np.hypot(*step.T)[:, None]
    lines = np.stack([lines[:, 0] + step, lines[:, 1] - step], axis=1)
    bound = travel_bound(list(lines), None)
    beside_peer(f"Miura, {len(edges)} creases, setback {back} mm", lines, bound, peer_python())
    trails = route(points, edges, None, corners.free_turning()).trails
    number = {tuple(sorted(edge)): k for k, edge in enumerate(edges.tolist())}
    sides = [side for trail in trails for side in pairwise(trail)]
    along = [(number[min(a, b), max(a, b)], bool(a > b)) for a, b in sides]
    hops = sequence.travelled(lines, None, along, returns=False)
    print(f"  order of the undivided graph, with setbacks as hops: {hops:.1f} mm")
    even = sequence.travelled(lines, None, along, returns=True)
    mended = sequence.order(lines, None, returns=True)
    best = sequence.travelled(lines, None, mended, returns=True)
    print(
        f"  two repeats, so that strokes end where they began: {even:.1f} mm in that order, "
        f"{best:.1f} mm with the pieces ordered"
    )


def run_random() -> None:
    """Print separate random lines."""
    for count in (500, 1000):
        lines = random_lines(count)
        bound = travel_bound(list(lines), None, rounds=1000)
        beside_peer(f"{count} random lines", lines, bound, peer_python())


def machine_seconds(ways: list[Floats], model: Motion) -> float:
    """Return the time of strokes in order: drawing from stop to stop, swivels, lifts, travel."""
    cost = corners.by_time(model).turn
    total, at = 0.0, ways[0][0]
    for way in ways:
        step = np.diff(way, axis=0)
        heading = np.degrees(np.arctan2(step[:, 1], step[:, 0]))
        bend = np.abs((np.diff(heading) + 180) % 360 - 180)
        stop = np.flatnonzero(bend > model.swivel_from) + 1
        lengths = np.add.reduceat(np.hypot(*step.T), np.r_[0, stop])
        total += float(motion.move_seconds(lengths, SPEED, model.acceleration).sum())
        total += float(cost(bend).sum()) + 2 * model.lift_time
        hop = [float(np.hypot(*(way[0] - at)))]
        total += float(motion.move_seconds(hop, model.travel_speed, model.acceleration)[0])
        at = way[-1]
    return total


def run_trailing() -> None:
    """Print machine times of a trailing tool."""
    profile: Machine = installed().get("foldmill_machines", "machine", "generic-hpgl-600")
    model = profile.motion
    never = corners.Corners(turn=lambda angles: 1.0 + angles, lift=0.0)
    kinds: dict[str, corners.Corners] = {
        "by time": corners.by_time(model),
        "all lifts": never,
        "no lifts": corners.fewest_turns(),
        "Euler": corners.free_turning(),
    }
    graphs: dict[str, Callable[[], Graph]] = {
        "Miura": lambda: miura(30, 30),
        "waterbomb": lambda: waterbomb(20, 20),
        "stool": stool,
        "random planar": lambda: random_planar(1500),
    }
    print(
        f"{'machine time, s':16}" + "".join(f"{name:>12}" for name in kinds) + "   by time / best"
    )
    for name, make in graphs.items():
        points, edges = make()
        seconds = []
        for kind in kinds.values():
            trails = route(points, edges, None, kind).trails
            seconds.append(machine_seconds([points[list(t)] for t in trails], model))
        row = "".join(f"{value:12.1f}" for value in seconds)
        print(f"{name:16}{row}   {seconds[0] / min(seconds[1:]):.3f}")
    print(
        "(without lifts the sharp turns at each vertex are the fewest there can be: see the tests)"
    )


def run_growth() -> None:
    """Print time and memory over the number of creases."""
    rows: list[tuple[int, float, float]] = []
    for side in (79, 158, 316):
        command = [sys.executable, __file__, "grow", str(side)]
        out = [
            subprocess.run(command, capture_output=True, text=True, check=True).stdout
            for _ in range(RUNS)
        ]
        found = [json.loads(each) for each in out]
        count, seconds, memory = (median(column) for column in zip(*found, strict=True))
        rows.append((int(count), seconds, memory))
        print(f"{int(count):8} creases {seconds:8.2f} s {memory:8.0f} MB more than the import")
    (n, s, m), (N, S, M) = rows[0], rows[-1]
    print(f"exponent of time {np.log(S / s) / np.log(N / n):.2f}", end="")
    print(f", of memory {np.log(M / m) / np.log(N / n):.2f}" if m else ", of memory none seen")


def grow(side: int) -> tuple[int, float, float]:
    """Order one tessellation; return creases, s and MB."""
    points, edges = miura(side, side)
    route(*miura(4, 4), None, corners.fewest_turns())
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.process_time()
    route(points, edges, None, corners.fewest_turns())
    seconds = time.process_time() - start
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return len(edges), seconds, (after - before) / 1024


SECTIONS: dict[str, Callable[[], None]] = {
    "miura": run_miura,
    "setback": run_setback,
    "random": run_random,
    "trailing": run_trailing,
    "growth": run_growth,
}


def main(arguments: list[str]) -> None:
    """Run the sections asked for, or one measurement for a parent of ours."""
    single: dict[str, Callable[[str], Any]] = {
        "own": lambda file: own(np.load(file)),
        "grow": lambda side: grow(int(side)),
    }
    if arguments and arguments[0] in single:
        print(json.dumps(single[arguments[0]](arguments[1])))
        return
    for name in arguments or SECTIONS:
        SECTIONS[name]()


if __name__ == "__main__":
    main(sys.argv[1:])
