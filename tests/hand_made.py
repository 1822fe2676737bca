"""A small job made by hand: a sheet with one mountain, one valley and a slot.

Nothing here comes from the planner, so that writers, pictures and job sheet are tested alone. All
lengths are mm. The part is a 60 × 40 rectangle at (20, 20) on a blank of 100 × 80; its mountain is
scored on the front, its valley on the reverse.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from foldmill import CreasePattern, Fold, FoldedForm
from foldmill_fabricate import machines, materials, presets
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import (
    XY,
    Face,
    Figures,
    Flip,
    Gate,
    Hole,
    Operation,
    Pass,
    Placement,
    Plan,
    Role,
    SetUp,
    Sheet,
    Stroke,
    Tie,
)

WIDTH, HEIGHT, MARGIN = 100.0, 80.0, 10.0
HOLES = tuple(Hole(x=x, y=y, diameter=5) for x, y in ((12, 11), (88, 11), (18, 69), (82, 69)))
MOUNTAIN = ((40.0, 20.0), (40.0, 60.0))
VALLEY = ((60.0, 60.0), (60.0, 20.0))
SLOT = ((45.0, 35.0), (55.0, 35.0), (55.0, 36.3125), (45.0, 36.3125), (45.0, 35.0))
WITNESS = ((30.0, 70.0), (36.0, 70.0), (36.0, 74.0))
OUTLINE = (
    ((50.3, 20.0), (80.0, 20.0), (80.0, 60.0), (50.3, 60.0)),
    ((49.7, 60.0), (20.0, 60.0), (20.0, 20.0), (49.7, 20.0)),
)
FLIP_AXIS = {"left-right": WIDTH / 2, "end-over-end": HEIGHT / 2}


def machine(slug: str = "generic-hpgl-600", **changes: object) -> Machine:
    """Return a shipped machine, some of its parts replaced."""
    shipped = presets.shipped(Machine, machines.__name__)
    found = next(each for each in shipped if each.slug == slug)
    return found.model_copy(update=changes)


def material() -> Material:
    """Return the shipped polypropylene."""
    shipped = presets.shipped(Material, materials.__name__)
    return next(each for each in shipped if each.slug == "pp-0.75")


def fold() -> Fold:
    """Return the folded strip: its thirds stand up at right angles, one to each side."""
    x, y = (0.0, 20.0, 40.0, 60.0), (0.0, 40.0)
    flat = [(a, b) for b in y for a in x]
    edges = [(0, 1), (1, 2), (2, 3), (4, 5), (5, 6), (6, 7), (0, 4), (3, 7), (1, 5), (2, 6)]
    angles = [0.0] * 8 + [-90.0, 90.0]
    pattern = CreasePattern.from_lines(flat, edges, "B" * 8 + "MV", angles)
    rise = {0.0: (20.0, -20.0), 20.0: (20.0, 0.0), 40.0: (40.0, 0.0), 60.0: (40.0, 20.0)}
    spatial = [(rise[a][0], b, rise[a][1]) for a, b in flat]
    return Fold(pattern, FoldedForm(np.array(spatial)), meta={"title": "Hand-made strip"})


def plan(tool: Machine | None = None, kind: str = "left-right", carrier: float = 120.0) -> Plan:
    """Return the whole job; ``kind`` is how the sheet is turned over."""
    used = tool or machine()
    return Plan(
        title="Hand-made strip",
        pattern_sha256="0123456789abcdef" * 4,
        material=material(),
        machine=used,
        sheet=Sheet(
            width=WIDTH,
            height=HEIGHT,
            carrier_width=carrier,
            carrier_height=carrier,
            dx=MARGIN,
            dy=MARGIN,
        ),
        placement=Placement(angle=0, dx=20, dy=20),
        flip=Flip.model_validate({"kind": kind, "axis": FLIP_AXIS[kind]}),
        holes=HOLES,
        ties=(Tie(x=50, y=20, width=0.6), Tie(x=50, y=60, width=0.6)),
        passes=(_front(used), _reverse(used)),
        figures=Figures(strokes=9, lifts=9, drawn=1000, travel=300, travel_bound=250, seconds=61),
    )


def circle(hole: Hole, sides: int = 24) -> tuple[XY, ...]:
    """Return a hole as a closed polygon."""
    radius = hole.diameter / 2
    turns = [2 * pi * (k % sides) / sides for k in range(sides + 1)]
    return tuple((hole.x + radius * cos(t), hole.y + radius * sin(t)) for t in turns)


def plan_extent(of: Plan, face: Face) -> tuple[float, float, float, float]:
    """Return x0, y0, x1, y1 of everything done to a face, sheet coordinates."""
    xy = [
        point
        for work in of.passes
        if work.face is face
        for setup in work.setups
        for operation in setup.operations
        for stroke in operation.strokes
        for point in stroke.points
    ]
    xs, ys = zip(*xy, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def _front(tool: Machine) -> Pass:
    holes = _operation(Role.HOLE, *(circle(hole) for hole in HOLES))
    scores = (_operation(Role.WITNESS, WITNESS), _operation(Role.SCORE, MOUNTAIN))
    return Pass(
        face=Face.FRONT,
        setups=(
            _setup(1, "front-holes", tool, (Gate.LOAD, Gate.TOOL), holes),
            _setup(2, "front-score", tool, (Gate.TOOL,), *scores),
        ),
    )


def _reverse(tool: Machine) -> Pass:
    cuts = (_operation(Role.CUT_INNER, SLOT), _operation(Role.CUT_OUTER, *OUTLINE))
    score = _operation(Role.SCORE, VALLEY)
    return Pass(
        face=Face.REVERSE,
        setups=(
            _setup(3, "reverse-score", tool, (Gate.FLIP,), score),
            _setup(4, "reverse-cut", tool, (Gate.TOOL,), *cuts),
        ),
    )


def _operation(role: Role, *lines: tuple[XY, ...]) -> Operation:
    scored = role in {Role.SCORE, Role.WITNESS}
    strokes = tuple(Stroke(points=line) for line in lines)
    return Operation(
        role=role,
        repeats=2 if scored else 6,
        overcut=0.0 if scored else 1.0,
        strokes=strokes,
    )


def _setup(
    number: int, name: str, tool: Machine, gates: tuple[Gate, ...], *operations: Operation
) -> SetUp:
    scored = name.endswith("score")
    process = material().score if scored else material().cut
    return SetUp(
        number=number,
        name=name,
        process="score" if scored else "cut",
        tool=tool.tools.station(process.kind),
        exposure=process.exposure,
        force=min(process.force, tool.tools.max_force or 0.0),
        speed=process.speed,
        gates=gates if tool.tools.change == "operator" else gates[:1],
        operations=operations,
    )
