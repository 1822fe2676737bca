"""What a cutting drawing shows, before anybody calls it SVG or DXF: layers of lines in mm.

Terminology: a *view* is one face as the machine sees it, or the master with both faces unmirrored;
*anchors* are marks in the blank's corners, the same in every view, so that software that places
a drawing by its bounding box places both faces alike.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Face, Operation, Plan, Role, SetUp, Stroke
from foldmill_fabricate.sheet import flipped

Floats = NDArray[np.float64]

ANCHOR_ARM = 5.0
"""mm. Length of the arms of a corner anchor."""
NOTE_HEIGHT = 3.5
"""mm. Height of a note's capitals."""
NOTE_AT = (8.0, 2.0)
"""mm. Left end of a note's baseline: below the holes, right of the corner's anchor."""


@dataclass(frozen=True)
class Layer:
    """A layer's name, and how software that goes by colour or pen recognises it."""

    name: str
    aci: int
    """AutoCAD colour index, as die-making software maps it."""
    colour: str
    """#rrggbb of LightBurn's palette, which maps colours to layers."""
    pen: int
    """Pen number where SP selects no tools; ascending in order of work."""


LAYERS = (
    Layer("REG", 10, "#00e000", 1),
    Layer("SCORE_FRONT", 4, "#0000ff", 2),
    Layer("SCORE_BACK", 9, "#ff8000", 2),
    Layer("CUT_INNER", 1, "#d0d000", 4),
    Layer("CUT_OUTER", 1, "#ff0000", 4),
)
"""Layers that are worked, in order of work."""
NOTE = Layer("NOTE", 20, "#b4b4b4", 5)
"""Words for people; no output."""
ANCHOR = Layer("ANCHOR", 20, "#b4b4b4", 5)
"""Corner marks; no output."""

_BY_NAME = {layer.name: layer for layer in LAYERS}
_CUTS = {
    Role.HOLE: "REG",
    Role.MARK: "REG",
    Role.VERNIER: "CUT_INNER",
    Role.RELIEF: "CUT_INNER",
    Role.CUT_INNER: "CUT_INNER",
    Role.CUT_OUTER: "CUT_OUTER",
}


@dataclass(frozen=True, eq=False)
class Group:
    """The lines of one layer, each once however often the knife repeats it."""

    layer: Layer
    setup: SetUp | None
    """The first set-up that works on this layer; its tool, speed and force go with it. None where
    nothing is worked."""
    lines: tuple[Floats, ...]
    """Each (n, 2) mm; a closed line ends where it begins."""


@dataclass(frozen=True, eq=False)
class Drawing:
    """One view of a plan: x right, y up, the blank's lower left corner at 0, 0."""

    name: str
    width: float
    height: float
    note: str
    groups: tuple[Group, ...]


def drawings(plan: Plan) -> Iterator[Drawing]:
    """Yield one drawing per face that is worked on, as the machine sees it, then the master."""
    for work in plan.passes:
        yield _drawing(plan, work.face.value, (work.face,), mirror=work.face is Face.REVERSE)
    yield _drawing(plan, "master", tuple(Face), mirror=False)


def layer_of(role: Role, face: Face) -> Layer:
    """Return the layer of a role; scores, the witness mark among them, have one for each face."""
    score = "SCORE_FRONT" if face is Face.FRONT else "SCORE_BACK"
    return _BY_NAME[_CUTS.get(role, score)]


def anchors(width: float, height: float) -> list[Floats]:
    """Return the corner marks of a blank: four angles (3, 2), mm."""
    marks = []
    for x, inward in ((0.0, 1), (width, -1)):
        for y, upward in ((0.0, 1), (height, -1)):
            arms = [(x + inward * ANCHOR_ARM, y), (x, y), (x, y + upward * ANCHOR_ARM)]
            marks.append(np.array(arms))
    return marks


def is_closed(line: Floats) -> bool:
    """Tell whether a line (n, 2) ends where it begins."""
    return len(line) > 3 and bool((line[0] == line[-1]).all())


def _drawing(plan: Plan, name: str, faces: tuple[Face, ...], *, mirror: bool) -> Drawing:
    found: dict[str, list[tuple[SetUp, Stroke]]] = {}
    for face, setup, operation in _operations(plan):
        if face in faces:
            lines = found.setdefault(layer_of(operation.role, face).name, [])
            lines += [(setup, stroke) for stroke in operation.strokes]
    groups = tuple(
        Group(layer, found[layer.name][0][0], _lines(plan, found[layer.name], mirror=mirror))
        for layer in LAYERS
        if found.get(layer.name)
    )
    return Drawing(name, plan.sheet.width, plan.sheet.height, _note(plan, name), groups)


def _operations(plan: Plan) -> Iterator[tuple[Face, SetUp, Operation]]:
    for work in plan.passes:
        for setup in work.setups:
            for operation in setup.operations:
                yield work.face, setup, operation


def _lines(plan: Plan, strokes: list[tuple[SetUp, Stroke]], *, mirror: bool) -> tuple[Floats, ...]:
    points = (np.asarray(stroke.points, float) for _, stroke in strokes)
    return tuple(flipped(line, plan.flip) if mirror else line for line in points)


def _note(plan: Plan, name: str) -> str:
    said = {
        "front": "FRONT, this face up",
        "reverse": f"REVERSE, this face up, turned over {plan.flip.kind}",
        "master": "BOTH FACES seen from the front, for looking at only",
    }
    return f"{plan.title}: {said[name]}"
