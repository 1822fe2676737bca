"""The crease pattern as an SVG in an origami program's colours; to be folded there, never cut.

Colours must match exactly. Origami Simulator takes the opacity for |fold angle| / 180; Flat-Folder
knows colours by name, from a style attribute only, and no transforms, so both are kept to.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from foldmill import Assignment, Fold
from foldmill.exchange.marking import warning
from foldmill.slits import sewn
from foldmill_fabricate.formats.svg import canvas, number, path, to_bytes


@dataclass(frozen=True)
class Look:
    """How a program wants lines drawn."""

    program: str
    colours: Mapping[Assignment, str]
    angled: bool
    """Whether the opacity of a mountain or valley tells how far it folds."""


COLOURS = {
    Assignment.B: "#000000",
    Assignment.M: "#ff0000",
    Assignment.V: "#0000ff",
    Assignment.F: "#ffff00",
    Assignment.U: "#ff00ff",
    Assignment.C: "#00ff00",
}
"""U has no colour of its own there; magenta is the hinge that nothing drives."""
ORIGAMI_SIMULATOR = Look("Origami Simulator", COLOURS, angled=True)
FLAT_FOLDER = Look(
    "Flat-Folder",
    {
        Assignment.B: "black",
        Assignment.M: "red",
        Assignment.V: "blue",
        Assignment.F: "gray",
        Assignment.U: "magenta",
        Assignment.C: "black",
    },
    angled=False,
)
"""Any other colour is unassigned there, so magenta is; it has no inner cuts."""
MARGIN = 5.0
"""mm, so that no line is clipped."""


def pattern_svg(fold: Fold, look: Look = ORIGAMI_SIMULATOR) -> bytes:
    """Return the pattern as SVG, mm outside and inside, y turned downward.

    A slit is one line, an inner cut: a simulator opens it by itself. look : of the program it is
    for.
    """
    pattern = sewn(fold.pattern).pattern
    corner = pattern.vertices.min(axis=0) - MARGIN
    width, height = np.ptp(pattern.vertices, axis=0) + 2 * MARGIN
    svg = canvas(float(width), float(height))
    about = f"Crease pattern in {look.program}'s colours. Not a cutting file."
    svg.set_desc(
        title=str(fold.meta.get("title", "Crease pattern")), desc=f"{about} {warning(fold)}".strip()
    )
    drawn = ~np.asarray(pattern.added, bool)  # whoever needs triangles makes them anew
    for edge, code, angle in zip(
        pattern.edges[drawn], pattern.assignments[drawn], pattern.fold_angles[drawn], strict=True
    ):
        line = path(pattern.vertices[edge] - corner, float(height))
        svg.add(svg.path(d=line, style=_style(look, Assignment(code), float(angle))))
    return to_bytes(svg)


def _style(look: Look, kind: Assignment, angle: float) -> str:
    style = f"fill:none;stroke:{look.colours[kind]};stroke-width:0.5"
    if look.angled and kind in {Assignment.M, Assignment.V}:
        style += f";stroke-opacity:{number(abs(angle) / 180)}"
    return style
