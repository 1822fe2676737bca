"""The job folder: pattern, plan, programs, drawings and job sheet, written together.

``pattern.fold`` is what the plan was made from, where it was not made from a foreign drawing, and
``plan.json`` holds the SHA-256 of it and of every program; it is written last, so that a folder
with a plan is complete.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

from pydantic import ValidationError

from foldmill import Fold, installed
from foldmill.exchange import fold as fold_file
from foldmill_fabricate.coupon.answers import NAME as ANSWERS
from foldmill_fabricate.coupon.answers import template
from foldmill_fabricate.files import write_all
from foldmill_fabricate.hooks import FORMATS
from foldmill_fabricate.names import JOB_SHEET, PATTERN, PLAN
from foldmill_fabricate.passes import Plan, ProgramFile
from foldmill_fabricate.profiles import Style


def write(
    fold: Fold, plan: Plan, folder: Path, formats: Sequence[str], style: Style | None = None
) -> Plan:
    """Write everything one job needs into a folder; return the plan with its programs named.

    style : of the drawings. Raises UnknownName for a format nobody offers. What an earlier plan
    left in the same folder is removed: a stale file must not reach a machine or mislead a person.
    """
    from foldmill_fabricate import jobsheet

    contents: dict[str, bytes] = {}
    if plan.whole.source is None:  # else there is no pattern
        contents[PATTERN] = fold_file.write(fold).encode()
    programs: list[ProgramFile] = []
    for slug in formats:
        offered = installed().get(FORMATS, "format", slug)
        styled = style is not None and offered.drawn is not None
        files = offered.drawn(plan, fold, style) if styled else offered.write(plan, fold)
        contents.update(files)
        for name, face, setups in offered.layout(plan) if offered.layout else ():
            digest = hashlib.sha256(files[name]).hexdigest()
            programs.append(ProgramFile(name=name, face=face, setups=setups, sha256=digest))
    named = {part.name for part in programs}
    drawings = tuple(sorted(set(contents) - named - {PATTERN}))
    complete = plan.model_copy(update={"programs": tuple(programs), "drawings": drawings})
    contents[JOB_SHEET] = jobsheet.write(complete, fold)
    if plan.coupon is not None and not (folder / ANSWERS).exists():  # it may be filled in
        contents[ANSWERS] = template(plan, plan.coupon).encode()
    contents[PLAN] = (complete.model_dump_json(indent=1) + "\n").encode()
    write_all(folder, contents, stale=_files_before(folder))
    return complete


def _files_before(folder: Path) -> list[str]:
    try:
        before = Plan.model_validate_json((folder / PLAN).read_bytes())
    except (OSError, ValidationError):
        return []
    names = [*(program.name for program in before.programs), *before.drawings, PATTERN]
    return [name for name in names if Path(name).name == name]
