"""How far a drag knife's tip strays from its lines, and what it leaves uncut.

    python benchmarks/knife.py

Blades of offset 0.25 and 0.9 mm that point twelve ways at first are dragged (tractrix) along the
holder's ways of a square with its overcut, corners of 60 and 15 degrees and a fan of twelve
creases, in steps of 0.025 mm; then along the whole programs of a stool, both faces. No way in steps
sets every tip down nearer than half a step's diagonal, 0.0177 mm. Columns, mm:

tip         largest distance of any of the twelve tips from the lines, in the steps that programs
            take: those that keep the tip nearest
rounded     the same where each point of the exact way is rounded by itself
exact       the same before rounding to steps; of the stool, in steps of 0.001 mm
gap         length of the lines that no tip passes within 0.02 mm; of the stool, within what its
            proof allows
no lead-in  the tip's distance where the program believes that the blade points along x
no offset   where the holder is led along the lines themselves
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from foldmill import installed
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.formats.hpgl import half_away
from foldmill_fabricate.machines import Axes
from foldmill_fabricate.plan import make
from foldmill_fabricate.toolpath.knife import holder_ways, last_heading, lead_in
from foldmill_fabricate.toolpath.snapping import Grid
from foldmill_fabricate.verify import verify
from foldmill_fabricate.verify.blade import STARTS, dragged

Floats = NDArray[np.float64]

STEPS_PER_MM = 40
OFFSETS = (0.25, 0.9)
NEAR = 0.02
ENTRY = (-60.0, -60.0)


def corner(degrees: float) -> list[Floats]:
    """Return two legs of 20 mm that enclose an angle."""
    angle = np.radians(degrees)
    return [np.array([[20, 0], [0, 0], [20 * np.cos(angle), 20 * np.sin(angle)]], float)]


def shapes() -> dict[str, list[Floats]]:
    """Return the ways of the tip, by name."""
    spokes = np.radians(np.arange(12) * 30 + 7)
    square = np.array([[0, 0], [20, 0], [20, 20], [0, 20], [0, 0], [1, 0]], float)
    return {
        "square": [square],
        "60 degrees": corner(60),
        "15 degrees": corner(15),
        "fan of twelve": [np.outer([1, 15], [np.cos(a), np.sin(a)]) for a in spokes],
    }


def strayed(
    ways: Sequence[Floats], holders: Sequence[Floats], offset: float
) -> tuple[float, float]:
    """Return the farthest of twelve tips from the lines, and the length none of them cuts, mm.

    holders : those of a lead-in first, where there are more than ways.
    """
    tips = [tip for tip, _ in dragged(holders, offset, STARTS)][len(holders) - len(ways) :]
    lines = shapely.MultiLineString(list(ways))
    farthest = gap = 0.0
    for k in range(len(STARTS)):
        mine = [tip[min(k, len(tip) - 1)] for tip in tips]  # those that point alike go on as one
        cut = shapely.MultiLineString(mine)
        points = shapely.points(np.vstack(mine))
        farthest = max(farthest, float(shapely.distance(points, lines).max()))
        gap = max(gap, float(lines.difference(cut.buffer(NEAR)).length))
    return farthest, gap


def rounded(ways: Sequence[Floats]) -> list[Floats]:
    """Round to the machine's steps."""
    return [half_away(way * STEPS_PER_MM) / STEPS_PER_MM for way in ways]


def row(name: str, ways: list[Floats], offset: float) -> str:
    """Return one line of the table."""
    grid = Grid(Axes(units_per_mm=STEPS_PER_MM))
    entry = lead_in(ENTRY, offset, along=0.0)
    heading = last_heading(entry)
    tip, gap = strayed(ways, [entry, *holder_ways(ways, offset, heading, grid)], offset)
    exact = [entry, *holder_ways(ways, offset, heading)]
    coarse, _ = strayed(ways, rounded(exact), offset)
    fine, _ = strayed(ways, exact, offset)
    blind, _ = strayed(ways, rounded(holder_ways(ways, offset, 0.0)), offset)
    naive, _ = strayed(ways, rounded(ways), offset)
    return (
        f"{name:14} {offset:6.2f} {tip:8.4f} {coarse:8.4f} {fine:8.4f} {gap:6.3f} "
        f"{blind:11.3f} {naive:10.3f}"
    )


def stool(offset: float) -> str:
    """Return the line of a whole stool: programs, replayed and compared with the plan."""
    registry = installed()
    design = registry.design("tuck")
    fold = design.run(design.preset("stool-n8"))
    machine = registry.get("foldmill_machines", "machine", "generic-hpgl-drag-knife")
    found = []
    for units in (STEPS_PER_MM, 1000):
        tools = machine.tools.model_copy(update={"blade_offset": offset})
        axes = machine.axes.model_copy(update={"units_per_mm": units, "highest": 700 * units})
        own = machine.model_copy(update={"tools": tools, "axes": axes})
        plan = make(fold, registry.get("foldmill_materials", "material", "pp-0.75"), own)
        found.append(verify(plan, fold.pattern, hpgl.write(plan, fold)))
    coarse, fine = (each.figures.deviation for each in found)
    gap = 0.0 if all(each.ok for each in found) else float("nan")
    return f"{'stool':14} {offset:6.2f} {coarse:8.4f} {'':8} {fine:8.4f} {gap:6.3f}"


def main() -> None:
    """Print the table."""
    head = ("tip", "rounded", "exact")
    print(
        f"{'':14} {'offset':>6} {head[0]:>8} {head[1]:>8} {head[2]:>8} {'gap':>6} "
        f"{'no lead-in':>11} {'no offset':>10}"
    )
    for offset in OFFSETS:
        for name, ways in shapes().items():
            print(row(name, ways, offset))
        print(stool(offset))


if __name__ == "__main__":
    main()
