"""Verify a job as it lies in a folder: the pattern, the plan and the programs."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import ValidationError

from foldmill import CreasePattern
from foldmill.errors import UnreadableFile
from foldmill.finding import Finding, Severity
from foldmill.refusals import explain
from foldmill_fabricate.passes import Fit, Plan
from foldmill_fabricate.verify.planned import SUFFIXES
from foldmill_fabricate.verify.verification import Verification, verify

PLAN = "plan.json"  # its own word for it, as for all that it proves
PATTERN = "pattern.fold"
_NO_PATTERN = CreasePattern.from_lines([], [], [], [])


@dataclass(frozen=True, eq=False)
class JobFiles:
    """A job folder as it was read once: what is proved is what is sent."""

    plan: Plan
    pattern: CreasePattern
    pattern_bytes: bytes
    programs: Mapping[str, bytes]
    """Every file that the plan names as a program, and others named like programs, by name."""


def read_folder(path: str | Path) -> JobFiles:
    """Read ``plan.json``, ``pattern.fold`` and the programs of a folder.

    Raises UnreadableFile where plan or pattern are missing or not what their names say, for then
    there is nothing to compare with.
    """
    folder = Path(path)
    _look_for(folder, PLAN)
    data, pattern = b"", _NO_PATTERN
    if (folder / PATTERN).exists() or _plan(folder).whole.source is None:
        data = _bytes(folder, PATTERN)
        pattern = _pattern(data, folder / PATTERN)  # first: reading it takes much for a moment
    plan = _plan(folder)
    named = [folder / Path(file.name).name for file in plan.programs]
    others = [file for suffix in SUFFIXES for file in folder.glob(f"*{suffix}")]
    files = {file for file in [*named, *others] if file.is_file()}
    programs = {file.name: file.read_bytes() for file in sorted(files)}
    return JobFiles(plan, pattern, data, programs)


def verify_folder(path: str | Path, fit: Fit | None = None) -> Verification:
    """Read a folder and verify it; raises UnreadableFile as ``read_folder`` does."""
    return verify_files(read_folder(path), fit)


def verify_files(files: JobFiles, fit: Fit | None = None) -> Verification:
    """Verify what was read; a missing or edited program is a finding."""
    result = verify(files.plan, files.pattern, files.programs, fit)
    if hashlib.sha256(files.pattern_bytes).hexdigest() == files.plan.pattern_sha256:
        return result
    edited = Finding(
        "edited",
        Severity.ERROR,
        PATTERN,
        "Its SHA-256 is not the one in plan.json: it was changed after planning.",
        "Plan the changed pattern anew.",
    )
    return replace(result, findings=(edited, *result.findings))


def _look_for(folder: Path, name: str) -> None:
    if not folder.is_dir():
        raise UnreadableFile(f"There is no folder {folder}; name the one that plan has written.")
    if not (folder / name).exists():
        raise UnreadableFile(
            f"{folder / name}: No such file or directory. Plan again into this folder."
        )


def _bytes(folder: Path, name: str) -> bytes:
    try:
        return (folder / name).read_bytes()
    except OSError as error:
        reason = error.strerror or "cannot be read"
        raise UnreadableFile(f"{folder / name}: {reason}. Plan again into this folder.") from None


def _plan(folder: Path) -> Plan:
    data = _bytes(folder, PLAN)
    try:
        return Plan.model_validate_json(data)
    except ValidationError as error:
        raise UnreadableFile(f"{folder / PLAN} is no plan: {explain(error)}") from None


def _pattern(data: bytes, path: Path) -> CreasePattern:
    from foldmill.exchange import fold

    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise UnreadableFile(f"{path} is no text: {error.reason}, byte {error.start}.") from None
    return fold.read(text, path.name).pattern
