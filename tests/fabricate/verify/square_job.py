"""A job worked out by hand, and an HP-GL writer of its own: no planner, no format takes part.

A square of 100 mm, turned by 30°, lies in the middle of a blank of 260 × 240 mm. Four creases meet
in it off its centre, a fifth line is flat, and a slit runs in from the right.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
from itertools import pairwise
from math import cos, hypot, pi, radians, sin

from foldmill import CreasePattern, installed
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import (
    XY,
    Face,
    Figures,
    Fit,
    Flip,
    Gate,
    Hole,
    Operation,
    Pass,
    Placement,
    Plan,
    ProgramFile,
    Role,
    SetUp,
    Sheet,
    Stroke,
    Tie,
)

ONE_TOOL, PENS = "generic-hpgl-600", "generic-hpgl-pens"
WIDTH, HEIGHT = 260.0, 240.0
ANGLE, DX, DY = 30.0, 111.7, 51.7
SETBACK = 0.75
VERTICES = [(0, 0), (100, 0), (100, 100), (0, 100), (40, 45), (60, 0), (100, 60), (80, 60)]
LINES = "05B 51B 16B 62B 23B 30B 04M 14V 24M 34V 54F 76C 74F"
HOLES = {
    "left-right": ((20, 20), (240, 20), (35, 220), (225, 220)),
    "end-over-end": ((20, 20), (20, 220), (240, 35), (240, 205)),
}


@dataclass(frozen=True)
class Job:
    """A plan, its pattern and its programs."""

    plan: Plan
    pattern: CreasePattern
    programs: Mapping[str, bytes]


def pattern() -> CreasePattern:
    edges = [(int(word[0]), int(word[1])) for word in LINES.split()]
    return CreasePattern.from_lines(VERTICES, edges, [word[2] for word in LINES.split()])


def machine(slug: str) -> Machine:
    found: Machine = installed().get("foldmill_machines", "machine", slug)
    return found


def material() -> Material:
    found: Material = installed().get("foldmill_materials", "material", "pp-0.75")
    return found


def job(slug: str = ONE_TOOL, flip: str = "left-right", fit: Fit | None = None) -> Job:
    """Return the job with programs written here, recorded in the plan."""
    made = plan(machine(slug), flip)
    return recorded(Job(made, pattern(), emit(made, fit)))


def recorded(found: Job) -> Job:
    """Record the programs in the plan, as if they had been written like this."""
    files = tuple(
        file.model_copy(update={"sha256": hashlib.sha256(found.programs[file.name]).hexdigest()})
        for file in files_of(found.plan)
        if file.name in found.programs
    )
    return Job(found.plan.model_copy(update={"programs": files}), found.pattern, found.programs)


def files_of(made: Plan) -> list[ProgramFile]:
    by_hand = made.machine.tools.change == "operator"
    found = []
    for side in made.passes:
        groups = [[setup] for setup in side.setups] if by_hand else [list(side.setups)]
        for group in groups:
            name = f"{group[0].number}-{group[0].name}" if by_hand else str(side.face)
            numbers = tuple(setup.number for setup in group)
            found.append(
                ProgramFile(name=f"{name}.hpgl", face=side.face, setups=numbers, sha256="")
            )
    return found


def on_sheet(x: float, y: float) -> XY:
    turn = radians(ANGLE)
    return DX + x * cos(turn) - y * sin(turn), DY + x * sin(turn) + y * cos(turn)


def plan(used: Machine, flip: str) -> Plan:
    outline, ties = _outline()
    holes = tuple(Hole(x=x, y=y, diameter=5) for x, y in HOLES[flip])
    slit = _operation(Role.CUT_INNER, [(on_sheet(*VERTICES[7]), on_sheet(*VERTICES[6]))])
    f_mark = [((120, 200), (120, 212)), ((120, 212), (128, 212)), ((120, 207), (126, 207))]
    front = [
        _setup(1, "front-holes", used, _operation(Role.HOLE, [_ring(hole) for hole in holes])),
        _setup(2, "front-score", used, _operation(Role.WITNESS, f_mark), _scores((0, 2))),
    ]
    reverse = [
        _setup(3, "reverse-score", used, _scores((1, 3))),
        _setup(4, "reverse-cut", used, slit, _operation(Role.CUT_OUTER, outline)),
    ]
    return Plan(
        title="A square",
        pattern_sha256="",
        material=material(),
        machine=used,
        sheet=Sheet(
            width=WIDTH, height=HEIGHT, carrier_width=300, carrier_height=280, dx=20, dy=15
        ),
        placement=Placement(angle=ANGLE, dx=DX, dy=DY),
        flip=Flip.model_validate(
            {"kind": flip, "axis": WIDTH / 2 if flip == "left-right" else HEIGHT / 2}
        ),
        holes=holes,
        ties=ties,
        passes=(
            Pass(face=Face.FRONT, setups=tuple(front)),
            Pass(face=Face.REVERSE, setups=tuple(reverse)),
        ),
        figures=Figures(strokes=0, lifts=0, drawn=0, travel=0, travel_bound=0, seconds=0),
    )


def _scores(corners: tuple[int, int]) -> Operation:
    """The creases from two corners to the inner vertex, where four meet: all stop short of it."""
    return _operation(Role.SCORE, [_score(corner) for corner in corners])


def _score(corner: int) -> tuple[XY, XY]:
    (x, y), (u, v) = VERTICES[corner], VERTICES[4]
    share = 1 - SETBACK / hypot(u - x, v - y)
    return on_sheet(x, y), on_sheet(x + share * (u - x), y + share * (v - y))


def _outline() -> tuple[list[tuple[XY, ...]], tuple[Tie, ...]]:
    """Four ties, one on each side; between them the outline turns a corner."""
    middles = [(30, 0), (100, 30), (50, 100), (0, 50)]
    along = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    corners = [(100, 0), (100, 100), (0, 100), (0, 0)]
    strokes = []
    for k in range(4):
        (x, y), (u, v) = middles[k], along[k]
        (p, q), (s, t) = middles[(k + 1) % 4], along[(k + 1) % 4]
        path = [(x + 0.3 * u, y + 0.3 * v), corners[k], (p - 0.3 * s, q - 0.3 * t)]
        strokes.append(tuple(on_sheet(*point) for point in path))
    ties = [on_sheet(*point) for point in middles]
    return strokes, tuple(Tie(x=x, y=y, width=0.6) for x, y in ties)


def _ring(hole: Hole, sides: int = 30) -> tuple[XY, ...]:
    turns = [2 * pi * (k % sides) / sides for k in range(sides + 1)]
    return tuple((hole.x + 2.5 * cos(turn), hole.y + 2.5 * sin(turn)) for turn in turns)


def _operation(role: Role, lines: Sequence[tuple[XY, ...]]) -> Operation:
    scored = role in {Role.SCORE, Role.WITNESS}
    return Operation(
        role=role,
        repeats=2 if scored else 6,
        overcut=0.0 if scored else 1.0,
        strokes=tuple(Stroke(points=line) for line in lines),
    )


def _setup(number: int, name: str, used: Machine, *operations: Operation) -> SetUp:
    scored = name.endswith("score")
    process = material().score if scored else material().cut
    gates = {1: (Gate.LOAD, Gate.TOOL), 2: (Gate.TOOL,), 3: (Gate.FLIP,), 4: (Gate.TOOL,)}[number]
    by_hand = used.tools.change == "operator"
    return SetUp(
        number=number,
        name=name,
        process="score" if scored else "cut",
        tool=used.tools.station(process.kind),
        exposure=process.exposure,
        force=min(process.force, used.tools.max_force or 0.0),
        speed=process.speed,
        gates=gates if by_hand else tuple(gate for gate in gates if gate is not Gate.TOOL),
        operations=operations,
    )


def emit(made: Plan, fit: Fit | None = None) -> dict[str, bytes]:
    """Write the programs of a plan: a second writer, with decimal rounding."""
    setups = {setup.number: setup for side in made.passes for setup in side.setups}
    programs = {}
    for file in files_of(made):
        body = "".join(_setup_text(made, file.face, setups[number], fit) for number in file.setups)
        programs[file.name] = f"IN;DF;PA;PU;{body}PU;SP0;".encode()
    return programs


def _setup_text(made: Plan, face: Face, setup: SetUp, fit: Fit | None) -> str:
    text = f"PU;SP{setup.tool};VS{setup.speed / 10:.0f};FS{setup.force:.0f};\n"
    for operation in setup.operations:
        for stroke in operation.strokes:
            path = way(list(stroke.points), operation.repeats, operation.overcut)
            pairs = [_steps(made, face, x, y, fit) for x, y in path]
            text += f"PU{pairs[0]};PD{','.join(pairs[1:])};\n"
    return text


def way(points: list[XY], repeats: int, overcut: float) -> list[XY]:
    """There and back; or round and round, and a little further."""
    if points[0] != points[-1]:
        path = list(points)
        for lap in range(1, repeats):
            path += (points if lap % 2 == 0 else points[::-1])[1:]
        return path
    path = points + points[1:] * (repeats - 1)
    for (x, y), (u, v) in pairwise(points):
        length = hypot(u - x, v - y)
        share = min(1.0, overcut / length)
        path.append((x + share * (u - x), y + share * (v - y)))
        overcut -= length
        if overcut <= 1e-9:
            break
    return path


def _steps(made: Plan, face: Face, x: float, y: float, fit: Fit | None) -> str:
    if face is Face.REVERSE and made.flip.kind == "left-right":
        x = 2 * made.flip.axis - x
    if face is Face.REVERSE and made.flip.kind == "end-over-end":
        y = 2 * made.flip.axis - y
    x, y = x + made.sheet.dx, y + made.sheet.dy
    if face is Face.REVERSE and fit is not None:
        turn = radians(fit.angle)
        x, y = x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn)
        x, y = x + fit.dx, y + fit.dy
    axes = made.machine.axes
    pair = (y, x) if axes.swap else (x, y)
    return ",".join(str(_whole(value * axes.units_per_mm)) for value in pair)


def _whole(value: float) -> int:
    return int(Decimal(value).quantize(Decimal(1), ROUND_HALF_UP))
