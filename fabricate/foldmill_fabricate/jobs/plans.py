"""Job folders that jobs are made from, kept by the id of their plan so that nobody changes them.

The plan holds its material and its machine whole, so a job's history has them as they were.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from pathlib import Path

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.folder import PLAN
from foldmill_fabricate.jobs.errors import NoSuchJob
from foldmill_fabricate.jobs.rows import About
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.space import keeping

_ID = re.compile(r"[0-9a-f]{64}")


class Plans:
    """The folders of plans; root : made where there is none."""

    def __init__(self, root: Path) -> None:
        self._root = root

    def keep(self, folder: Path) -> str:
        """Keep a copy of a job folder and return the id of its plan.

        Only what plan.json names is kept. Raises CannotSend for a folder that is none, DiskFull.
        """
        plan = _read(folder)
        name = plan.digest
        if not (self._root / name).exists():
            with keeping(self._root):
                self._lay_down(plan, folder)
        return name

    def _lay_down(self, plan: Plan, folder: Path) -> None:
        """Copy it whole beside its place, then put it there."""
        self._root.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=".draft-", dir=self._root))
        try:
            _copy(plan, folder, draft)
            _settle(draft, self._root / plan.digest)
        finally:
            shutil.rmtree(draft, ignore_errors=True)

    def folder(self, name: str) -> Path:
        """Return the folder of a plan; raises NoSuchJob for an id that none has."""
        if not _ID.fullmatch(name) or not (self._root / name / PLAN).is_file():
            raise NoSuchJob(f"There is no plan {name[:80]!r} here.")
        return self._root / name

    def plan(self, name: str) -> Plan:
        """Return a plan; raises NoSuchJob."""
        return _read(self.folder(name))

    def about(self, name: str) -> About:
        """Return what a plan says of itself; raises NoSuchJob."""
        return about(self.plan(name))


def about(plan: Plan) -> About:
    """Return what a plan says of itself."""
    return About(plan.title or "untitled", plan.material.slug, plan.machine.slug)


def _read(folder: Path) -> Plan:
    try:
        return Plan.model_validate_json((folder / PLAN).read_bytes())
    except (OSError, ValueError):
        raise CannotSend(
            f"{folder} is no job folder that this foldmill can read: plan it again."
        ) from None


def _copy(plan: Plan, folder: Path, draft: Path) -> None:
    """Copy the files that a plan names; those that prove it must be there."""
    named = [PLAN, "pattern.fold", *(part.name for part in plan.programs)]
    for name in named:
        if Path(name).name != name or not (folder / name).is_file():
            raise CannotSend(f"{folder} has no {name}: plan it again.")
    more = ["job-sheet.pdf", *plan.drawings]
    for name in (*named, *(each for each in more if Path(each).name == each)):
        if (folder / name).is_file():
            shutil.copyfile(folder / name, draft / name)


def _settle(draft: Path, place: Path) -> None:
    """Put a complete folder in its place; another process may have done so meanwhile."""
    try:
        draft.rename(place)
    except OSError:
        if not place.is_dir():
            raise
