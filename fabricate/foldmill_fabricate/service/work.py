"""What runs in the sandbox: functions of a folder and plain values, which return plain values.

Each finds its files in the folder and leaves there what it makes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter

from foldmill import Assignment, Fold, installed
from foldmill.check import check as check_fold
from foldmill.exchange import fold as fold_file
from foldmill.exchange import mesh
from foldmill.exchange.limits import Limits
from foldmill.exchange.marking import marked
from foldmill.exchange.options import Options, named
from foldmill.finding import Finding, Severity
from foldmill_fabricate import folder as job_folder
from foldmill_fabricate import pictures, profiles
from foldmill_fabricate.as_cut import as_cut as sheets_as_cut
from foldmill_fabricate.errors import CannotSend, CannotWrite
from foldmill_fabricate.foreign import Asked, make_folder
from foldmill_fabricate.importing.reading import read_pattern, require_answers
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.names import PLAN
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.pictures.as_cut_svg import as_cut_svg
from foldmill_fabricate.plan import make
from foldmill_fabricate.plan_options import PlanOptions
from foldmill_fabricate.plotter.ledger import SheetRecord
from foldmill_fabricate.profiles import Style
from foldmill_fabricate.service import unpacking
from foldmill_fabricate.service.bounds import MOST_UPLOAD
from foldmill_fabricate.service.names import AS_CUT, JOB, PATTERN, UPLOAD
from foldmill_fabricate.verify import read_folder, verify_folder

LIMITS = Limits(size=MOST_UPLOAD)
"""Of a file that is uploaded."""
SHEET = TypeAdapter(SheetRecord)
MOST_TOLD, LONGEST = 1000, 300
"""Figures and findings, and letters of a title: a stranger's file may bring a million of them."""
_SMALL = {
    "small.svg": b'<svg width="9mm" height="9mm" viewBox="0 0 9 9"><rect width="9" height="9" '
    b'stroke="black"/></svg>',
    "small.dxf": b"0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n9\n20\n9\n40\n9\n0\nENDSEC\n"
    b"0\nEOF\n",
}
"""A sheet without creases, in each format that is read by packages of others."""


def warm() -> None:
    """Load what every child will need, which takes longer than reading most files does."""
    installed()
    for name, content in _SMALL.items():
        check_fold(read_pattern(content, Options(), name=name).fold)


def read(folder: Path, form: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """Read ``upload``, leave it as ``pattern.fold`` and say what it is.

    Raises UnreadableFile, for a file that does not say how large it is too.
    """
    content = (folder / UPLOAD).read_bytes()
    said = Options(**{**options, "named": named(options["named"])})
    found = read_pattern(content, said, name=f"The file.{form}", limits=LIMITS)
    require_answers(found, "The file")
    return _kept(folder, found.fold)


def design(
    folder: Path, family: str, preset: str | None, params: Mapping[str, Any]
) -> dict[str, Any]:
    """Make a design from a preset and the parameters that differ from it, and keep it."""
    offered = installed().design(family)
    base = offered.preset(preset) if preset else offered.params()
    return _kept(folder, offered.run({**base.model_dump(), **params}))


def check(folder: Path) -> dict[str, Any]:
    """Check ``pattern.fold``: its figures and findings."""
    found = check_fold(_fold(folder))
    figures = dict(islice(found.figures.items(), MOST_TOLD))
    return {"figures": figures, "findings": _plain(found.findings)}


def draw(folder: Path, name: str) -> str:
    """Draw ``pattern.fold`` into a file; return the name of it."""
    (folder / name).write_bytes(_drawn(_fold(folder), Path(name).suffix))
    return name


def plan(
    folder: Path,
    material: Mapping[str, Any],
    machine: Mapping[str, Any],
    options: Mapping[str, Any],
    formats: Sequence[str],
    profile: str,
) -> dict[str, Any]:
    """Plan ``pattern.fold`` into the folder ``job``; return the plan without its strokes."""
    style = Style(profiles.find(profile), "R2000")
    of, on = Material.model_validate(material), Machine.model_validate(machine)
    fold = _fold(folder)
    made = make(fold, of, on, **PlanOptions.model_validate(options).for_make())
    written = job_folder.write(fold, made, folder / JOB, formats, style)
    return _account(written, folder / JOB)


def _account(plan: Plan, folder: Path) -> dict[str, Any]:
    """Return what is told of a plan without its strokes."""
    digests = {program.name: program.sha256 for program in plan.programs}
    files = [
        {"name": file.name, "bytes": file.stat().st_size, "sha256": digests.get(file.name, "")}
        for file in sorted(folder.iterdir())
    ]
    names = ("strokes", "drawn", "travel", "seconds")
    figures = {name: getattr(plan.figures, name) for name in names}
    set_ups = sum(len(work.setups) for work in plan.passes)
    return {
        "title": plan.title,
        "figures": {"set_ups": set_ups, **figures},
        "findings": _plain(plan.findings),
        "files": files,
    }


def verify(folder: Path) -> dict[str, Any]:
    """Verify the job folder ``job``."""
    found = verify_folder(folder / JOB)
    return {
        "ok": found.ok,
        "figures": asdict(found.figures),
        "findings": _plain(found.findings),
    }


def unpack(folder: Path) -> dict[str, Any]:
    """Unpack ``upload``, a ZIP file of a job folder, into ``job`` and prove it.

    Raises UnreadableFile for what is no job folder, CannotSend for one that does not verify.
    """
    unpacking.unpack(folder / UPLOAD, folder / JOB)
    found = verify_folder(folder / JOB)
    if not found.ok:
        first = next(each for each in found.findings if each.severity is Severity.ERROR)
        raise CannotSend(f"This job folder does not verify, and nothing of it is kept. {first}")
    plan = Plan.model_validate_json((folder / JOB / PLAN).read_bytes())
    return _whole_account(plan, folder / JOB)


def drawn(
    folder: Path,
    asked: Mapping[str, Any],
    material: Mapping[str, Any],
    machine: Mapping[str, Any],
) -> dict[str, Any]:
    """Make ``upload``, HP-GL from elsewhere, into a job folder ``job`` of our own writing.

    Raises what ``foreign.make_folder`` raises.
    """
    data = (folder / UPLOAD).read_bytes()
    of, on = Material.model_validate(material), Machine.model_validate(machine)
    plan = make_folder(data, Asked.model_validate(asked), of, on, folder / JOB)
    return _whole_account(plan, folder / JOB)


def _whole_account(plan: Plan, folder: Path) -> dict[str, Any]:
    slugs = {"material": plan.material.slug, "machine": plan.machine.slug}
    return {**_account(plan, folder), **slugs}


def as_cut(folder: Path, job: str, face: str, sheet: Mapping[str, Any]) -> None:
    """Draw how a face of a sheet is cut by now; ``job`` : its job folder.

    Raises CannotWrite for a face that nothing is done to.
    """
    files, record = read_folder(Path(job)), SHEET.validate_python(sheet)
    faces = {each.face: each for each in sheets_as_cut(files.plan, files.programs, record)}
    if face not in faces:
        raise CannotWrite(f"Nothing is done to the {face} of sheet {record.id}; ask for another.")
    drawn = as_cut_svg(faces[Face(face)], f"sheet {record.id}, {face}")
    (folder / AS_CUT).write_bytes(drawn)


def _kept(folder: Path, fold: Fold) -> dict[str, Any]:
    found = check_fold(fold)
    content = fold_file.write(marked(fold, found.findings)).encode()
    (folder / PATTERN).write_bytes(content)
    return {
        "id": hashlib.sha256(content).hexdigest(),
        "bytes": len(content),
        "findings": _plain(found.findings),
        **_summary(fold),
    }


def _summary(fold: Fold) -> dict[str, Any]:
    """Return what is told of a fold without asking for more."""
    pattern, folded = fold.pattern, fold.folded
    size = np.ptp(pattern.vertices, axis=0) if len(pattern.vertices) else np.zeros(2)
    solid = None if folded is None or not len(folded.vertices) else np.ptp(folded.vertices, axis=0)
    notes = fold.meta.get("fold", {}).get("notes", [])
    return {
        "title": str(fold.meta.get("title", ""))[:LONGEST],
        "vertices": len(pattern.vertices),
        "edges": len(pattern.edges),
        "faces": len(pattern.faces),
        "creases": {each.name: pattern.count(each) for each in Assignment},
        "width": float(size[0]),
        "height": float(size[1]),
        "folded": None if solid is None else [float(side) for side in solid],
        "notes": [str(note)[:LONGEST] for note in notes[:MOST_TOLD]],
    }


def _plain(findings: Sequence[Finding]) -> list[dict[str, Any]]:
    told = [asdict(finding) for finding in findings[:MOST_TOLD]]
    if len(findings) > MOST_TOLD:
        rest = f"{len(findings) - MOST_TOLD:,} more findings are not listed."
        told.append(asdict(Finding("more-findings", Severity.INFO, "", rest)))
    return told


def _fold(folder: Path) -> Fold:
    return fold_file.read((folder / PATTERN).read_text(encoding="utf-8"), PATTERN)


def _drawn(fold: Fold, suffix: str) -> bytes:
    if suffix == ".svg":
        return pictures.pattern_svg(fold)
    if suffix == ".png":
        return pictures.pattern_picture(fold)
    return mesh.write_mesh(fold, suffix)
