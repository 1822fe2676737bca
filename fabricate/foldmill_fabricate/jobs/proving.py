"""Prove a job folder in a process of its own, so that machines at work are never kept waiting.

What was proved is told by a digest of every byte that counts; what is sent must have the same.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

from foldmill.errors import FoldmillError
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.sending import prove
from foldmill_fabricate.verify import JobFiles, read_folder

_PATIENCE = 3600.0
"""s after which a proof is given up."""


def prove_elsewhere(path: Path, files: JobFiles) -> None:
    """Have another process prove a folder; raises CannotSend where it must not be sent."""
    command = [sys.executable, "-m", "foldmill_fabricate.jobs.proving", str(path)]
    try:
        done = subprocess.run(command, capture_output=True, timeout=_PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        raise CannotSend(f"{path} is not sent: proving it took more than an hour.") from None
    try:
        told = json.loads(done.stdout)
    except ValueError:
        why = done.stderr.decode(errors="replace").strip().splitlines()[-1:] or ["no reason given"]
        raise CannotSend(f"{path} is not sent, for proving it failed: {why[0]}") from None
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


def main(path: str) -> None:
    """Prove a folder and say on standard output how that ended."""
    if hasattr(os, "nice"):
        os.nice(10)
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
