"""Job folders that jobs are made from, kept by the id of their plan so that nobody changes them.

The plan holds its material and its machine whole, so a job's history has them as they were.
"""

from __future__ import annotations

import shutil
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.jobs.errors import NoSuchJob
from foldmill_fabricate.jobs.keeping import KEEP_DAYS, Keeping
from foldmill_fabricate.jobs.rows import About
from foldmill_fabricate.names import JOB_SHEET, PATTERN, PLAN
from foldmill_fabricate.space import keeping

if TYPE_CHECKING:
    from foldmill_fabricate.passes import Plan

_MOST_TOLD = 1000
"""Plans that are remembered, some hundred bytes each."""


class Told(NamedTuple):
    """What a submission of a plan is judged by."""

    about: About
    has_programs: bool
    remakes: str
    """id of the sheet that it goes on with; empty where it begins one"""


class Plans:
    """The folders of plans; root : made where there is none.

    days : for how many what no job needs is kept; this only says so, ``throw_away`` does it.
    """

    def __init__(self, root: Path, days: int = KEEP_DAYS) -> None:
        self._kept, self._days = Keeping(root, PLAN), days
        self._told: dict[str, Told] = {}

    def keep(self, folder: Path) -> str:
        """Keep a copy of a job folder and return the id of its plan.

        Only what plan.json names is kept. Raises CannotSend for a folder that is none, DiskFull.
        """
        plan = _read(folder)
        name = plan.digest
        if self._kept.find(name) is None:
            with keeping(self._kept.root), self._kept.draft() as draft:
                _copy(plan, folder, draft)
                self._kept.settle(draft, name)
        return name

    def folder(self, name: str) -> Path:
        """Return the folder of a plan; raises NoSuchJob for an id that none has."""
        found = self._kept.find(name)
        if found is None:
            raise NoSuchJob(
                f"There is no plan {name[:80]!r} here. One that no job needs is kept {self._days} "
                "days after somebody last asked for it; plan it anew."
            )
        return found

    def throw_away(self, days: float, needed: Collection[str]) -> list[str]:
        """Throw away the plans that are not needed and nobody has asked for; return their ids."""
        return self._kept.throw_away(days, needed)

    def plan(self, name: str) -> Plan:
        """Return a plan; raises NoSuchJob."""
        return _read(self.folder(name))

    def about(self, name: str) -> About:
        """Return what a plan says of itself; raises NoSuchJob."""
        return self.told(name).about

    def told(self, name: str) -> Told:
        """Return what a submission is judged by; raises NoSuchJob.

        A plan is read once: its id is the digest of all it says.
        """
        folder = self.folder(name)
        if name not in self._told:
            if len(self._told) >= _MOST_TOLD:
                self._told.clear()
            self._told[name] = _told(_read(folder))
        return self._told[name]


def _told(plan: Plan) -> Told:
    sheet = plan.remakes.sheet if plan.remakes else ""
    return Told(about(plan), bool(plan.programs), sheet)


def about(plan: Plan) -> About:
    """Return what a plan says of itself."""
    return About(plan.title or "untitled", plan.material.slug, plan.machine.slug)


def _read(folder: Path) -> Plan:
    from foldmill_fabricate.passes import Plan

    try:
        return Plan.model_validate_json((folder / PLAN).read_bytes())
    except (OSError, ValueError):
        raise CannotSend(
            f"{folder} is no job folder that this foldmill can read: plan it again."
        ) from None


def _copy(plan: Plan, folder: Path, draft: Path) -> None:
    """Copy the files that a plan names; those that prove it must be there."""
    pattern = [PATTERN] if plan.whole.source is None else []  # else there is none
    named = [PLAN, *pattern, *(part.name for part in plan.programs)]
    for name in named:
        if Path(name).name != name or not (folder / name).is_file():
            raise CannotSend(f"{folder} has no {name}: plan it again.")
    more = [JOB_SHEET, *plan.drawings]
    for name in (*named, *(each for each in more if Path(each).name == each)):
        if (folder / name).is_file():
            shutil.copyfile(folder / name, draft / name)
