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

USER = "foldmill"


def binaries() -> Path | None:
    """Return the folder of the server's programs; None where there is none."""
    found = shutil.which("initdb")
    places = [Path(found).parent] if found else []
    places += sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    return next((place for place in places if (place / "initdb").exists()), None)


@contextmanager
def server(programs: Path) -> Iterator[str]:
    """Run a server while the context lasts; yields its URL, without a database."""
    place = Path(tempfile.mkdtemp(prefix="foldmill-pg-"))
    as_user = _unprivileged(place)
    try:
        _run(as_user, programs / "initdb", "-D", place / "data", "-U", USER, "-A", "trust")
        port = _free_port()
        options = f"-p {port} -k {place} -c listen_addresses=127.0.0.1"
        start = (programs / "pg_ctl", "-D", place / "data", "-w", "-l", place / "log")
        _run(as_user, *start, "-o", options, "start")
        try:
            yield f"postgresql://{USER}@127.0.0.1:{port}"
        finally:
            _run(as_user, programs / "pg_ctl", "-D", place / "data", "-m", "immediate", "stop")
    finally:
        shutil.rmtree(place, ignore_errors=True)


def new_database(url: str, name: str) -> str:
    """Make an empty database in a server; return its SQLAlchemy URL."""
    import psycopg

    with psycopg.connect(f"{url}/postgres", autocommit=True) as connection:
        connection.execute(
            psycopg.sql.SQL("CREATE DATABASE {}").format(psycopg.sql.Identifier(name))
        )
    return url.replace("postgresql:", "postgresql+psycopg:") + f"/{name}"


def _unprivileged(place: Path) -> list[str]:
    """Return how to become a user that the server runs as: it refuses the superuser."""
    if os.geteuid() != 0:
        return []
    shutil.chown(place, "postgres", "postgres")
    return ["runuser", "-u", "postgres", "--"]


def _run(as_user: list[str], *words: object) -> None:
    command = [*as_user, *map(str, words)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd="/", timeout=60)


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])
