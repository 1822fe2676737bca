"""A real PostgreSQL server of its own, for as long as a test wants it."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

USER = "foldmill"


def binaries() -> Path | None:
    """Return the folder of the server's programs; None where there is none."""
    found = shutil.which("initdb")
    places = [Path(found).parent] if found else []
    places += sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    return next((place for place in places if (place / "initdb").exists()), None)


PROGRAMS = binaries()
NEEDED = pytest.mark.skipif(PROGRAMS is None, reason="PostgreSQL is not installed: make tools")
"""Of tests that ask for the fixture ``database``."""


class Server:
    """A running server that can go away, as one that is updated or whose computer restarts."""

    def __init__(self, programs: Path, place: Path) -> None:
        self._as_user = _unprivileged(place)
        self._control = programs / "pg_ctl", "-D", place / "data", "-w"
        initialise = (programs / "initdb", "-D", place / "data", "-U", USER, "-A", "trust")
        _run(self._as_user, *initialise)
        port = _free_port()
        self.url = f"postgresql://{USER}@127.0.0.1:{port}"
        options = f"-p {port} -k {place} -c listen_addresses=127.0.0.1"
        self._start = ("-l", place / "log", "-o", options, "start")

    def start(self) -> None:
        """Start, and wait until it answers."""
        _run(self._as_user, *self._control, *self._start)

    def stop(self) -> None:
        """Stop as if its power failed: nothing is ended in order, all connections are cut."""
        _run(self._as_user, *self._control, "-m", "immediate", "stop")

    @contextmanager
    def away(self) -> Iterator[None]:
        """Stop while the context lasts."""
        self.stop()
        try:
            yield
        finally:
            self.start()


@contextmanager
def server(programs: Path) -> Iterator[Server]:
    """Run a server while the context lasts; its URL names no database."""
    place = Path(tempfile.mkdtemp(prefix="foldmill-pg-"))
    try:
        made = Server(programs, place)
        made.start()
        try:
            yield made
        finally:
            made.stop()
    finally:
        shutil.rmtree(place, ignore_errors=True)


def new_database(at: Server, name: str) -> str:
    """Make an empty database in a server; return its SQLAlchemy URL."""
    import psycopg

    with psycopg.connect(f"{at.url}/postgres", autocommit=True) as connection:
        connection.execute(
            psycopg.sql.SQL("CREATE DATABASE {}").format(psycopg.sql.Identifier(name))
        )
    return at.url.replace("postgresql:", "postgresql+psycopg:") + f"/{name}"


def _unprivileged(place: Path) -> str | None:
    """Return the user that the server runs as, which refuses the superuser; None for this one."""
    if os.geteuid() != 0:
        return None
    shutil.chown(place, "postgres", "postgres")
    return "postgres"


def _run(user: str | None, *words: object) -> None:
    subprocess.run(
        [*map(str, words)],
        check=True,
        stdout=subprocess.DEVNULL,
        cwd="/",
        timeout=60,
        user=user,
        group=user,
        extra_groups=None if user is None else [],
    )


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])
