"""What the service keeps: patterns and plans, by digest, below its own folder.

A name that a client gives is never part of a path: ids are checked digests, and the names of files
are looked up among those that are there.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Collection, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from foldmill_fabricate.files import write_whole
from foldmill_fabricate.jobs.keeping import KEEP_DAYS, Keeping
from foldmill_fabricate.service.names import PATTERN
from foldmill_fabricate.service.problems import NoSuch

ABOUT, REQUEST = "about.json", "request.json"
DONE, REFUSED = "done.json", "refused.json"


class Storage:
    """The folder of one service; days : for how many it keeps what no job needs."""

    def __init__(self, folder: Path, days: int = KEEP_DAYS) -> None:
        self.folder, self._days = folder, days
        self.scratch = folder / "scratch"
        self._patterns = Keeping(folder / "patterns", ABOUT)
        self._plans = Keeping(folder / "plans", REQUEST)
        self.scratch.mkdir(parents=True, exist_ok=True, mode=0o700)
        for left in self.scratch.iterdir():  # of a service that was killed
            shutil.rmtree(left, ignore_errors=True)

    def pattern(self, digest: str) -> Path:
        """Ask for the folder of a pattern; raises NoSuch."""
        return self._known(self._patterns, digest, "pattern")

    def plan(self, digest: str) -> Path:
        """Ask for the folder of a plan; raises NoSuch."""
        return self._known(self._plans, digest, "plan")

    def patterns(self) -> Iterator[dict[str, Any]]:
        """Yield what is known of each pattern, by id."""
        for _, place in _listed(self._patterns):
            with suppress(FileNotFoundError):  # thrown away meanwhile
                yield read(place / ABOUT)

    def plans(self) -> Iterator[tuple[str, Path]]:
        """Yield the id and the folder of each plan; to list them is not to ask for them."""
        return _listed(self._plans)

    def keep_pattern(self, made: Path, about: dict[str, Any]) -> None:
        """Keep a pattern that was made in a folder of work; that folder is gone afterwards."""
        write(made / ABOUT, about)
        for other in {entry.name for entry in made.iterdir()} - {ABOUT, PATTERN}:
            (made / other).unlink()
        self._patterns.settle(made, about["id"])
        shutil.rmtree(made, ignore_errors=True)

    def begin_plan(self, digest: str, request: dict[str, Any]) -> Path:
        """Keep the request of a plan, forget a refusal, and return the plan's folder."""
        place = self._plans.begin(digest)
        write(place / REQUEST, request)
        (place / REFUSED).unlink(missing_ok=True)
        return place

    def throw_away(self, needed: Collection[str]) -> list[str]:
        """Throw away what is not needed and nobody has asked for; return the ids.

        needed : ids of the job folders that jobs refer to. What a plan is made from stays with it.
        """
        plans = [name for name, place in self.plans() if _made(place) in needed]
        gone = self._plans.throw_away(self._days, plans)
        patterns = {str(_said(place / REQUEST).get("pattern")) for _, place in self.plans()}
        return gone + self._patterns.throw_away(self._days, patterns)

    def made(self) -> set[str]:
        """Return the ids of the job folders that the plans here have become."""
        return {_made(place) for _, place in self.plans()} - {""}

    def _known(self, kept: Keeping, digest: str, word: str) -> Path:
        place = kept.find(digest)
        if place is None:
            raise NoSuch(
                f"There is no {word} {digest} here. One that no job needs is kept {self._days} "
                "days after somebody last asked for it; ask for it anew."
            )
        return place


def _listed(kept: Keeping) -> Iterator[tuple[str, Path]]:
    return ((name, kept.place(name)) for name in kept)


def _made(place: Path) -> str:
    """Return the id of the job folder that a plan has become; empty where it has not."""
    return str(_said(place / DONE).get("plan", ""))


def _said(file: Path) -> dict[str, Any]:
    """Read a JSON object of ours; empty where it is not there, or not any more."""
    try:
        return read(file)
    except FileNotFoundError:
        return {}


def read(file: Path) -> dict[str, Any]:
    """Read a JSON object of ours."""
    found: dict[str, Any] = json.loads(file.read_bytes())
    return found


def write(file: Path, content: dict[str, Any]) -> None:
    """Write a JSON object, whole or not at all."""
    write_whole(file, json.dumps(content).encode())
