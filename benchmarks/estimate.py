"""How near a plan's estimate comes to the clock of the simulated machine, line and all.

    python benchmarks/estimate.py [BAUD]...

Each job is planned, its programs are sent to a simulated machine at each rate (default 9600), and
the clock is read when it has come to rest. Columns, seconds and shares:

estimate    what the plan says
clock       from the first byte to rest, all programs, the operator's time left out
ratio       estimate / clock
moving      share of the clock in which the machine moved
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from statistics import median

from foldmill import CreasePattern, Fold, installed
from foldmill_fabricate import shelf
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.simulator.trial import clocked


def preset(family: str, name: str) -> Fold:
    """Return a fold of a family's preset."""
    design = installed().design(family)
    return design.run(design.preset(name))


def square() -> Fold:
    """Return a square with four creases from its middle."""
    corners = [(0, 0), (120, 0), (120, 120), (0, 120), (60, 60)]
    words = ["01B", "12B", "23B", "30B", "04M", "14V", "24M", "34V"]
    edges = [(int(word[0]), int(word[1])) for word in words]
    letters = [word[2] for word in words]
    angles = [{"M": -90.0, "V": 90.0}.get(letter, 0.0) for letter in letters]
    return Fold(CreasePattern.from_lines(corners, edges, letters, angles))


KNIFE = "generic-hpgl-drag-knife"
JOBS: dict[str, tuple[str, Callable[[], Fold]]] = {
    "stool, one tool": ("generic-hpgl-600", lambda: preset("tuck", "stool-n8")),
    "stool, tools by SP": ("generic-hpgl-pens", lambda: preset("tuck", "stool-n8")),
    "square": ("generic-hpgl-600", square),
    "vase": ("generic-hpgl-600", lambda: preset("six-crease", "vase")),
    "bowl": ("generic-hpgl-600", lambda: preset("rotational", "bowl-n8")),
    "catenoid": ("generic-hpgl-600", lambda: preset("waterbomb", "catenoid-8x6")),
    "square, knife": (KNIFE, square),
    "stool, knife": (KNIFE, lambda: preset("tuck", "stool-n8")),
    "catenoid, knife": (KNIFE, lambda: preset("waterbomb", "catenoid-8x6")),
}


def simulated(plan: Plan, fold: Fold, used: Machine) -> tuple[float, float]:
    """Return seconds on the clock and seconds of motion for all programs, one after the other."""
    return clocked(hpgl.write(plan, fold).values(), used)


def main(bauds: list[int]) -> None:
    """Print the table."""
    print(f"{'':18}{'baud':>7}{'estimate':>10}{'clock':>10}{'ratio':>8}{'moving':>8}")
    ratios = []
    for name, (slug, made) in JOBS.items():
        fold = made()
        for baud in bauds:
            base = shelf.machine(slug)
            used = base.model_copy(update={"serial": base.serial.model_copy(update={"baud": baud})})
            plan = make(fold, shelf.material("pp-0.75"), used)
            clock, moving = simulated(plan, fold, used)
            ratios.append(plan.figures.seconds / clock)
            print(
                f"{name:18}{baud:7}{plan.figures.seconds:10.1f}{clock:10.1f}"
                f"{ratios[-1]:8.4f}{moving / clock:8.3f}"
            )
    farthest = max(abs(ratio - 1) for ratio in ratios)
    print(f"median {median(ratios):.4f}, farthest from one {100 * farthest:.2f} %")


if __name__ == "__main__":
    main([int(word) for word in sys.argv[1:]] or [9600])
