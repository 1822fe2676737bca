"""Ids in paths and queries: how each is written, and what a person calls it."""

from __future__ import annotations

from typing import Annotated

from fastapi import Header, Path, Query

from foldmill_fabricate.service.models import DIGEST, Digest

_JOB, _JOBS = "^[A-Za-z0-9]{1,20}$", "^[A-Za-z0-9]{0,20}$"
_SHEET, _QUESTION, _EVENT = "^[A-Za-z0-9]{1,8}$", "^[0-9a-f]{1,64}$", "^[0-9]{0,18}$"
SPELLED = {
    DIGEST: "an id of 64 digits, 0-9 and a-f",
    _JOB: "the id of a job, such as K3PX7Q",
    _JOBS: "the id of a job, such as K3PX7Q, or empty",
    _SHEET: "the id that is written on a sheet, such as K7QF",
    _QUESTION: "the id of a question, digits 0-9 and a-f",
    _EVENT: "the number of an event, such as 12, or empty",
}
"""What a text is called that has to match an expression."""
PatternId = Annotated[Digest, Path(description="A pattern's id: the SHA-256 of its FOLD file.")]
PlanId = Annotated[Digest, Path(description="A plan's id: the SHA-256 of all it is made from.")]
JobId = Annotated[str, Path(pattern=_JOB, description="A job's id.")]
OneJob = Annotated[str, Query(pattern=_JOBS, description="Only of this job.")]
SheetId = Annotated[str, Path(pattern=_SHEET, description="As it is written on the sheet.")]
QuestionId = Annotated[str, Path(pattern=_QUESTION, description="Good for one answer.")]
EventNumber = Annotated[str, Header(pattern=_EVENT, description="Heard last.")]
