"""Real Dask schedulers and workers on loopback, each a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import foldmill
import foldmill_fabricate
import foldmill_plugins

OURS = [Path(p.__file__ or "").parents[1] for p in (foldmill, foldmill_plugins, foldmill_fabricate)]
WAIT_S = 30.0
Process = subprocess.Popen[bytes]


def whole() -> dict[str, str]:
    """Return the environment of a machine that has what this process has."""
    return os.environ | {"PYTHONPATH": os.pathsep.join(map(str, OURS))}


def bare(folder: Path) -> dict[str, str]:
    """Return the environment of a machine with all that is installed here except foldmill.

    Python starts there without looking into site-packages: it is given links to what it may have.
    """
    folder.mkdir()
    for entry in Path(sysconfig.get_paths()["purelib"]).iterdir():
        if not entry.name.startswith(("foldmill", "_foldmill")) and entry.suffix != ".pth":
            (folder / entry.name).symlink_to(entry)
    return os.environ | {"PYTHONPATH": str(folder)}


def older(folder: Path, version: str) -> dict[str, str]:
    """Return the environment of a machine on which another version of foldmill is installed."""
    environment = bare(folder)
    for source, package in zip(OURS, (foldmill, foldmill_plugins, foldmill_fabricate), strict=True):
        (folder / package.__name__).symlink_to(source / package.__name__)
    facts = folder / f"foldmill-{version}.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text(f"Metadata-Version: 2.1\nName: foldmill\nVersion: {version}\n")
    return environment


@contextmanager
def process(module: str, *words: str, at: Path, env: dict[str, str]) -> Iterator[Process]:
    """Run a module of Python without site-packages but those of the environment."""
    is_linked = env["PYTHONPATH"].startswith(str(at))
    command = [sys.executable, *(["-S"] if is_linked else []), "-m", module, *words]
    with (at / "log.txt").open("ab") as log:
        running = subprocess.Popen(command, cwd=at, env=env, stdout=log, stderr=log)
    try:
        yield running
    finally:
        running.kill()
        running.wait()


@contextmanager
def scheduler(at: Path, env: dict[str, str]) -> Iterator[str]:
    """Run a scheduler; gives its address."""
    told = at / "scheduler.json"
    words = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(told)]
    with process("distributed.cli.dask_scheduler", *words, at=at, env=env):
        import json

        until = time.monotonic() + WAIT_S
        while time.monotonic() < until:
            try:
                yield json.loads(told.read_text())["address"]
                return
            except (OSError, ValueError):
                time.sleep(0.05)
        raise AssertionError(f"no scheduler: {(at / 'log.txt').read_text()}")


@contextmanager
def worker(address: str, name: str, at: Path, env: dict[str, str]) -> Iterator[Process]:
    """Run a worker of one thread; it has joined its scheduler when this gives it."""
    import distributed

    connect: Any = distributed.Client
    with starting(address, name, at, env) as running, connect(address, set_as_default=False) as c:
        until = time.monotonic() + WAIT_S
        while name not in names(c):
            assert time.monotonic() < until, (at / "log.txt").read_text()
            time.sleep(0.05)
        yield running
        running.kill()
        while name in names(c):
            time.sleep(0.05)


@contextmanager
def starting(address: str, name: str, at: Path, env: dict[str, str]) -> Iterator[Process]:
    """Run a worker that has yet to join its scheduler."""
    words = [address, "--host", "127.0.0.1", "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    words += ["--name", name, "--local-directory", str(at / name)]
    with process("distributed.cli.dask_worker", *words, at=at, env=env) as running:
        yield running


def names(client: Any) -> set[str]:
    """Return the names of the workers that a scheduler has."""
    told = client.scheduler_info(n_workers=-1)
    return {str(each["name"]) for each in told["workers"].values()}
