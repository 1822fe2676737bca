"""How fast formats are written, beside the plainest loop or the library that writes the same.

    python benchmarks/formats.py [--job] [CREASES]...

A sheet with so many creases (default 5,000 and 50,000) is written in each format; medians of five
runs, ours and the other by turns. Columns:

ours        s
other       s: a plain loop that writes the same bytes, compared; for DXF, SVG and PDF ezdxf,
            svgwrite and pikepdf writing the same entities
ratio       ours / other
growth      ours / ours of the first size, for each crease: 1 is linear

With --job the whole way is gone instead, each size in a process of its own: the plan for a machine
with one tool, the folder with all its files, and its verification. Columns: s of the processor for
each and for all, peak MB above those of the program alone, MB of files, and how time and memory
grow for each crease.
"""

from __future__ import annotations

import gc
import json
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from io import BytesIO, StringIO
from itertools import pairwise
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np

from foldmill import CreasePattern, Fold
from foldmill.exchange import fold as fold_file
from foldmill_fabricate import shelf
from foldmill_fabricate.formats import cf2, dxf, gcode, gpgl, hpgl, pdf, svg
from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.passes import (
    Face,
    Figures,
    Flip,
    Operation,
    Pass,
    Placement,
    Plan,
    Role,
    SetUp,
    Sheet,
    Stroke,
)
from foldmill_fabricate.profiles import Style, find

Write = Callable[[], bytes]
RUNS = 5
SIDE, AT = 480.0, 50.0
POINTS = 72 / 25.4
MACHINES = {
    "hpgl": "generic-hpgl-600",
    "gp-gl": "silhouette-like",
    "gcode": "grbl-laser",
    "cf2": "generic-hpgl-600",
    "dxf": "generic-hpgl-600",
    "svg": "generic-hpgl-600",
    "pdf": "generic-hpgl-600",
    "pdf-a4": "generic-hpgl-600",
}


def grid(creases: int) -> Fold:
    """Return a square of quads whose diagonals alternate, of about so many creases."""
    side = max(2, round((creases / 3) ** 0.5))
    xs = np.linspace(0, SIDE, side + 1)
    vertices = np.array([(x, y) for y in xs for x in xs])
    number = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    across = np.stack([number[:, :-1], number[:, 1:]], -1).reshape(-1, 2)
    upward = np.stack([number[:-1], number[1:]], -1).reshape(-1, 2)
    slant = np.stack([number[:-1, :-1], number[1:, 1:]], -1).reshape(-1, 2)
    edges = np.vstack([across, upward, slant])
    at = vertices[edges]
    rim = ((at == 0).all(axis=1) | (at == SIDE).all(axis=1)).any(axis=1)
    letters = ["B" if r else "MV"[k % 2] for k, r in enumerate(rim.tolist())]
    return Fold(CreasePattern.from_lines(vertices, edges, letters))


def planned(fold: Fold, slug: str) -> Plan:
    """Return a plan that scores every crease on the front, there and back."""
    machine, material = shelf.machine(slug), shelf.material("pp-0.75")
    bed = machine.bed
    ends = fold.pattern.vertices[fold.pattern.edges] + 10
    strokes = tuple(Stroke(points=(tuple(a), tuple(b))) for a, b in ends.tolist())
    operation = Operation(role=Role.SCORE, repeats=2, strokes=strokes)
    setup = SetUp(
        number=1, name="front-score", process="score", tool=machine.tools.station("half-cut"),
        exposure=0.4, force=machine.tools.force(240.0), speed=120.0, gates=(),
        operations=(operation,),
    )  # fmt: skip
    sheet = Sheet(
        width=500, height=500, carrier_width=bed.carrier_width, carrier_height=bed.carrier_height,
        dx=AT, dy=AT,
    )  # fmt: skip
    return Plan(
        title="Grid", pattern_sha256="", material=material, machine=machine, sheet=sheet,
        placement=Placement(angle=0, dx=10, dy=10), flip=Flip(kind="left-right", axis=250),
        holes=(), ties=(), passes=(Pass(face=Face.FRONT, setups=(setup,)),),
        figures=Figures(strokes=0, lifts=0, drawn=0, travel=0, travel_bound=0, seconds=0),
    )  # fmt: skip


def strokes_of(plan: Plan) -> tuple[Stroke, ...]:
    """Return the strokes of the only set-up."""
    return plan.passes[0].setups[0].operations[0].strokes


def steps(plan: Plan, x: float, y: float) -> tuple[int, int]:
    """Return a point in steps, as a loop does it."""
    axes = plan.machine.axes
    x, y = x + AT, y + AT
    if axes.top is not None:
        y = axes.top - y
    if axes.swap:
        x, y = y, x
    return int(x * axes.units_per_mm + 0.5), int(y * axes.units_per_mm + 0.5)


def plain_hpgl(plan: Plan) -> bytes:
    """Write HP-GL stroke by stroke."""
    lines = ["IN;DF;PA;", "PU;", "SP1;", "VS12;", "FS240;"]
    for stroke in strokes_of(plan):
        (a, b), (u, v) = (steps(plan, *point) for point in stroke.points)
        lines.append(f"PU{a},{b};")
        lines.append(f"PD{u},{v},{a},{b};")
    return "\n".join([*lines, "PU;SP0;", ""]).encode()


def plain_gpgl(plan: Plan) -> bytes:
    """Write GP-GL stroke by stroke."""
    commands = ["J1", "!1", "FX33", "FC18"]
    for stroke in strokes_of(plan):
        (a, b), (u, v) = (steps(plan, *point) for point in stroke.points)
        commands.append(f"M{a},{b}")
        commands.append(f"D{u},{v},{a},{b}")
    return "\x03".join([*commands, f"M{a},{b}", "H", ""]).encode()


def plain_gcode(plan: Plan) -> bytes:
    """Write G-code stroke by stroke."""
    units = plan.machine.axes.units_per_mm
    lines = ["G21G90G94", "M5"]
    for stroke in strokes_of(plan):
        (a, b), (u, v) = (steps(plan, *point) for point in stroke.points)
        x, y, z, w = (f"{each / units:.4f}".rstrip("0").rstrip(".") for each in (a, b, u, v))
        lines.append(f"G0X{x}Y{y}")
        lines.append("M4S1000")
        lines.append(f"G1X{z}Y{w}F7200")
        lines.append(f"G1X{x}Y{y}")
        lines.append("M5")
    return "\n".join([*lines, "M2", ""]).encode()


def plain_cf2(plan: Plan) -> bytes:
    """Write CFF2 line by line."""
    lines = ["$BOF", "V2", "ORDER", "END", "MAIN,Grid_front", "UM", "LL,0,0", "UR,500,500"]
    lines.append("SCALE,1,1")
    for stroke in strokes_of(plan):
        said = [
            f"{round(value, 4):.4f}".rstrip("0").rstrip(".")
            for point in stroke.points
            for value in point
        ]
        lines.append(f"L,2,2,0,{','.join(said)},0,0")
    return "\r\n".join([*lines, "END", "$EOF", ""]).encode()


def ezdxf_alone(plan: Plan) -> bytes:
    """Add every line with ezdxf and let it write."""
    from ezdxf.filemanagement import new

    document = new("R2000", units=4)
    space = document.modelspace()
    document.layers.add("SCORE_FRONT", color=4)
    look = {"layer": "SCORE_FRONT", "color": 4}
    for stroke in strokes_of(plan):
        begin, end = stroke.points
        space.add_line(begin, end, dxfattribs=look)
    out = StringIO()
    document.write(out)
    return document.encode(out.getvalue())


def svgwrite_alone(plan: Plan) -> bytes:
    """Add every path with svgwrite and let it write."""
    import svgwrite

    drawing = svgwrite.Drawing(size=("500mm", "500mm"), viewBox="0 0 500 500", debug=False)
    style = "fill:none;stroke:#0000ff;stroke-width:0.25"
    for stroke in strokes_of(plan):
        (a, b), (u, v) = stroke.points
        drawing.add(drawing.path(d=f"M {a:.4f},{500 - b:.4f} L {u:.4f},{500 - v:.4f}", style=style))
    out = StringIO()
    drawing.write(out, pretty=True, indent=1)
    return out.getvalue().encode()


def pikepdf_alone(plan: Plan) -> bytes:
    """Draw every line on a canvas of pikepdf's and let it write."""
    from pikepdf.canvas import BLUE, Canvas

    canvas = Canvas(page_size=(500 * POINTS, 500 * POINTS))
    canvas.do.stroke_color(BLUE).line_width(0.7)
    for stroke in strokes_of(plan):
        (a, b), (u, v) = stroke.points
        canvas.do.line(a * POINTS, b * POINTS, u * POINTS, v * POINTS)  # type: ignore[no-untyped-call]
    out = BytesIO()
    canvas.to_pdf().save(out)
    return out.getvalue()


def plain_fold(content: Mapping[str, Any]) -> bytes:
    """Write a FOLD file's content row by row: one place, edge or face, or twelve plain values."""
    parts = []
    for key, value in content.items():
        begin = f' "{key}": '
        if not key.startswith(("vertices_", "edges_", "faces_")):
            parts.append(begin + json.dumps(value, ensure_ascii=False))
            continue
        rows = []
        if isinstance(value[0], list):
            for item in value:
                rows.append("  [" + ", ".join([repr(each) for each in item]) + "]")  # noqa: PERF401
        else:
            for k in range(0, len(value), 12):
                row = ", ".join([json.dumps(each) for each in value[k : k + 12]])
                rows.append(f"  {row}")
        parts.append(begin + "[\n" + ",\n".join(rows) + "\n ]")
    return ("{\n" + ",\n".join(parts) + "\n}\n").encode()


def pairs(fold: Fold) -> dict[str, tuple[Write, Write, bool]]:
    """Return per format ours, the other, and whether both write the same bytes."""
    plans = {slug: planned(fold, slug) for slug in set(MACHINES.values())}
    of = {name: plans[slug] for name, slug in MACHINES.items()}
    front = Style(find())
    content = json.loads(fold_file.write(fold))
    return {
        "hpgl": (lambda: hpgl.program(of["hpgl"], (1,)), lambda: plain_hpgl(of["hpgl"]), True),
        "gp-gl": (lambda: gpgl.program(of["gp-gl"], (1,)), lambda: plain_gpgl(of["gp-gl"]), True),
        "gcode": (lambda: gcode.program(of["gcode"], (1,)), lambda: plain_gcode(of["gcode"]), True),
        "cf2": (
            lambda: cf2.write(of["cf2"], fold, front)["front.cf2"],
            lambda: plain_cf2(of["cf2"]),
            True,
        ),
        "fold": (
            lambda: fold_file.write(fold).encode(),
            lambda: plain_fold(content),
            True,
        ),
        "dxf": (
            lambda: dxf.one(next(d.drawings(of["dxf"]))),
            lambda: ezdxf_alone(of["dxf"]),
            False,
        ),
        "svg": (
            lambda: svg.one(of["svg"], next(d.drawings(of["svg"]))),
            lambda: svgwrite_alone(of["svg"]),
            False,
        ),
        "pdf": (
            lambda: pdf.one(of["pdf"], next(d.drawings(of["pdf"]))),
            lambda: pikepdf_alone(of["pdf"]),
            False,
        ),
        "pdf-a4": (
            lambda: pdf.tiled(of["pdf-a4"], next(d.drawings(of["pdf-a4"])), front.profile, "a4"),
            lambda: pikepdf_alone(of["pdf-a4"]),
            False,
        ),
    }


def timed(write: Write) -> float:
    """Return the seconds of one run."""
    gc.collect()
    begin = perf_counter()
    write()
    return perf_counter() - begin


def main(sizes: list[int]) -> None:
    """Print the table."""
    print(f"{'':8}{'creases':>9}{'MB':>8}{'ours':>9}{'other':>9}{'ratio':>8}{'growth':>8}")
    first: dict[str, float] = {}
    for size in sizes:
        fold = grid(size)
        count = len(fold.pattern.edges)
        for name, (ours, other, same) in pairs(fold).items():
            data = ours()
            if same and data != other():
                raise SystemExit(f"{name}: the plain loop writes other bytes")
            rows = [(timed(ours), timed(other)) for _ in range(RUNS)]
            mine, theirs = (median(column) for column in zip(*rows, strict=True))
            first.setdefault(name, mine / count)
            growth = mine / count / first[name]
            print(
                f"{name:8}{count:9}{len(data) / 1e6:8.2f}{mine:9.3f}{theirs:9.3f}"
                f"{median(a / b for a, b in rows):8.2f}{growth:8.2f}"
            )


def memory() -> float:
    """Return the peak memory of this process so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def job(size: int) -> None:
    """Plan, write and verify a job of so many creases; print its row as JSON."""
    from foldmill_fabricate import folder
    from foldmill_fabricate.plan import make
    from foldmill_fabricate.verify import read_folder, verify_files

    material, machine = shelf.material("pp-0.75"), shelf.machine("generic-hpgl-600")
    make(grid(50), material, machine)  # compiles and imports what is used
    fold, begins = grid(size), memory()
    laps = [process_time()]
    plan = make(fold, material, machine)
    laps.append(process_time())
    with tempfile.TemporaryDirectory() as target:
        folder.write(fold, plan, Path(target), ["svg", "dxf", "cf2", "hpgl"])
        laps.append(process_time())
        found = verify_files(read_folder(Path(target)))
        laps.append(process_time())
        written = sum(path.stat().st_size for path in Path(target).iterdir()) / 1e6
    if not found.ok:
        raise SystemExit(f"{size} creases: the job does not verify")
    seconds = [end - begin for begin, end in pairwise(laps)]
    row = [len(fold.pattern.edges), *seconds, sum(seconds), memory() - begins, written]
    sys.stdout.write(json.dumps(row))


def jobs(sizes: list[int]) -> None:
    """Print the table of whole jobs."""
    heads = ("creases", "plan", "write", "verify", "all", "MB", "files MB", "time ×", "MB ×")
    print("".join(f"{head:>10}" for head in heads))
    first: list[float] = []
    for size in sizes:
        words = [sys.executable, __file__, "--one-job", str(size)]
        said = subprocess.run(words, env=os.environ, stdout=subprocess.PIPE, check=True)
        count, *rest = json.loads(said.stdout)
        each = [rest[3] / count, rest[4] / count]
        first = first or each
        grown = [mine / theirs for mine, theirs in zip(each, first, strict=True)]
        print(f"{count:10}" + "".join(f"{value:10.2f}" for value in (*rest, *grown)), flush=True)


if __name__ == "__main__":
    wanted = [int(word) for word in sys.argv[1:] if word.isdigit()] or [5000, 50_000]
    if "--one-job" in sys.argv:
        job(wanted[0])
    elif "--job" in sys.argv:
        jobs(wanted)
    else:
        main(wanted)
