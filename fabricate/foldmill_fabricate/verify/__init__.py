"""Proof before anything is sent. Shares no code with planning, placing, ordering and writing.

Two proofs: the programs, replayed on a virtual sheet, draw the plan (``programs``); and the plan is
what pattern, process rule and placement ask for (``rule``). Mirror, placement, rounding and repeats
are derived here a second time, so that a fault has to be made twice to pass unseen.
"""

from foldmill_fabricate.verify.faults import Fault, Kind
from foldmill_fabricate.verify.folder import (
    JobFiles,
    read_folder,
    verify_files,
    verify_folder,
)
from foldmill_fabricate.verify.report import report
from foldmill_fabricate.verify.verification import Figures, Verification, verify

__all__ = [
    "Fault",
    "Figures",
    "JobFiles",
    "Kind",
    "Verification",
    "read_folder",
    "report",
    "verify",
    "verify_files",
    "verify_folder",
]
