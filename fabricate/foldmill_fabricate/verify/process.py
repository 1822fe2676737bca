"""The order of work, and that each set-up does what the material's preset says."""

from __future__ import annotations

from itertools import pairwise

from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import Perforation, ThroughCut
from foldmill_fabricate.passes import Face, Gate, Operation, Plan, Role, SetUp
from foldmill_fabricate.verify.forces import settable
from foldmill_fabricate.verify.virtual_sheet import modelled_offset

_PROCESS = {
    Role.HOLE: "cut",
    Role.MARK: "cut",
    Role.VERNIER: "cut",
    Role.WITNESS: "score",
    Role.LABEL: "score",
    Role.RULER: "score",
    Role.SCORE: "score",
    Role.RELIEF: "cut",
    Role.CUT_INNER: "cut",
    Role.CUT_OUTER: "cut",
}
_FIRST = (Role.HOLE, Role.MARK, Role.WITNESS)
_LAST = (Role.RELIEF, Role.CUT_INNER, Role.CUT_OUTER)
_ORDER = list(Role)
_SUPERFLUOUS = {
    Gate.FLIP: "The sheet is turned over here, and the face stays the same.",
    Gate.LOAD: "A new sheet is loaded here, with the work on the last one half done.",
    Gate.RE_REGISTER: "A sheet comes back here that was never left.",
    Gate.REMOVE: "The sheet is taken off here, before this set-up has been done.",
}


def prove_process(plan: Plan) -> list[Finding]:
    """Check passes, order of roles, gates, and each set-up's values."""
    found = prove_order(plan)
    for setup in (setup for side in plan.passes for setup in side.setups):
        found += _value_findings(plan, setup)
    return found


def prove_order(plan: Plan) -> list[Finding]:
    """Check passes, order of roles, gates, and that the processes suit material and machine."""
    return [*_pass_findings(plan), *prove_work(plan), *_depth_findings(plan)]


def prove_work(plan: Plan) -> list[Finding]:
    """Check that set-ups are numbered in order of work, and what the operator does before each."""
    setups = [(side.face, setup) for side in plan.passes for setup in side.setups]
    found = []
    numbers = [setup.number for _, setup in setups]
    if numbers != list(range(1, len(numbers) + 1)):
        text = f"The set-ups are numbered {numbers}, not 1, 2, 3 … in order of work."
        found.append(_error("set-ups", "plan", text))
    return found + _gate_findings(plan, setups)


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def _pass_findings(plan: Plan) -> list[Finding]:
    faces = [side.face for side in plan.passes]
    found = []
    if faces not in ([Face.FRONT], [Face.REVERSE], [Face.FRONT, Face.REVERSE]):
        text = f"The passes are {', '.join(faces) or 'none'}; it is the front, then the reverse."
        found.append(_error("passes", "plan", text))
    for k, side in enumerate(plan.passes):
        roles = [operation.role for setup in side.setups for operation in setup.operations]
        roles = [role for role in roles if role is not Role.VERNIER]  # cut with whatever is cut
        where = f"{side.face} pass"
        for before, after in pairwise(roles):
            if _ORDER.index(after) < _ORDER.index(before):
                text = f"{_plural(after)} come after {_plural(before)}; they must come before."
                found.append(_error("order", where, text))
        for role in roles:
            if role in _FIRST and k > 0:
                text = f"{_plural(role)} belong on the first pass."
                found.append(_error("order", where, text))
            if role in _LAST and k < len(plan.passes) - 1:
                text = f"{_plural(role)} belong on the last pass, so that the sheet holds together."
                found.append(_error("order", where, text))
    return found


def _plural(role: Role) -> str:
    return {
        Role.HOLE: "Holes",
        Role.MARK: "Registration marks",
        Role.VERNIER: "Vernier lines",
        Role.WITNESS: "Witness marks",
        Role.LABEL: "Words",
        Role.RULER: "Lines to measure by",
        Role.SCORE: "Scores",
        Role.RELIEF: "Relief holes",
        Role.CUT_INNER: "Inner cuts",
        Role.CUT_OUTER: "Outline cuts",
    }[role]


def _gate_findings(plan: Plan, setups: list[tuple[Face, SetUp]]) -> list[Finding]:
    """Check that the operator is asked to load, to turn the sheet, and to change the tool."""
    found = []
    by_hand = plan.machine.tools.change == "operator"
    for k, (face, setup) in enumerate(setups):
        before = setups[k - 1] if k else None
        needed = []
        if before is None:
            needed.append(Gate.RE_REGISTER if plan.remakes else Gate.LOAD)
        elif before[0] is not face:
            needed.append(Gate.FLIP)
        if by_hand and (before is None or _tooling(before[1]) != _tooling(setup)):
            needed.append(Gate.TOOL)
        found += [
            _error("missing-gate", f"set-up {setup.number}", f"The gate {gate!s} is missing.")
            for gate in needed
            if gate not in setup.gates
        ]
        for gate, text in _SUPERFLUOUS.items():
            if gate in setup.gates and gate not in needed:
                found.append(_error("wrong-gate", f"set-up {setup.number}", text))
        found += [
            _error("wrong-gate", f"set-up {setup.number}", f"The gate {gate!s} stands there twice.")
            for gate in needed
            if setup.gates.count(gate) > 1
        ]
    return found


def _depth_findings(plan: Plan) -> list[Finding]:
    """Check that a score leaves its web, and that a cut goes through."""
    material, score, cut = plan.material, plan.material.score, plan.material.cut
    found = _offered(plan)
    if isinstance(score, Perforation) and score.exposure < material.thickness:
        text = f"The blade stands out {score.exposure:g} mm to perforate "
        text += f"{material.thickness:g} mm of material."
        found.append(_error("score-depth", material.slug, text))
    most = material.thickness - score.web_min
    if score.web_min and score.exposure > most:
        text = f"The blade stands out {material.score.exposure:g} mm for scores in "
        text += f"{material.thickness:g} mm of material; more than {most:g} mm cuts its web."
        found.append(_error("score-depth", material.slug, text))
    if isinstance(cut, ThroughCut) and cut.exposure < material.thickness:
        text = f"The blade stands out {cut.exposure:g} mm for cuts; the material is "
        text += f"{material.thickness:g} mm thick."
        found.append(_error("cut-depth", material.slug, text))
    if not isinstance(cut, ThroughCut):
        found += _whole_sheet(plan)
    return found


def _offered(plan: Plan) -> list[Finding]:
    """Check that the machine has what both processes take."""
    return [
        _error("not-offered", plan.machine.slug, f"This machine offers no {process.title}.")
        for process in (plan.material.score, plan.material.cut)
        if process.kind not in plan.machine.tools.stations
    ]


def _whole_sheet(plan: Plan) -> list[Finding]:
    """Check that nothing is asked to go through the sheet where the tool does not."""
    exposure, thickness = plan.material.cut.exposure, plan.material.thickness
    found = []
    if exposure >= thickness:
        text = f"The blade stands out {exposure:g} mm for the outline, and the sheet is "
        found.append(_error("cut-depth", plan.material.slug, f"{text}{thickness:g} mm thick."))
    through = {op.role for side in plan.passes for s in side.setups for op in s.operations}
    for role in sorted(through & {Role.HOLE, Role.MARK, Role.RELIEF}):
        text = f"{_plural(role)} go through the sheet; {plan.material.cut.title} does not."
        found.append(_error("wrong-process", "plan", text))
    return found


def _tooling(setup: SetUp) -> tuple[str, int, float]:
    return setup.process, setup.tool, setup.exposure


def _value_findings(plan: Plan, setup: SetUp) -> list[Finding]:
    """Compare tool, exposure, force and speed with the presets of material and machine."""
    tools = plan.machine.tools
    process = plan.material.score if setup.process == "score" else plan.material.cut
    wanted = {
        "tool": (setup.tool, tools.stations.get(process.kind, 0)),
        "exposure": (setup.exposure, process.exposure),
        "force": (setup.force, settable(process.force, tools)),
        "speed": (setup.speed, process.speed),
        "swivel force": (setup.swivel_force, _swivel_force(plan, setup)),
    }
    where = f"set-up {setup.number} ({setup.name})"
    found = [
        _error("set-up-values", where, f"Its {what} is {given:g}, not {right:g}.")
        for what, (given, right) in wanted.items()
        if given != right
    ]
    for operation in setup.operations:
        found += _operation_findings(setup, operation, process.repeats, process.overcut, where)
    return found


def _swivel_force(plan: Plan, setup: SetUp) -> float:
    """Return with which force a blade is turned out of its cut: where a program can do that."""
    steered = modelled_offset(plan.machine) > 0
    possible = steered and plan.machine.dialect.force and setup.process == "cut"
    return plan.material.cut.swivel_force if possible else 0.0


def _operation_findings(
    setup: SetUp, operation: Operation, repeats: int, overcut: float, where: str
) -> list[Finding]:
    found = []
    if _PROCESS[operation.role] != setup.process:
        text = f"{_plural(operation.role)} do not belong in a set-up that {setup.process}s."
        found.append(_error("wrong-process", where, text))
    if operation.repeats != repeats:
        text = f"{_plural(operation.role)} are repeated {operation.repeats} times, not {repeats}."
        found.append(_error("set-up-values", where, text))
    closed = any(stroke.closed for stroke in operation.strokes)
    if operation.overcut > 0 and _PROCESS[operation.role] == "score":
        text = f"{_plural(operation.role)} run {operation.overcut:g} mm past their ends, into what "
        found.append(_error("overcut-on-score", where, f"{text}they must not touch."))
    elif closed and operation.overcut != overcut:
        text = f"The overcut of closed strokes is {operation.overcut:g} mm, not {overcut:g} mm."
        found.append(_error("set-up-values", where, text))
    return found
