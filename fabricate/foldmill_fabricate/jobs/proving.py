"""Prove a job folder in a process of its own, so that machines at work are never kept waiting.

What was proved is told by a digest of every byte that counts; what is sent must have the same.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from foldmill.errors import FoldmillError
from foldmill_fabricate.beside import step_aside
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.sending import prove
from foldmill_fabricate.verify import JobFiles, read_folder

_LOOK = 0.2
"""s between two looks at what is wanted meanwhile."""
_PATIENCE = 3600.0
"""s after which a proof is given up."""


def prove_elsewhere(path: Path, files: JobFiles, heed: Callable[[], None]) -> None:
    """Have another process prove a folder; raises CannotSend where it must not be sent.

    heed : called again and again meanwhile; what it raises ends the proof.
    """
    command = [sys.executable, "-m", "foldmill_fabricate.jobs.proving", str(path)]
    out, errors = _done(command, path, heed)
    try:
        told = json.loads(out)
    except ValueError:
        why = errors.decode(errors="replace").strip().splitlines()[-1:] or ["no reason given"]
        raise CannotSend(f"{path} is not sent, for proving it failed: {why[0]}") from None
    if told["refused"]:
        raise CannotSend(told["refused"])
    if told["digest"] != digest(files):
        raise CannotSend(f"{path} is not sent, for it was changed while it was proved.")


def _done(command: Sequence[str], path: Path, heed: Callable[[], None]) -> tuple[bytes, bytes]:
    """Return what a process has said, once it has ended; it never outlives its proof."""
    pipe, end = subprocess.PIPE, time.monotonic() + _PATIENCE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe) as child:
        try:
            while time.monotonic() < end:
                heed()
                try:
                    return child.communicate(timeout=_LOOK)
                except subprocess.TimeoutExpired:
                    continue
            raise CannotSend(f"{path} is not sent: proving it took more than an hour.")
        except BaseException:
            child.kill()
            raise


def digest(files: JobFiles) -> str:
    """Return the SHA-256 of everything that a proof rests on."""
    whole = hashlib.sha256(files.plan.model_dump_json().encode())
    whole.update(hashlib.sha256(files.pattern_bytes).digest())
    for name, program in sorted(files.programs.items()):
        whole.update(hashlib.sha256(name.encode()).digest())
        whole.update(hashlib.sha256(program).digest())
    return whole.hexdigest()


def main(path: str) -> None:
    """Prove a folder and say on standard output how that ended."""
    step_aside()
    told = {"digest": "", "refused": ""}
    try:
        files = read_folder(path)
        told["digest"] = digest(files)
        prove(Path(path), files)
    except FoldmillError as error:
        told["refused"] = str(error)
    sys.stdout.write(json.dumps(told))


if __name__ == "__main__":
    main(sys.argv[1])
