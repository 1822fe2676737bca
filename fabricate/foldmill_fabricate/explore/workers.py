"""Where configurations are computed: processes of this machine, or a cluster."""

from __future__ import annotations

import re
from dataclasses import dataclass

from foldmill_fabricate.errors import CannotExplore


@dataclass(frozen=True)
class Local:
    """Processes of this machine."""

    jobs: int = -1
    """How many; -1 for one per core. With 1 the work is done in this process."""

    def __post_init__(self) -> None:
        if self.jobs == 0 or self.jobs < -1:
            raise CannotExplore(f"{self.jobs} processes compute nothing; take 1 or more.")


@dataclass(frozen=True)
class Cluster:
    """A Dask cluster that runs already. Whoever can reach it can run code on it: trust it."""

    address: str
    """Of the scheduler: ``tcp://host:8786`` or ``tls://host:8786``."""
    patience_s: float = 10.0
    """How long to wait for the scheduler, for its first worker, and for one when all are lost."""

    def __post_init__(self) -> None:
        if not re.fullmatch(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[\w.-]+):\d{1,5}", self.address):
            raise CannotExplore(
                f"{self.address!r} is no address of a Dask scheduler; write tcp://HOST:PORT, such "
                "as tcp://127.0.0.1:8786."
            )


Engine = Local | Cluster
