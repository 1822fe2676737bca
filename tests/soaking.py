"""Long suites: the same test functions, a seeded sample in every test run, all of it in a soak.

``make soak PART=name`` runs a part whole (``--soak``). It goes on where it was interrupted, as long
as the commit is the same, and leaves its figures in benchmarks/soak.md.
"""

from __future__ import annotations

import json
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parent.parent
STATE = ROOT / "out" / "soak"
FIGURES = ROOT / "benchmarks" / "soak.md"
HEAD = """# Soak

What `make soak` ran last, part by part: `make soak PART=name` runs one.

| part | commit | seed | count | seconds |
|---|---|---|---|---|
"""


class Progress:
    """How far a part is, kept on disk while it runs whole."""

    def __init__(self, path: Path | None, key: str) -> None:
        self._path, self._key = path, key
        self.before, self.seconds = 0, 0.0
        if path and path.exists():
            kept = json.loads(path.read_text())
            if kept["key"] == key:
                self.before, self.seconds = kept["reached"], kept["seconds"]
        self._began = time.perf_counter() - self.seconds

    def reached(self, count: int) -> None:
        """Keep that so many cases have passed."""
        self.seconds = time.perf_counter() - self._began
        if self._path:
            kept = {"key": self._key, "reached": count, "seconds": self.seconds}
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._path.write_text(json.dumps(kept))


class Soak:
    """Whether this run is a soak, and what it writes down."""

    def __init__(self, whole: bool) -> None:
        self.whole = whole

    def size(self, sample: int, whole: int) -> int:
        """Return how many cases to run."""
        return whole if self.whole else sample

    @contextmanager
    def part(self, name: str, seed: int, count: int, unit: str) -> Iterator[Progress]:
        """Run a part; its figures are written down when it has passed."""
        if not self.whole:
            yield Progress(None, "")
            return
        commit = _commit()
        path = STATE / f"{name}.json"
        progress = Progress(path, f"{commit}/{seed}/{count}")
        yield progress
        path.unlink(missing_ok=True)
        _write_down(name, f"| {name} | {commit} | {seed} | {count:,} {unit} | ", progress.seconds)


def head() -> str:
    """Return the commit that is checked out; nothing where there is none."""
    return _git("rev-parse", "HEAD")


def _commit() -> str:
    """Return the commit, marked where anything but the figures themselves has changed since."""
    said = _git("describe", "--always")
    figures = f":!{FIGURES.relative_to(ROOT)}"
    dirty = _git("status", "--porcelain", "--untracked-files=no", "--", ".", figures)
    return f"{said}-dirty" if said and dirty else said or "unknown"


def _git(*words: str) -> str:
    said = subprocess.run(
        ["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=False
    )
    return said.stdout.strip()


def _write_down(name: str, row: str, seconds: float) -> None:
    """Replace the part's row; rows stand in order of their names."""
    text = FIGURES.read_text() if FIGURES.exists() else HEAD
    rows = [line for line in text.removeprefix(HEAD).splitlines() if f"| {name} |" not in line]
    rows.append(f"{row}{seconds:.0f} |")
    FIGURES.write_text(HEAD + "\n".join(sorted(rows)) + "\n")
