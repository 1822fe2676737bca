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

from foldmill_fabricate.kinds import Kind
from foldmill_fabricate.passes import Face, Operation, Plan, Role, SetUp, Stroke
from foldmill_fabricate.profiles import Layer, Layers, Profile, find
from foldmill_fabricate.sheet import flipped

Floats = NDArray[np.float64]

ANCHOR_ARM = 5.0
"""mm. Length of the arms of a corner anchor."""
NOTE_HEIGHT = 3.5
"""mm. Height of a note's capitals."""
NOTE_AT = (8.0, 2.0)
"""mm. Left end of a note's baseline: below the holes, right of the corner's anchor."""


_CUTS = {
    Role.HOLE: "holes",
    Role.MARK: "holes",
    Role.RELIEF: "cut_inner",
    Role.CUT_INNER: "cut_inner",
    Role.CUT_OUTER: "cut_outer",
}
_PRESSED = frozenset({"crease-wheel", "stylus", "pen"})


@dataclass(frozen=True, eq=False)
class Group:
    """The lines of one layer, each once however often the knife repeats it."""

    layer: Layer
    setup: SetUp | None
    """The first set-up that works on this layer; its tool, speed and force go with it. None where
    nothing is worked."""
    lines: tuple[Floats, ...]
    """Each (n, 2) mm; a closed line ends where it begins."""
    key: str = ""
    """What the layer is for: its field in ``Layers``."""


@dataclass(frozen=True, eq=False)
class Drawing:
    """One view of a plan: x right, y up, the blank's lower left corner at 0, 0."""

    name: str
    width: float
    height: float
    note: str
    groups: tuple[Group, ...]
    layers: Layers


def drawings(plan: Plan, profile: Profile | None = None) -> Iterator[Drawing]:
    """Yield one drawing per face that is worked on, as the machine sees it, then the master."""
    layers = (profile or find()).layers
    for work in plan.passes:
        mirror = work.face is Face.REVERSE
        yield _drawing(plan, layers, work.face.value, (work.face,), mirror=mirror)
    yield _drawing(plan, layers, "master", tuple(Face), mirror=False)


def layer_of(role: Role, face: Face, kind: Kind) -> str:
    """Return the key of a role's layer; scores of this kind, the witness mark among them, have one
    for each face, but for a perforation, which goes through.
    """
    if role in _CUTS:
        return _CUTS[role]
    if kind == "perforation":
        return "perforation"
    made = "crease" if kind in _PRESSED else "score"
    return f"{made}_{'front' if face is Face.FRONT else 'back'}"


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


def _drawing(
    plan: Plan, layers: Layers, name: str, faces: tuple[Face, ...], *, mirror: bool
) -> Drawing:
    found: dict[str, list[tuple[SetUp, Stroke]]] = {}
    for face, setup, operation in _operations(plan):
        if face in faces:
            key = layer_of(operation.role, face, plan.material.score.kind)
            found.setdefault(key, []).extend((setup, stroke) for stroke in operation.strokes)
    groups = tuple(
        Group(getattr(layers, key), found[key][0][0], _lines(plan, found[key], mirror=mirror), key)
        for key in Layers.model_fields
        if found.get(key)
    )
    note = _note(plan, name)
    return Drawing(name, plan.sheet.width, plan.sheet.height, note, groups, layers)


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
