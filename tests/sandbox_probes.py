"""Work that behaves badly, for the sandbox to end."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

KEPT: list[int] = []


def echo(folder: Path, **arguments: Any) -> dict[str, Any]:
    return {"here": str(folder), **arguments}


def loaded(folder: Path, names: list[str]) -> list[str]:
    return [name for name in names if name in sys.modules]


def remember(folder: Path, number: int) -> list[int]:
    KEPT.append(number)
    return KEPT


def conditions(folder: Path) -> dict[str, Any]:
    return {
        "nice": os.nice(0),
        "threads": threading.active_count(),
        "pid": os.getpid(),
        "inside": str(Path.cwd()),
        "open": sorted(int(each.name) for each in Path("/proc/self/fd").iterdir())[:-1],
    }


def sleep(folder: Path, seconds: float) -> None:
    (folder / "begun").touch()
    time.sleep(seconds)


def spin(folder: Path) -> None:
    while True:
        pass


def hoard(folder: Path, megabytes: int) -> int:
    return len(bytearray(megabytes << 20))


def hoard_slowly(folder: Path) -> None:
    kept: list[list[int]] = []
    while True:
        kept.append([*range(1_000_000)])


def write(folder: Path, megabytes: int) -> None:
    (folder / "large").write_bytes(bytes(megabytes << 20))


def crash(folder: Path) -> None:
    os.kill(os.getpid(), signal.SIGSEGV)


def fault(folder: Path) -> None:
    raise RuntimeError("nobody foresaw this secret of the house")


def leave(folder: Path) -> None:
    os._exit(3)
