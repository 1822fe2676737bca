"""What it costs to start a command, beside vpype's whole one, in one run.

    python benchmarks/start.py

Processor seconds (user and system) of whole processes, medians of seven in turn, so that a busy
machine slows all alike. ``plan`` orders 500 separate lines of a drawing, writes programs, plan and
job sheet; vpype (MIT, in a virtual environment of its own) reads the same lines, orders them by
``linemerge linesort --two-opt``, and writes HP-GL; it draws no page.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from toolpath import peer_python, random_lines, shuffled

RUNS = 7
STEPS, EDGE = 40, 20.0
"""Steps per mm of the drawing in HP-GL, and mm around its lines."""


def lines_file(folder: Path) -> tuple[Path, Path]:
    """Write 500 random lines as HP-GL for us and as SVG for vpype."""
    lines = shuffled(random_lines(500)) + EDGE
    steps = (STEPS * lines).round().astype(int).tolist()
    drawn = "".join(f"PU{a},{b};PD{c},{d};" for (a, b), (c, d) in steps)
    (folder / "lines.plt").write_text(f"IN;SP1;{drawn}PU;SP0;")
    tags = "".join(
        f'<line x1="{a}" y1="{b}" x2="{c}" y2="{d}" stroke="black"/>'
        for (a, b), (c, d) in lines.tolist()
    )
    head = 'xmlns="http://www.w3.org/2000/svg" width="540mm" height="540mm" viewBox="0 0 540 540"'
    (folder / "lines.svg").write_text(f"<svg {head}>{tags}</svg>")
    return folder / "lines.plt", folder / "lines.svg"


def commands(folder: Path) -> dict[str, list[str]]:
    """Return what is measured, by its name."""
    plt, svg = lines_file(folder)
    own = [sys.executable, "-m", "foldmill_fabricate"]
    planned = [*own, "plan", str(plt), "--pen", "1=score", "--blank", "560x560", "--to", "hpgl"]
    found = {
        "python": [sys.executable, "-c", "pass"],
        "--version": [*own, "--version"],
        "--help": [*own, "--help"],
        "families": [*own, "families"],
        "machines": [*own, "machines"],
        "job list": [*own, "job", "list"],
        "plan": [*planned, "-o", str(folder / "job")],
    }
    peer = peer_python()
    if peer is not None:
        words = "linemerge linesort --two-opt write --device hp7475a --page-size a3 --landscape"
        vpype = [str(peer.parent / "vpype"), "read", str(svg), *words.split()]
        found["vpype"] = [*vpype, str(folder / "out.hpgl")]
    return found


def seconds(command: list[str], folder: Path) -> float:
    """Return the processor seconds of one process, user and system."""
    before = os.times()
    env = {**os.environ, "XDG_DATA_HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}
    subprocess.run(command, env=env, cwd=folder, capture_output=True, check=True)
    after = os.times()
    user = after.children_user - before.children_user
    return user + after.children_system - before.children_system


def main() -> None:
    """Print the medians, and each beside vpype's."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        asked = commands(folder)
        for command in asked.values():
            seconds(command, folder)  # compiles and caches what later ones find
        rows = [{key: seconds(each, folder) for key, each in asked.items()} for _ in range(RUNS)]
    found = {key: median(row[key] for row in rows) for key in asked}
    for key, value in found.items():
        beside = f"{value / found['vpype']:6.2f} x vpype's" if "vpype" in found else ""
        print(f"{key:10} {value:6.2f} s {beside}")


if __name__ == "__main__":
    main()
