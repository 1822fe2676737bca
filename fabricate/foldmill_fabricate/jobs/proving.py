"""Prove a job folder in a process of its own, so that machines at work are never kept waiting.

So is a reverse that is fitted to measured marks, and a test cut: they are written there, and
proved. What was proved is told by a digest of every byte that counts; what is sent must have the
same. One that this very process has had proved before is not proved again.
"""

from __future__ import annotations

import hashlib
from base64 import b64decode, b64encode
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.jobs.elsewhere import Late, Silent, done, serve
from foldmill_fabricate.marks import MarkFit
from foldmill_fabricate.passes import Face, Fit, SetUp
from foldmill_fabricate.sending import Job, prove, refit
from foldmill_fabricate.trials import trial_program
from foldmill_fabricate.verify import JobFiles, read_folder

_PATIENCE = 3600.0
"""s after which a proof is given up."""


class Elsewhere:
    """Proves a folder, and fits what was proved, in other processes.

    heed : called again and again meanwhile; what it raises ends the work. proven : digests of what
    was proved before, to which it adds.
    """

    def __init__(self, heed: Callable[[], None], proven: set[str] | None = None) -> None:
        self._heed, self._digest = heed, ""
        self._proven = set[str]() if proven is None else proven

    def prove(self, path: Path, files: JobFiles) -> None:
        """Prove a folder; raises CannotSend where it must not be sent."""
        whole = digest(files)
        if whole not in self._proven:
            self._told({"path": str(path)}, path, whole)
            self._proven.add(whole)
        self._digest = whole

    def fit(self, job: Job, fit: MarkFit) -> tuple[Mapping[str, bytes], None]:
        """Return the programs of a job, its reverse fitted and all of it proved.

        Raises CannotSend where they do not verify, and where the folder is not any more as it was
        proved.
        """
        order = {"path": str(job.path), "fit": fit.fit.model_dump()}
        told = self._told(order, job.path, self._digest)
        return {name: b64decode(data) for name, data in told["programs"].items()}, None

    def trial(self, job: Job, face: Face, setup: SetUp, attempt: int) -> bytes:
        """Return the program of a test cut, proved.

        Raises CannotSend where the waste has no room for it, where it does not verify, and where
        the folder is not any more as it was proved.
        """
        order: dict[str, Any] = {"path": str(job.path), "face": face.value}
        order |= {"trial": setup.number, "attempt": attempt}
        order |= {"fit": job.fit.fit.model_dump()} if job.fit else {}
        return b64decode(self._told(order, job.path, self._digest)["program"])

    def _told(self, order: dict[str, Any], path: Path, digest: str) -> dict[str, Any]:
        try:
            told = done("foldmill_fabricate.jobs.proving", order, self._heed, _PATIENCE)
        except Late:
            raise CannotSend(f"{path} is not sent: proving it took more than an hour.") from None
        except Silent as end:
            raise CannotSend(f"{path} is not sent, for proving it failed: {end.why}") from None
        if told["refused"]:
            raise CannotSend(told["refused"])
        if told["digest"] != digest:
            raise CannotSend(f"{path} is not sent, for it was changed while it was proved.")
        return told


def digest(files: JobFiles) -> str:
    """Return the SHA-256 of everything that a proof rests on."""
    whole = hashlib.sha256(files.plan.model_dump_json().encode())
    whole.update(hashlib.sha256(files.pattern_bytes).digest())
    for name, program in sorted(files.programs.items()):
        whole.update(hashlib.sha256(name.encode()).digest())
        whole.update(hashlib.sha256(program).digest())
    return whole.hexdigest()


def _proved(told: dict[str, Any]) -> dict[str, Any]:
    """Prove a folder in this process, or what is made of it; raises FoldmillError."""
    path = Path(told["path"])
    files = read_folder(path)
    said: dict[str, Any] = {"digest": digest(files)}
    fit = MarkFit(Fit.model_validate(told["fit"]), 1.0, 0.0) if "fit" in told else None
    known = [part.name for part in files.plan.programs if part.name in files.programs]
    named = {name: files.programs[name] for name in known}
    job = Job(files.plan, named, None, fit, files.pattern, path)
    if "trial" in told:
        every = {one.number: one for work in job.plan.passes for one in work.setups}
        setup = every[told["trial"]]
        data = trial_program(job, Face(told["face"]), setup, told["attempt"])
        return said | {"program": b64encode(data).decode()}
    if fit is None:
        prove(path, files)
        return said
    programs, _ = refit(job, fit)
    return said | {"programs": {name: b64encode(data).decode() for name, data in programs.items()}}


if __name__ == "__main__":
    serve(_proved)
