"""How long large waterbomb sheets take, stage by stage, and how the time grows.

    python benchmarks/sheets.py [LARGEST] [FORMATS]

LARGEST (default 3200) is the largest number of bases; 50000 takes a quarter of an hour of the
processor. FORMATS (default svg,dxf,hpgl) are those that plan writes. Every stage is a command of
its own, as a user types it: catenoids of 800, 3,200, 12,800 and 49,928 bases of one size of cell
are designed, checked, planned in card for a cutting table of 3200 × 1800 mm (the machine of
examples/machines), verified, and sent to that table's simulator. The last is done by
benchmarks/sent.py, which verifies and sends as the command does, and then lays every stroke that
the machine drew beside the plan's.

s         processor seconds of the command
exponent  b in seconds ~ creases^b, from the size before
MB        the most memory the command held
The counts of the plan stand beside each size, so that no stage passes by doing less.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from math import log
from pathlib import Path

SIZES = ((40, 20), (80, 40), (160, 80), (316, 158))
CELL = 3000 / 316
"""mm of sheet to a base, along u."""
SENT = Path(__file__).parent / "sent.py"
MACHINE = "table-3200"
SHIPPED = Path(__file__).parent.parent / "examples" / "machines" / f"{MACHINE}.toml"


@dataclass(frozen=True)
class Spent:
    """What one command took."""

    seconds: float
    megabytes: float


def run(arguments: list[str], home: Path) -> Spent:
    """Run one command of Python's; ends the benchmark where it fails."""
    environment = {**os.environ, "XDG_CONFIG_HOME": str(home)}
    command = [sys.executable, *arguments]
    child = subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    said = child.stdout.read() if child.stdout else b""
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        sys.exit(f"{' '.join(command)}\n{said.decode()}")
    return Spent(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3)


def stages(n_u: int, n_v: int, folder: Path, formats: str) -> dict[str, list[str]]:
    """Return the commands of one size, by stage."""
    length = n_u * CELL
    blank = f"{length + 60:.0f}x{0.585 * length + 40:.0f}"
    fold, job = str(folder / "sheet.fold"), str(folder / "job")
    counts = ["--n_u", str(n_u), "--n_v", str(n_v), "--size", f"{length:.0f}"]
    made = ["--material", "card-250", "--machine", MACHINE, "--blank", blank, "--to", formats]
    verbs = {
        "design": ["waterbomb", "--preset", "catenoid", *counts, "-o", fold],
        "check": [fold],
        "plan": [fold, *made, "-o", job],
        "verify": [job],
    }
    foldmill = {verb: ["-m", "foldmill_fabricate", verb, *rest] for verb, rest in verbs.items()}
    return {**foldmill, "send": [str(SENT), job, f"sim://{MACHINE}"]}


def figures(folder: Path) -> tuple[int, str]:
    """Return the number of scored strokes, and what the plan says of itself."""
    plan = json.loads((folder / "job" / "plan.json").read_text(encoding="utf-8"))
    told = plan["figures"]
    hours = told["seconds"] / 3600
    return told["strokes"], (
        f"{told['strokes']} strokes, {told['lifts']} lifts, {len(plan['ties'])} ties, "
        f"{told['drawn'] / 1000:.0f} m drawn, {told['travel'] / 1000:.0f} m of travel "
        f"(at least {told['travel_bound'] / 1000:.0f}), {hours:.1f} h on the machine"
    )


def main(largest: int, formats: str) -> None:
    """Print a table for every size."""
    home = Path(tempfile.mkdtemp())
    (home / "foldmill" / "machines").mkdir(parents=True)
    shutil.copy(SHIPPED, home / "foldmill" / "machines")
    before: dict[str, float] = {}
    strokes_before = 0
    start = time.perf_counter()
    for n_u, n_v in (size for size in SIZES if size[0] * size[1] <= 1.01 * largest):
        with tempfile.TemporaryDirectory() as folder:
            spent = {k: run(a, home) for k, a in stages(n_u, n_v, Path(folder), formats).items()}
            strokes, said = figures(Path(folder))
        print(f"\n{n_u} × {n_v}: {n_u * n_v} bases, {said}")
        print(f"{'':10}{'s':>9}{'exponent':>10}{'MB':>7}")
        for stage, cost in spent.items():
            grown = (
                log(cost.seconds / before[stage]) / log(strokes / strokes_before) if before else 0
            )
            exponent = f"{grown:.2f}" if before else ""
            print(f"{stage:10}{cost.seconds:9.2f}{exponent:>10}{cost.megabytes:7.0f}", flush=True)
        before = {stage: cost.seconds for stage, cost in spent.items()}
        strokes_before = strokes
    shutil.rmtree(home)
    print(f"\nall in {time.perf_counter() - start:.0f} s of the clock")


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 3200,
        sys.argv[2] if len(sys.argv) > 2 else "svg,dxf,hpgl",
    )
