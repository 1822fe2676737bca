"""What the job sheet says, as plain words and rows; nothing here knows where it stands on paper."""

from __future__ import annotations

from itertools import combinations
from math import dist

from foldmill import CreasePattern
from foldmill.finding import Severity
from foldmill.tolerances import CLOSED_DEG
from foldmill_fabricate.formats.programs import layout
from foldmill_fabricate.passes import Face, Gate, Pass, Plan, SetUp
from foldmill_fabricate.sheet import flipped, seen_by_machine

Row = tuple[str, ...]

SETUP_HEAD: Row = ("", "face up", "process", "SP", "blade", "force", "speed", "repeats", "program")
HOLE_HEAD: Row = ("hole", "on the front", "after the flip", "after the flip, on the machine")

SAID_BY_WARNINGS = frozenset({"untested-material", "through-cut-marginal"})
"""Findings that ``warnings`` puts into the operator's words."""


def summary(plan: Plan) -> str:
    """Return which pattern on which sheet, and how long the machine moves."""
    size = plan.sheet
    copies = f"{plan.quantity} copies   " if plan.quantity > 1 else ""
    return (
        f"{copies}Pattern {plan.pattern_sha256[:12]}   Sheet {size.width:g} × {size.height:g} mm "
        f"{_lies(plan)} {size.carrier_width:g} × {size.carrier_height:g} mm, {_mass(plan):.0f} g   "
        f"About {max(1, round(plan.figures.seconds / 60))} min of motion"
    )


def travel(plan: Plan) -> str:
    """Return how far the tool goes while up, and how much of that any order would; or nothing."""
    figures = plan.figures
    if figures.travel_gap is None:
        return ""
    return (
        f"Of the way, {figures.drawn / 1000:.1f} m are drawn and {figures.travel / 1000:.2f} m "
        f"gone with the tool up; {figures.travel_bound / 1000:.2f} m are so in any order."
    )


def _lies(plan: Plan) -> str:
    return "on a bed of" if plan.machine.bed.pull else "on a mat of"


def _mass(plan: Plan) -> float:
    """Return the weight of the blank, g."""
    volume = plan.sheet.width * plan.sheet.height * plan.material.thickness
    return plan.material.density * volume / 1000


def setup_rows(plan: Plan) -> list[tuple[Row, str]]:
    """Return per set-up the table's row and what to do before it, in order of work."""
    programs = {n: part.name for part in layout(plan) for n in part.setups}
    return [
        (
            _setup_row(plan, work, setup, programs.get(setup.number, "–")),
            before(plan, work.face, setup),
        )
        for work in plan.passes
        for setup in work.setups
    ]


def _setup_row(plan: Plan, work: Pass, setup: SetUp, program: str) -> Row:
    process = plan.material.score if setup.process == "score" else plan.material.cut
    repeats = sorted({operation.repeats for operation in setup.operations})
    return (
        str(setup.number),
        work.face.value.upper(),
        process.title,
        str(setup.tool) if setup.tool else "–",
        f"{setup.exposure:g} mm",
        f"{setup.force:g} gf",
        f"{setup.speed / 10:g} cm/s",
        "/".join(str(each) for each in repeats),
        program,
    )


def before(plan: Plan, face: Face, setup: SetUp) -> str:
    """Return what the operator does before a set-up starts; empty where that is nothing."""
    doing = {
        Gate.LOAD: f"load the sheet, {face} up, lower left corner at {_corner(plan)}",
        Gate.TOOL: _tooling(plan, setup),
        Gate.FLIP: f"turn the sheet over {plan.flip.kind} as drawn below, and find the marks",
    }
    return "; ".join(doing[gate] for gate in setup.gates)


def _tooling(plan: Plan, setup: SetUp) -> str:
    """Return how the tool is set, depth first where depth is what counts."""
    process = plan.material.score if setup.process == "score" else plan.material.cut
    tools = plan.machine.tools
    power = "find power and speed on waste"
    if tools.max_force is not None:
        units = plan.machine.language != "hpgl"
        own = f" ({setup.force / tools.force_unit:.0f} of its own units)" if units else ""
        pace = f", the speed to {setup.speed / tools.speed_unit:.2g}" if units else ""
        power = f"the force to {setup.force:g} gf{own}{pace}"
    if not setup.exposure:
        return f"take the tool for {process.title}, set {power}"
    angle = f" ({process.blade_angle:g}°)" if process.blade_angle else ""
    if process.limited_by == "z":
        return f"set the tool{angle} {setup.exposure:g} mm deep in z, {power}"
    return f"set the blade{angle} to stand out {setup.exposure:g} mm, {power}"


def _corner(plan: Plan) -> str:
    where = "bed" if plan.machine.bed.pull else "mat"
    return f"x {plan.sheet.dx:g}, y {plan.sheet.dy:g} mm of the {where}"


def hole_rows(plan: Plan) -> list[Row]:
    """Return per hole its middle on the front, after the flip, and then on the machine, mm."""
    rows = []
    for number, hole in enumerate(plan.holes, start=1):
        seen = flipped([(hole.x, hole.y)], plan.flip)
        found = seen_by_machine(plan, Face.REVERSE, [(hole.x, hole.y)])
        spots = ([hole.x, hole.y], seen[0], found[0])
        rows.append((str(number), *(f"{x:.2f}, {y:.2f}" for x, y in spots)))
    return rows


def farthest_holes(plan: Plan) -> str:
    """Return a sentence to check the machine's scale by; empty with less than two holes."""
    if len(plan.holes) < 2:
        return ""
    numbered = enumerate(plan.holes, start=1)
    (a, one), (b, two) = max(
        combinations(numbered, 2), key=lambda pair: round(_apart(pair[0][1], pair[1][1]), 6)
    )
    return (
        f"Check the machine's scale before the flip: the middles of holes {a} and {b} are "
        f"{_apart(one, two):.2f} mm apart."
    )


def _apart(one: object, two: object) -> float:
    return dist((one.x, one.y), (two.x, two.y))  # type: ignore[attr-defined]


def warnings(plan: Plan, pattern: CreasePattern) -> list[str]:
    """Return what must not be overlooked, most important first."""
    said = []
    if not (plan.material.tested and plan.machine.verified):
        said.append(
            "Untested: depth, force, speed and repeats are starting values. Cut a coupon of the "
            "same sheet and bend it before you trust them."
        )
    cut, strongest = plan.material.cut, plan.machine.tools.max_force
    if strongest is not None and strongest < cut.force_needed:
        said.append(
            f"This machine presses with {strongest:g} gf at most; cutting "
            f"{plan.material.thickness:g} mm through takes about {cut.force_needed:g} gf, so it "
            f"may not get through. Then treat the outline as a deep score and snap it, or finish "
            f"it with a knife by hand along a ruler; punch the holes by hand."
        )
    offset = plan.machine.tools.host_offset
    if offset:
        said.append(
            f"The programs lead the knife's holder, not its tip: they are for a blade whose tip "
            f"trails {offset:g} mm behind the holder's axis. Measure yours, set the machine's own "
            f"offset to 0, and expect a small angle cut in the waste before each set-up."
        )
    if plan.machine.bed.pull:
        said.append(
            "Feed the sheet without a mat: the tool pulls it and never "
            "pushes it, so it lifts and goes back before each repeat, and rings are cut in halves."
        )
    closed = sum(abs(angle) >= 180 - CLOSED_DEG for angle in pattern.fold_angles.tolist())
    if closed:
        said.append(
            f"The {closed} creases that close to 180° are single scores for now, without room for "
            f"the sheet's thickness: expect them to stand a little open."
        )
    return said


def findings(plan: Plan) -> list[str]:
    """Return what planning found beyond the warnings: one sentence per kind, the first of each."""
    kinds: dict[str, list[str]] = {}
    for finding in plan.findings:
        if finding.severity is not Severity.INFO and finding.code not in SAID_BY_WARNINGS:
            kinds.setdefault(finding.code, []).append(str(finding))
    return [
        first + (f" ({len(more)} more of this kind in plan.json.)" if more else "")
        for first, *more in kinds.values()
    ]


def temperature(plan: Plan) -> str:
    """Return why both passes belong into one session, with a place for the temperatures."""
    if len(plan.passes) < 2:
        return "Temperature: ____ °C."
    span = max(plan.sheet.width, plan.sheet.height)
    drift = plan.material.expansion * 1e-6 * span
    front, reverse = ("____", "____") if plan.temperatures is None else plan.temperatures
    return (
        f"Do both passes in one session: the sheet moves by {drift:.2f} mm/°C over {span:g} mm. "
        f"Temperature: front {front} °C, reverse {reverse} °C."
    )
