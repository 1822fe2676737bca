"""A job folder that may be sent: read once, proved again, its reverse fitted to measured marks.

Nothing is sent that was not verified in this very call, so an edited file never reaches a machine.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from foldmill import CreasePattern
from foldmill.finding import Severity
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.marks import MarkFit, check_witness, fit_marks
from foldmill_fabricate.passes import Face, Plan, SetUp
from foldmill_fabricate.verify import JobFiles, Verification, read_folder, verify, verify_files
from foldmill_fabricate.writers import writer

Fitter = Callable[["Job", MarkFit], tuple[Mapping[str, bytes], Verification | None]]
"""Writes the reverse of a job anew to fit a sheet, and proves it; raises CannotSend likewise."""
Prover = Callable[[Path, JobFiles], Verification | None]
"""Proves what was read of a folder; raises CannotSend where it must not be sent."""
Trier = Callable[["Job", Face, SetUp, int], bytes]
"""Makes the program of a test cut for a set-up, and proves it, as ``trials.trial_program``."""


def refit(job: Job, fit: MarkFit) -> tuple[Mapping[str, bytes], Verification]:
    """Fit a job in this process: its programs, the reverse written anew, and their proof.

    Raises CannotSend where they do not verify, or nothing writes them.
    """
    format_ = writer(job.plan.machine)
    if format_ is None or format_.program is None:
        raise CannotSend(
            f"{job.path} cannot be fitted to marks: nothing installed writes programs in "
            f"{job.plan.machine.language} anew. Find the sheet by its edges."
        )
    programs = {**job.programs} | {
        part.name: format_.program(job.plan, part.setups, fit.fit)
        for part in job.plan.programs
        if part.face is Face.REVERSE
    }
    proof = verify(job.plan, job.pattern, programs, fit.fit)
    _refuse(proof, job.path)
    return programs, proof


@dataclass(frozen=True, eq=False)
class Job:
    """A verified job folder, its reverse fitted where marks were measured."""

    plan: Plan
    programs: Mapping[str, bytes]
    proof: Verification | None
    """None where another process has proved it."""
    fit: MarkFit | None
    pattern: CreasePattern
    path: Path
    marks: tuple[tuple[float, float], ...] = ()
    """What it was fitted to, carrier coordinates in mm."""
    fitter: Fitter = refit
    """By default in this process."""
    trier: Trier | None = None
    """Of test cuts; likewise."""

    @property
    def id(self) -> str:
        """SHA-256 of the plan: what the ledger knows the job by."""
        return self.plan.digest

    def fitted(self, marks: Sequence[tuple[float, float]]) -> Job:
        """Return the job with its reverse written anew to fit measured marks, and proved again.

        marks : carrier coordinates in mm. Raises CannotSend where they do not explain a sheet, or
        the programs do not verify.
        """
        fit = fit_marks(self.plan, marks)
        programs, proof = self.fitter(self, fit)
        measured = tuple((float(x), float(y)) for x, y in marks)
        return replace(self, programs=programs, proof=proof, fit=fit, marks=measured)


def prove(path: Path, files: JobFiles) -> Verification:
    """Prove a folder in this process; raises CannotSend where it must not be sent."""
    proof = verify_files(files)
    _refuse(proof, path)
    return proof


def open_job(
    path: Path,
    marks: Sequence[tuple[float, float]] = (),
    witness: tuple[float, float] | None = None,
    prover: Prover = prove,
    fitter: Fitter = refit,
    trier: Trier | None = None,
) -> Job:
    """Read a job folder and prove it; raises CannotSend where it must not be sent.

    marks : where registration marks are seen after the flip, carrier coordinates in mm; the reverse
    programs are written anew to fit, and proved again. witness : where the witness mark is seen.
    prover, fitter, trier : by default in this process.
    """
    files = read_folder(path)
    plan = files.plan
    proof = prover(path, files)
    if not plan.programs:
        raise CannotSend(f"{path} holds drawings only; plan it again without --to.")
    unproved = [part.name for part in plan.programs if part.name not in files.programs]
    if unproved:
        raise CannotSend(f"{path} is not sent, for {unproved[0]} was not verified.")
    programs = {part.name: files.programs[part.name] for part in plan.programs}
    if witness is not None:
        check_witness(plan, witness)
    job = Job(plan, programs, proof, None, files.pattern, path, fitter=fitter, trier=trier)
    return job.fitted(marks) if marks else job


def _refuse(proof: Verification, path: Path) -> None:
    errors = [finding for finding in proof.findings if finding.severity is Severity.ERROR]
    if errors:
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise CannotSend(f"{path} is not sent, for it does not verify: {errors[0]}{more}")
