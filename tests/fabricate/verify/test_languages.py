"""Programs are replayed by the interpreter of their language, a third party's as well."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from importlib.metadata import EntryPoint, entry_points
from types import ModuleType, SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import stools
from fabricate.verify.square_job import ONE_TOOL, Job, files_of, job, way

from foldmill import CreasePattern, Fold, UnknownName, hookimpl
from foldmill.finding import Finding, Severity
from foldmill.registry import Registry, load
from foldmill_fabricate.hooks import FORMATS, Format, Interpreter
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.verify import languages, verify
from foldmill_fabricate.verify.interpreter import Run, Trace
from foldmill_fabricate.verify.languages import replay


def test_hp_gl_is_interpreted() -> None:
    trace = replay(b"IN;DF;PA;PU;SP1;PU10,20;PD30,20;PU;SP0;", "one.hpgl", stools.machine())
    (run,) = trace.runs
    assert run.points.tolist() == [[10, 20], [30, 20]]
    assert trace.findings == ()


def test_a_language_that_nobody_interprets_is_refused_with_those_there_are() -> None:
    machine = stools.machine().model_copy(update={"language": "semaphore"})
    with pytest.raises(UnknownName, match=r"language of programs.*semaphore.*hpgl"):
        replay(b"", "one.txt", machine)


def signals(plan: Plan, fold: Fold) -> dict[str, bytes]:
    """Write one line of words for each stroke: tool, speed, force, then places in mm."""
    setups = {setup.number: setup for side in plan.passes for setup in side.setups}
    found = {}
    for file in files_of(plan):
        lines = []
        for setup in (setups[number] for number in file.setups):
            for operation in setup.operations:
                for stroke in operation.strokes:
                    path = np.array(way(list(stroke.points), operation.repeats, operation.overcut))
                    if file.face is Face.REVERSE:
                        path[:, 0] = 2 * plan.flip.axis - path[:, 0]
                    words = [setup.tool, setup.speed, setup.force, *path.ravel().round(4)]
                    lines.append(" ".join(str(word) for word in words))
        found[file.name.replace(".hpgl", ".flags")] = "\n".join(lines).encode()
    return found


def read_signals(program: bytes, name: str, machine: Machine) -> Trace:
    """Read such lines back; a line that is no numbers is a finding."""
    sheet, runs, findings = np.array([20.0, 15.0]), [], []
    for number, line in enumerate(program.decode().splitlines(), 1):
        try:
            tool, speed, force, *places = (float(word) for word in line.split())
        except ValueError:
            text = "It is no row of numbers."
            findings.append(Finding("syntax", Severity.ERROR, f"{name}, line {number}", text))
            continue
        points = (np.array(places).reshape(-1, 2) + sheet) * machine.axes.units_per_mm
        runs.append(Run(points, int(tool), speed, force, number))
    visited = np.vstack([run.points for run in runs])
    lines = tuple(run.byte for run in runs for _ in run.points)
    return Trace(tuple(runs), visited, lines, tuple(findings))


@dataclass
class Point:
    """What the registry needs of an entry point, over a module that is already there."""

    name: str
    target: ModuleType
    dist: Any = field(default_factory=lambda: SimpleNamespace(name="acme-flags"))

    def load(self) -> ModuleType:
        return self.target


def with_signals() -> Registry:
    module = ModuleType("acme_flags")

    @hookimpl
    def foldmill_formats() -> list[Format]:
        return [Format("semaphore", "Flags", signals)]

    @hookimpl
    def foldmill_interpreters() -> list[Interpreter]:
        return [Interpreter("semaphore", "Flags", read_signals)]

    module.foldmill_formats = foldmill_formats  # type: ignore[attr-defined]
    module.foldmill_interpreters = foldmill_interpreters  # type: ignore[attr-defined]
    own = [point for point in entry_points(group="foldmill") if point.name == "fabricate"]
    return load([*own, cast("EntryPoint", Point("flags", module))])


def signalled(monkeypatch: pytest.MonkeyPatch) -> Job:
    """Return the job of a machine that is told by flags, its plugin installed."""
    registry = with_signals()
    assert registry.broken == []
    monkeypatch.setattr(languages, "installed", lambda: registry)
    good = job(ONE_TOOL)
    machine = good.plan.machine.model_copy(update={"language": "semaphore"})
    plan = good.plan.model_copy(update={"machine": machine, "programs": ()})
    return _recorded(plan, good.pattern, registry.get(FORMATS, "format", "semaphore").write)


def _recorded(plan: Plan, pattern: CreasePattern, write: Any) -> Job:
    programs = write(plan, Fold(pattern))
    files = [
        file.model_copy(update={"name": name, "sha256": hashlib.sha256(programs[name]).hexdigest()})
        for file, name in zip(files_of(plan), programs, strict=True)
    ]
    return Job(plan.model_copy(update={"programs": tuple(files)}), pattern, programs)


def test_a_third_partys_language_is_proved_like_our_own(monkeypatch: pytest.MonkeyPatch) -> None:
    found = signalled(monkeypatch)
    result = verify(found.plan, found.pattern, found.programs)
    assert result.findings == ()
    assert result.figures.deviation < 1e-3


def test_what_is_wrong_in_a_third_partys_program_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    found = signalled(monkeypatch)
    name = found.plan.programs[1].name
    lines = found.programs[name].decode().splitlines()
    spoilt = {**found.programs, name: "\n".join([*lines[:-1], "both arms down"]).encode()}
    codes = {finding.code for finding in verify(found.plan, found.pattern, spoilt).findings}
    assert {"syntax", "missing-stroke", "edited"} <= codes
