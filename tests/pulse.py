"""Ask a service again and again whether it works, from a process that does nothing else.

A thread beside the test would wait for whatever the test computes meanwhile.
"""

from __future__ import annotations

import json
import select
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx

PAUSE = 0.02
"""s between two questions."""


class Pulse:
    """What was answered."""

    def __init__(self) -> None:
        self.seconds: list[float] = []
        """until each answer came"""
        self.failed = 0
        """answers that said that it does not work"""


@contextmanager
def asking(url: str) -> Iterator[Pulse]:
    """Ask beside whatever is done meanwhile; afterwards the pulse holds what was answered."""
    pulse = Pulse()
    with subprocess.Popen(
        [sys.executable, __file__, url], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        yield pulse
        told, _ = process.communicate("")
    pulse.seconds, pulse.failed = json.loads(told)


def main() -> None:
    """Ask until the input ends, then tell."""
    seconds, failed = list[float](), 0
    with httpx.Client(base_url=sys.argv[1], timeout=30) as client:
        while not select.select([sys.stdin], [], [], PAUSE)[0]:
            began = time.perf_counter()
            failed += client.get("/healthz").status_code != 200
            seconds.append(time.perf_counter() - began)
    sys.stdout.write(json.dumps([seconds, failed]))


if __name__ == "__main__":
    main()
