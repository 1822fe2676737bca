"""What the service keeps: patterns and plans, by digest, below its own folder.

A name that a client gives is never part of a path: ids are checked digests, and the names of files
are looked up among those that are there.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from foldmill_fabricate.files import write_whole
from foldmill_fabricate.service.problems import NoSuch

ABOUT, REQUEST, REFUSED = "about.json", "request.json", "refused.json"
JOB = "job"


class Storage:
    """The folder of one service."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.scratch = folder / "scratch"
        for name in ("patterns", "plans", "scratch"):
            (folder / name).mkdir(parents=True, exist_ok=True, mode=0o700)
        for left in self.scratch.iterdir():  # of a service that was killed
            shutil.rmtree(left, ignore_errors=True)

    def pattern(self, digest: str) -> Path:
        """Return the folder of a pattern; raises NoSuch."""
        return self._known("patterns", digest, ABOUT, "pattern")

    def plan(self, digest: str) -> Path:
        """Return the folder of a plan; raises NoSuch."""
        return self._known("plans", digest, REQUEST, "plan")

    def patterns(self) -> Iterator[dict[str, Any]]:
        """Yield what is known of each pattern, by id."""
        for place in sorted((self.folder / "patterns").iterdir()):
            if (place / ABOUT).is_file():
                yield read(place / ABOUT)

    def plans(self) -> list[str]:
        """Return the ids of all plans, in order."""
        found = (self.folder / "plans").iterdir()
        return sorted(place.name for place in found if (place / REQUEST).is_file())

    def keep_pattern(self, made: Path, about: dict[str, Any]) -> None:
        """Keep a pattern that was made in a folder of work; that folder is gone afterwards."""
        write(made / ABOUT, about)
        for other in {entry.name for entry in made.iterdir()} - {ABOUT, "pattern.fold"}:
            (made / other).unlink()
        _move(made, self.folder / "patterns" / about["id"])

    def begin_plan(self, digest: str, request: dict[str, Any]) -> Path:
        """Keep the request of a plan, forget a refusal, and return the plan's folder."""
        place = self.folder / "plans" / digest
        write(place / REQUEST, request)
        (place / REFUSED).unlink(missing_ok=True)
        return place

    def _known(self, kind: str, digest: str, proof: str, word: str) -> Path:
        place = self.folder / kind / digest
        if not digest.isalnum() or not (place / proof).is_file():
            raise NoSuch(f"There is no {word} {digest} here; make it again.")
        return place


def read(file: Path) -> dict[str, Any]:
    """Read a JSON object of ours."""
    found: dict[str, Any] = json.loads(file.read_bytes())
    return found


def write(file: Path, content: dict[str, Any]) -> None:
    """Write a JSON object, whole or not at all."""
    write_whole(file, json.dumps(content).encode())


def _move(made: Path, place: Path) -> None:
    """Move a folder to its place; where something is there, it is the same and stays."""
    try:
        made.replace(place)
    except OSError:
        if not place.is_dir() or not any(place.iterdir()):
            raise
        shutil.rmtree(made, ignore_errors=True)
