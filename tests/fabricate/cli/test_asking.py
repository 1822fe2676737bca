"""Whoever reads what a job asks reads as well which command answers it."""

from __future__ import annotations

import re
import shlex

import pytest
from command import Run

from foldmill_fabricate.cli.asking import commands, told
from foldmill_fabricate.jobs.states import JobState
from foldmill_fabricate.jobs.values import JobRecord, Kind, Question

NOTE = "Load a sheet. Write its id MQ5K on both faces."


def question(kind: Kind, text: str = NOTE, **data: str) -> Question:
    return Question(
        id="32a8cc043b6951c0",
        job="QB33HH",
        sheet="MQ5K",
        program=0,
        kind=kind,
        setup="front-holes",
        face="front",
        text=text,
        data=data,
        asked="2026-11-22T19:55:01.452+00:00",
    )


def job(state: JobState) -> JobRecord:
    return JobRecord(
        id="QB33HH",
        title="Stool",
        plotter="bench",
        material="pp-0.75",
        machine="generic-hpgl-600",
        plan="0" * 64,
        copies=3,
        priority=0,
        state=state,
        note=NOTE,
        wish="",
        begun=True,
        sheets=("MQ5K",),
        who="anna",
        submitted="2026-11-22T19:54:40.888+00:00",
        ended="",
        remakes="",
    )


@pytest.mark.parametrize("kind", Kind)
def test_every_command_that_answers_is_understood_as_it_is_told(foldmill: Run, kind: Kind) -> None:
    for command in commands(question(kind, proved="finished")):
        words = re.sub(r"[][]", "", command).replace("ID-ON-THE-SHEET", "MQ5K")
        name, *rest = shlex.split(re.sub("MM|°C|STROKE", "1", words), comments=True)
        refused = foldmill(*rest)
        assert (name, refused.code) == ("foldmill", 2)
        assert "There is no question '32a8cc043b6951c0'" in refused.err


@pytest.mark.parametrize("kind", [Kind.FLIP, Kind.RE_REGISTER])
def test_the_id_of_a_sheet_is_left_to_be_read_off_the_sheet(kind: Kind) -> None:
    assert all("ID-ON-THE-SHEET" in one and "MQ5K" not in one for one in commands(question(kind)))


def test_what_a_job_asks_is_said_once() -> None:
    asked = told(job(JobState.WAITING), [question(Kind.LOAD)])
    assert asked.count(NOTE) == told(job(JobState.WAITING)).count(NOTE) == 1
    assert "foldmill job answer 32a8cc043b6951c0 [--thickness MM]" in asked
