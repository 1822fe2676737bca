"""Where a service keeps its work: the ledger, plans, transcripts, and the engine's own tables."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from sqlalchemy.engine import make_url

from foldmill_fabricate.jobs.keeping import KEEP_DAYS
from foldmill_fabricate.plotter.ledger.places import DATABASE as DATABASE
from foldmill_fabricate.plotter.ledger.places import state_folder


@dataclass(frozen=True)
class Places:
    """The folder of a service, and its database where that is no file in it."""

    root: Path = field(default_factory=state_folder)
    database: str = field(default_factory=lambda: os.environ.get(DATABASE, ""))
    """An SQLAlchemy URL such as postgresql+psycopg://user@host/name; empty for files."""
    keep_days: int = KEEP_DAYS
    """For how many days a service keeps what no job needs and nobody asks for."""

    @property
    def ledger(self) -> Path | str:
        """The ledger and the jobs."""
        return self.database or self.root / "ledger.sqlite"

    @property
    def engine(self) -> str:
        """The URL of the engine's own tables."""
        return self.database or f"sqlite:///{self.root / 'engine.sqlite'}"

    @property
    def plans(self) -> Path:
        """Job folders, by the id of their plan."""
        return self.root / "plans"

    @property
    def lock(self) -> Path:
        """Held by the one process that launches the engine."""
        return self.root / "host.lock"

    @property
    def locks(self) -> list[Path]:
        """Files whose locks that process holds: its folder's, and its database's where one is."""
        url = make_url(self.database) if self.database else None
        if url is None or url.get_backend_name() != "sqlite" or not url.database:
            return [self.lock]
        file = Path(url.database).absolute()
        return [self.lock, file.with_name(f"{file.name}.host.lock")]

    @property
    def service(self) -> Path:
        """Where the service says how it is reached, while it runs."""
        return self.root / "service.json"

    def transcripts(self, job: str, sheet: str = "") -> list[Path]:
        """Return what went over the wire for a sheet of a job, or for all, the oldest first."""
        return sorted((self.root / "transcripts").glob(f"{job}-{sheet or '*'}-*.jsonl"))

    def new_transcript(self, job: str, sheet: str) -> Path:
        """Return the file for what goes over the wire next."""
        before = [int(path.stem.rpartition("-")[2]) for path in self.transcripts(job, sheet)]
        number = 1 + max(before, default=0)
        path = self.root / "transcripts" / f"{job}-{sheet}-{number:03}.jsonl"
        path.parent.mkdir(parents=True, exist_ok=True)
        return path
