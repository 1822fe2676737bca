"""The warm parent: imports everything once, then forks a child for each piece of work.

It reads orders, one JSON object a line, from standard input and writes reports to standard output:
``{"do": 7, "call": "module:function", "folder": …, "limits": {…}}`` begins, ``{"kill": 7}`` ends
early; ``{"ready": true}`` and ``{"ended": 7, "signal": 0, "code": 0, "late": false}`` report. It
has one thread, and one only: a fork copies no other. With the end of its input it kills its
children and ends.
"""

from __future__ import annotations

import gc
import json
import os
import select
import signal
import sys
import time
from importlib import import_module
from pathlib import Path
from typing import Any

from foldmill_fabricate.beside import step_aside
from foldmill_fabricate.confining import Limits
from foldmill_fabricate.garbage import look_rarely
from foldmill_fabricate.service.sandbox.child import live

GRACE = 0.5
"""s beyond a limit of wall time, within which processor time may end the child with its reason."""


class Nursery:
    """The children that are at work, by the number of their order."""

    def __init__(self) -> None:
        self._pids: dict[int, int] = {}
        self._limits: dict[int, float] = {}
        self._late: set[int] = set()
        self._rest = b""

    def run(self) -> None:
        """Obey until the input ends."""
        signals, awake = os.pipe()
        os.set_blocking(signals, False)
        os.set_blocking(awake, False)
        signal.set_wakeup_fd(awake, warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        report({"ready": True})
        while True:
            found, _, _ = select.select([0, signals], [], [], self._patience())
            if signals in found:
                os.read(signals, 4096)
            if 0 in found and not self._obey():
                break
            self._kill_late()
            self._reap()
        for pid in self._pids.values():
            os.kill(pid, signal.SIGKILL)

    def _patience(self) -> float | None:
        ends = [end for number, end in self._limits.items() if number not in self._late]
        return max(0.0, min(ends) - time.monotonic()) if ends else None

    def _obey(self) -> bool:
        """Take what has come; False where the input has ended."""
        come = os.read(0, 1 << 16)
        *lines, self._rest = (self._rest + come).split(b"\n")
        for line in lines:
            order = json.loads(line)
            if "kill" in order:
                self._kill(order["kill"])
            else:
                self._bear(order)
        return bool(come)

    def _bear(self, order: dict[str, Any]) -> None:
        limits = Limits(**order["limits"])
        pid = os.fork()
        if pid == 0:
            signal.set_wakeup_fd(-1)
            live(order["call"], Path(order["folder"]), limits)
        self._pids[order["do"]] = pid
        self._limits[order["do"]] = time.monotonic() + limits.seconds + GRACE

    def _kill(self, number: int) -> None:
        if number in self._pids:
            os.kill(self._pids[number], signal.SIGKILL)

    def _kill_late(self) -> None:
        now = time.monotonic()
        for number, end in self._limits.items():
            if end <= now and number not in self._late:
                self._late.add(number)
                self._kill(number)

    def _reap(self) -> None:
        for number, pid in [*self._pids.items()]:
            gone, status = os.waitpid(pid, os.WNOHANG)
            if not gone:
                continue
            del self._pids[number], self._limits[number]
            by = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
            code = 0 if by else os.WEXITSTATUS(status)
            late = number in self._late
            self._late.discard(number)
            report({"ended": number, "signal": by, "code": code, "late": late})


def report(said: dict[str, Any]) -> None:
    """Write one line to whoever runs the nursery."""
    os.write(1, json.dumps(said).encode() + b"\n")


def main() -> None:
    """Import the modules named on the command line, then obey."""
    step_aside()
    look_rarely()
    for name in sys.argv[1:]:
        warm = getattr(import_module(name), "warm", None)
        if warm is not None:
            warm()
    gc.collect()
    gc.freeze()  # a child that collects garbage would copy all that is loaded: up to 0.2 s of each
    Nursery().run()


if __name__ == "__main__":
    main()
