"""Have a module of ours do a piece of work in a process of its own, and hear how that ended.

What it is told goes in as JSON; out comes JSON, or the sentence by which it refuses.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from math import inf
from pathlib import Path
from typing import Any

from foldmill.errors import FoldmillError
from foldmill_fabricate.beside import step_aside
from foldmill_fabricate.garbage import look_rarely
from foldmill_fabricate.space import DiskFull, keeping

_LOOK = 0.2
"""s between two looks at what is wanted meanwhile."""


class Silent(Exception):
    """A process that ended without a word."""

    def __init__(self, code: int, errors: bytes) -> None:
        lines = errors.decode(errors="replace").strip().splitlines()
        self.code, self.why = code, lines[-1] if lines else "no reason given"
        super().__init__(self.why)


class Late(Exception):
    """A process that was killed because it took too long."""


def done(
    module: str,
    told: Mapping[str, Any],
    heed: Callable[[], None] = lambda: None,
    patience: float = inf,
) -> dict[str, Any]:
    """Return what a module's process says once it has ended; it never outlives this call.

    ``refused`` of it is the sentence of a refusal, or empty. heed : called again and again
    meanwhile; what it raises ends the process. patience : s. Raises Silent and Late, and DiskFull
    where it found no room for what it makes.
    """
    pipe, end = subprocess.PIPE, time.monotonic() + patience
    command = [sys.executable, "-m", module]
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe) as child:
        try:
            out, errors = _heard(child, json.dumps(told).encode(), heed, end)
        except BaseException:
            child.kill()
            raise
    try:
        said: dict[str, Any] = json.loads(out)
    except ValueError:
        raise Silent(child.returncode, errors) from None
    if full := said.pop("full", ""):
        raise DiskFull(full)
    return said


def _heard(
    child: subprocess.Popen[bytes], told: bytes, heed: Callable[[], None], end: float
) -> tuple[bytes, bytes]:
    """Return what a process has written to its output and to its errors."""
    given: bytes | None = told
    while time.monotonic() < end:
        heed()
        try:
            return child.communicate(given, timeout=_LOOK)
        except subprocess.TimeoutExpired:
            given = None  # it is on its way
    raise Late


def serve(work: Callable[[dict[str, Any]], Mapping[str, Any]]) -> None:
    """Do, as such a process, what standard input tells, and say how that ended."""
    step_aside()
    look_rarely()
    said: dict[str, Any] = {"refused": ""}
    try:
        with keeping(Path(tempfile.gettempdir())):
            said |= work(json.loads(sys.stdin.read()))
    except DiskFull as error:
        said["full"] = str(error)
    except FoldmillError as error:
        said["refused"] = str(error)
    sys.stdout.write(json.dumps(said))
