"""Prove a job folder in a process of its own, so that machines at work are never kept waiting.

What was proved is told by a digest of every byte that counts; what is sent must have the same.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.jobs.elsewhere import Late, Silent, done, serve
from foldmill_fabricate.sending import prove
from foldmill_fabricate.verify import JobFiles, read_folder

_PATIENCE = 3600.0
"""s after which a proof is given up."""


def prove_elsewhere(path: Path, files: JobFiles, heed: Callable[[], None]) -> None:
    """Have another process prove a folder; raises CannotSend where it must not be sent.

    heed : called again and again meanwhile; what it raises ends the proof.
    """
    try:
        told = done("foldmill_fabricate.jobs.proving", {"path": str(path)}, heed, _PATIENCE)
    except Late:
        raise CannotSend(f"{path} is not sent: proving it took more than an hour.") from None
    except Silent as end:
        raise CannotSend(f"{path} is not sent, for proving it failed: {end.why}") from None
    if told["refused"]:
        raise CannotSend(told["refused"])
    if told["digest"] != digest(files):
        raise CannotSend(f"{path} is not sent, for it was changed while it was proved.")


def digest(files: JobFiles) -> str:
    """Return the SHA-256 of everything that a proof rests on."""
    whole = hashlib.sha256(files.plan.model_dump_json().encode())
    whole.update(hashlib.sha256(files.pattern_bytes).digest())
    for name, program in sorted(files.programs.items()):
        whole.update(hashlib.sha256(name.encode()).digest())
        whole.update(hashlib.sha256(program).digest())
    return whole.hexdigest()


def _proved(told: dict[str, Any]) -> dict[str, str]:
    """Prove a folder in this process; raises FoldmillError."""
    path = Path(told["path"])
    files = read_folder(path)
    prove(path, files)
    return {"digest": digest(files)}


if __name__ == "__main__":
    serve(_proved)
