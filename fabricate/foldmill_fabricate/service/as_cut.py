"""A face as it is cut by now: what is certain, what is doubtful, what is left.

It is drawn from the programs that were sent, read by verification's own interpreters, and from the
ledger's word on each stroke; so it shows what was done, and not what was planned. The face lies as
the machine sees it: mm of the carrier, x right, y up.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from foldmill import installed
from foldmill_fabricate.hooks import INTERPRETERS, Interpreter
from foldmill_fabricate.machines import Axes, Machine
from foldmill_fabricate.passes import Plan

Floats = NDArray[np.float64]
Strokes = Mapping[str, Mapping[str, Sequence[int]]]
"""By program: "certain" and "doubtful" strokes, 0, 1, 2 …"""
_LINE = "fill:none;stroke-linecap:round"
STYLES = {
    "left": "stroke:#c9ccd1;stroke-width:0.4",
    "certain": "stroke:#111111;stroke-width:0.8",
    "doubtful": "stroke:#d62728;stroke-width:1.6",
}
"""In order of drawing: what matters lies on top."""


def drawing(folder: Path, face: str, strokes: Strokes, title: str) -> bytes:
    """Draw a face of a sheet of a job folder as SVG; the same input gives the same bytes."""
    plan = Plan.model_validate_json((folder / "plan.json").read_bytes())
    ways: dict[str, list[Floats]] = {name: [] for name in STYLES}
    for program in plan.programs:
        if program.face == face and program.name in strokes:
            said = strokes[program.name]
            for number, way in enumerate(_ways(folder / program.name, plan.machine)):
                ways[_standing(said, number)].append(way)
    return _svg(ways, plan.sheet.carrier_width, plan.sheet.carrier_height, title)


def _standing(said: Mapping[str, Sequence[int]], number: int) -> str:
    return next((name for name in ("certain", "doubtful") if number in said[name]), "left")


def _ways(program: Path, machine: Machine) -> Iterable[Floats]:
    """Yield the strokes of a program in order, (n, 2) mm of the carrier."""
    reader: Interpreter = installed().get(INTERPRETERS, "interpreter", machine.language)
    for run in reader.replay(program.read_bytes(), program.name, machine).runs:
        yield _on_carrier(run.points, machine.axes)


def _on_carrier(steps: Floats, axes: Axes) -> Floats:
    """Return machine steps as mm of the carrier; the machine's own errors are left in."""
    places = np.asarray(steps, float)[:, :: -1 if axes.swap else 1] / axes.units_per_mm
    if axes.top is not None:
        places = places * (1.0, -1.0) + (0.0, axes.top)
    return places


def _svg(ways: Mapping[str, list[Floats]], width: float, height: float, title: str) -> bytes:
    size = f'width="{width:g}mm" height="{height:g}mm" viewBox="0 0 {width:g} {height:g}"'
    groups = [
        f'<g id="{name}" style="{_LINE};{style}">{_paths(ways[name], height)}</g>'
        for name, style in STYLES.items()
    ]
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}>',
        f"<title>{escape(title)}</title>",
        f'<rect width="{width:g}" height="{height:g}" style="fill:#ffffff"/>',
        *groups,
        "</svg>",
    ]
    return ("\n".join(lines) + "\n").encode()


def _paths(ways: list[Floats], height: float) -> str:
    return "".join(f'<path d="M{_points(way, height)}"/>' for way in ways)


def _points(way: Floats, height: float) -> str:
    return " ".join(f"{x:.2f},{height - y:.2f}" for x, y in way.tolist())
