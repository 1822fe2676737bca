"""The crease pattern as an SVG in Origami Simulator's colours; for simulating, never for cutting.

Colours must match exactly, the opacity is |fold angle| / 180, and some readers take the colour from
a style attribute only and know no transforms (Flat-Folder), so both are kept to.
"""

from __future__ import annotations

import numpy as np

from foldmill import Assignment, Fold
from foldmill.exchange.marking import warning
from foldmill.slits import sewn
from foldmill_fabricate.formats.svg import canvas, number, path, to_bytes

COLOURS = {
    Assignment.B: "#000000",
    Assignment.M: "#ff0000",
    Assignment.V: "#0000ff",
    Assignment.F: "#ffff00",
    Assignment.U: "#ff00ff",
    Assignment.C: "#00ff00",
}
"""U has no colour of its own there; magenta is the hinge that nothing drives."""
MARGIN = 5.0
"""mm, so that no line is clipped."""


def pattern_svg(fold: Fold) -> bytes:
    """Return the pattern as SVG, mm outside and inside, y turned downward.

    A slit is one line, an inner cut: a simulator opens it by itself.
    """
    pattern = sewn(fold.pattern).pattern
    corner = pattern.vertices.min(axis=0) - MARGIN
    width, height = np.ptp(pattern.vertices, axis=0) + 2 * MARGIN
    svg = canvas(float(width), float(height))
    about = "Crease pattern in Origami Simulator's colours. Not a cutting file."
    svg.set_desc(
        title=str(fold.meta.get("title", "Crease pattern")), desc=f"{about} {warning(fold)}".strip()
    )
    for edge, code, angle in zip(
        pattern.edges, pattern.assignments, pattern.fold_angles, strict=True
    ):
        line = path(pattern.vertices[edge] - corner, float(height))
        svg.add(svg.path(d=line, style=_style(Assignment(code), float(angle))))
    return to_bytes(svg)


def _style(kind: Assignment, angle: float) -> str:
    style = f"fill:none;stroke:{COLOURS[kind]};stroke-width:0.5"
    if kind in {Assignment.M, Assignment.V}:
        style += f";stroke-opacity:{number(abs(angle) / 180)}"
    return style
