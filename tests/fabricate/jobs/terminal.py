"""A person at the computer of a workshop: commands in processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from fabricate.jobs.workshop import Workshop

COMMAND = [sys.executable, "-m", "foldmill_fabricate"]


def environment(shop: Workshop) -> dict[str, str]:
    """Return that of a person at the same computer."""
    more = {
        "XDG_STATE_HOME": str(shop.root / "state"),
        "XDG_CONFIG_HOME": str(shop.root / "config"),
        "FOLDMILL_DATABASE": shop.places.database,
    }
    return {**os.environ, **more}


def said(shop: Workshop, *words: str, **more: str) -> subprocess.CompletedProcess[str]:
    """Call the command in a process of its own; more : variables of its environment."""
    return subprocess.run(
        [*COMMAND, *words],
        env=environment(shop) | more,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )


@contextmanager
def typing(shop: Workshop, *words: str, **more: str) -> Iterator[subprocess.Popen[str]]:
    """Start a command that can be answered; it ends with the context."""
    with subprocess.Popen(
        [*COMMAND, *words],
        env=environment(shop) | more,
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def plain(text: str | None) -> str:
    """Return what was said without the ends of its lines."""
    return " ".join((text or "").split())
