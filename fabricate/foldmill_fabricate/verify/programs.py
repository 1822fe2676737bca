"""Proof one: the programs, replayed on the virtual sheet, draw the plan. Nothing more or less."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Face, Fit, Plan, ProgramFile, Role
from foldmill_fabricate.verify import settings, tolerances
from foldmill_fabricate.verify.copies import prove_turns
from foldmill_fabricate.verify.cover import pairs, pieces, uncovered
from foldmill_fabricate.verify.drawing import Drawing
from foldmill_fabricate.verify.interpreter import Trace
from foldmill_fabricate.verify.languages import replay
from foldmill_fabricate.verify.limits import outside
from foldmill_fabricate.verify.nesting import prove_nesting
from foldmill_fabricate.verify.offsets import wrong_offset
from foldmill_fabricate.verify.planned import SUFFIXES, Planned, at, planned, program_files
from foldmill_fabricate.verify.pulls import pushed
from foldmill_fabricate.verify.steering import steered
from foldmill_fabricate.verify.suspects import find_cause
from foldmill_fabricate.verify.virtual_sheet import Line, modelled_offset, to_carrier


@dataclass(frozen=True, eq=False)
class Replay:
    """A program, what it does, and what it draws beside what it should."""

    file: ProgramFile
    trace: Trace
    drawing: Drawing
    steering: tuple[Finding, ...]
    """What is wrong with how the blade was led."""


@dataclass(frozen=True, eq=False)
class ProgramProof:
    """Everything that proof one found."""

    replays: tuple[Replay, ...]
    findings: tuple[Finding, ...]


def prove_programs(plan: Plan, programs: Mapping[str, bytes], fit: Fit | None) -> ProgramProof:
    """Replay every program of the plan and compare it with the strokes it must draw."""
    strokes = planned(plan)
    files = program_files(plan)
    findings = [*_files_findings(plan, files, programs)]
    replays = []
    for file in files:
        if file.name not in programs:
            continue
        data = programs[file.name]
        findings += _hash_findings(file, data, fit)
        replayed = _replay(plan, file, data, strokes, fit)
        replays.append(replayed)
        findings += [*replayed.trace.findings, *outside(plan, file.name, replayed.trace)]
        findings += [*replayed.steering, *pushed(plan, file.name, replayed.trace)]
        findings += _drawing_findings(plan, replayed, strokes, fit)
        _ = replayed.drawing.deviation
        replayed.drawing.forget()
    return ProgramProof(tuple(replays), tuple(findings))


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def _files_findings(
    plan: Plan, files: Sequence[ProgramFile], programs: Mapping[str, bytes]
) -> list[Finding]:
    found = [
        _error("missing-program", file.name, "This program of the plan is missing.")
        for file in files
        if file.name not in programs
    ]
    known = {file.name for file in files}
    found += [
        Finding(
            "foreign-program", Severity.WARNING, name, "The plan knows nothing of this program."
        )
        for name in sorted(programs)
        if name.endswith(SUFFIXES) and name not in known
    ]
    given = [number for file in files for number in file.setups]
    wanted = [setup.number for side in plan.passes for setup in side.setups]
    if sorted(given) != sorted(wanted):
        text = f"The programs hold the set-ups {given}; the plan has {wanted}."
        found.append(_error("set-ups", "plan", text))
    elif given != wanted:
        text = f"The programs are run in the order {given} of set-ups, not {wanted}."
        found.append(_error("order", "plan", text, "Number the programs in order of work."))
    faces = {setup.number: side.face for side in plan.passes for setup in side.setups}
    for file in files:
        if any(faces.get(number, file.face) is not file.face for number in file.setups):
            text = f"It is said to work on the {file.face}, its set-ups on the other face."
            found.append(_error("wrong-face", file.name, text))
    return found


def _hash_findings(file: ProgramFile, data: bytes, fit: Fit | None) -> list[Finding]:
    """Compare with the recorded SHA-256; a reverse fitted to marks is not the one on record."""
    if not file.sha256 or (fit is not None and file.face is Face.REVERSE):
        return []
    if hashlib.sha256(data).hexdigest() == file.sha256:
        return []
    text = "Its SHA-256 is not the one in plan.json: it was changed after planning."
    return [_error("edited", file.name, text, "Plan again; programs are not edited by hand.")]


def _replay(
    plan: Plan, file: ProgramFile, data: bytes, strokes: Sequence[Planned], fit: Fit | None
) -> Replay:
    trace = replay(data, file.name, plan.machine)
    own = [stroke for stroke in strokes if stroke.setup.number in file.setups]
    drawn = steered(trace, plan, file, fit)
    return Replay(file, trace, Drawing(plan, file.name, drawn.lines, own), drawn.findings)


def _drawing_findings(
    plan: Plan, replay: Replay, strokes: Sequence[Planned], fit: Fit | None
) -> list[Finding]:
    drawing = replay.drawing
    cause = wrong_offset(drawing, replay.file.face, fit) if drawing.faulty_share() else None
    if cause is None and drawing.faulty_share() > tolerances.MISFIT:
        carrier = [to_carrier(line.points, plan, replay.file.face, fit) for line in drawing.lines]
        reach = 2 * drawing.tolerance + modelled_offset(plan.machine)
        cause = find_cause(plan, replay.file, carrier, strokes, fit, reach)
    if cause is not None:
        return [cause.finding(replay.file.name)]
    elsewhere = _elsewhere(replay, strokes)
    found = [*elsewhere.values(), *drawing.findings(set(elsewhere)), *_dips(replay)]
    found += [*_tool_findings(plan, drawing), *_order_findings(drawing)]
    return found or _lift_findings(plan, drawing)


def _elsewhere(replay: Replay, strokes: Sequence[Planned]) -> dict[int, Finding]:
    """Name stray lines, by number, that are strokes of another face or set-up."""
    drawing = replay.drawing
    others = [stroke for stroke in strokes if stroke.setup.number not in replay.file.setups]
    stray = sorted(set(drawing.extra.line.tolist()))
    if not stray or not others:
        return {}
    astray = pieces([drawing.lines[k].points for k in stray])
    found = pairs(astray, pieces([stroke.points for stroke in others]), drawing.tolerance)
    still = set(uncovered(astray, found.near()).line.tolist())
    on_astray, on_others, _, _ = found.along()
    findings = {}
    for k, line in enumerate(stray):
        mine = on_astray.line == k
        if k in still or not mine.any():
            continue
        totals = np.bincount(on_others.line[mine], on_others.lengths[mine])
        stroke = others[int(totals.argmax())]
        findings[line] = _stray_finding(replay, drawing.lines[line], stroke)
    return findings


def _stray_finding(replay: Replay, line: Line, stroke: Planned) -> Finding:
    where = f"{replay.file.name}, byte {line.run.byte}"
    if stroke.face is replay.file.face:
        text = f"This program draws {stroke} at {at(stroke.points[0])}."
        return _error("wrong-set-up", where, text)
    text = f"{stroke} at {at(stroke.points[0])} is drawn on the {replay.file.face}."
    return _error("wrong-face", where, f"The {text} It belongs on the {stroke.face}.")


def _dips(replay: Replay) -> list[Finding]:
    """Name places where the tool only goes down and up: it pierces the sheet."""
    lines = replay.drawing.lines
    dips = [line for line in lines if (line.run.points == line.run.points[0]).all()]
    return [
        _error(
            "dip",
            f"{replay.file.name}, byte {line.run.byte}",
            f"The tool goes down and up again without a motion at {at(line.points[0])}.",
        )
        for line in dips
    ]


def _tool_findings(plan: Plan, drawing: Drawing) -> list[Finding]:
    """Compare tool, speed and force of each line with those of the stroke it goes along."""
    wrong: dict[tuple[str, int, str], int] = {}
    for line, k in zip(drawing.lines, drawing.strokes_of_lines.tolist(), strict=True):
        if k < 0:
            continue
        setup = drawing.strokes[k].setup
        for code, text in settings.wrong(plan, line.run, setup):
            key = (code, setup.number, text)
            wrong[key] = wrong.get(key, 0) + 1
    return [
        _error(code, f"{drawing.name}, set-up {number}", f"{text} ({count} strokes).")
        for (code, number, text), count in wrong.items()
    ]


def _order_findings(drawing: Drawing) -> list[Finding]:
    """Name the first stroke that is drawn after one that must come later."""
    owner = drawing.strokes_of_pieces
    # where strokes meet a short piece lies on both, and says nothing of their order
    known = np.flatnonzero((owner >= 0) & (drawing.drawn.lengths > 2 * drawing.tolerance))
    ranks = np.array([stroke.rank for stroke in drawing.strokes], np.intp)
    sequence = ranks[owner[known]]
    late = np.flatnonzero(sequence < np.maximum.accumulate(sequence))
    if not len(late):
        return _stroke_order(drawing, owner[known].tolist())
    k = int(late[0])
    stroke = drawing.strokes[owner[known[k]]]
    before = drawing.strokes[owner[known[int(np.argmax(sequence[:k]))]]]
    what = "the outline" if before.role is Role.CUT_OUTER else f"the {before.role} strokes"
    text = f"The {stroke} at {at(stroke.points[0])} is drawn after {what}, not before."
    return [_error("order", drawing.name, text, "The outline is cut last, scores come first.")]


def _stroke_order(drawing: Drawing, sequence: Sequence[int]) -> list[Finding]:
    first = list(dict.fromkeys(sequence))
    if first == sorted(first):
        return []
    # for most strokes any order will do; not for what is cut loose, nor for copies
    drawn = [drawing.strokes[k] for k in first]
    spoilt = [*prove_nesting(drawn), *prove_turns(drawn)]
    text = "The strokes are not drawn in the plan's order."
    return spoilt or [Finding("stroke-order", Severity.WARNING, drawing.name, text)]


def _lift_findings(plan: Plan, drawing: Drawing) -> list[Finding]:
    """Name the first stroke in which the tool is lifted: set down again it leaves a bridge.

    Where a sheet is only pulled, or a blade turned out of its groove, that is how it is done.
    """
    if plan.machine.bed.pull:
        return []
    owner = drawing.strokes_of_lines
    times = np.bincount(owner[owner >= 0], minlength=len(drawing.strokes)).tolist()
    broken = [k for k, n in enumerate(times) if n > 1 and not drawing.strokes[k].setup.swivel_force]
    if not broken:
        return []
    stroke = drawing.strokes[broken[0]]
    more = f" So it is in {len(broken) - 1} more strokes." if len(broken) > 1 else ""
    text = f"The tool is lifted and set down again within this stroke, {times[broken[0]] - 1} "
    where = f"{drawing.name}, {stroke} at {at(stroke.points[0])}"
    text += f"times; its repeats are one motion, and what is begun anew tends to hold.{more}"
    return [_error("lifted-within", where, text)]
