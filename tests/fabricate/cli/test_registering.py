"""Keeping the faces in register, from the shell."""

from __future__ import annotations

from pathlib import Path

import hand_made
import pytest
from command import Run

from foldmill.exchange import fold as fold_file
from foldmill_fabricate.marks import witness_middle
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.sheet import NOMINAL, on_carrier, seen_by_machine

SMALL = ("plan", "strip.fold", "--blank", "200x180", "-o", "job")


@pytest.fixture
def strip(foldmill: Run) -> Run:
    Path("strip.fold").write_text(fold_file.write(hand_made.fold()), encoding="utf-8")
    return foldmill


def planned() -> Plan:
    return Plan.model_validate_json(Path("job/plan.json").read_bytes())


def test_another_registration_is_planned_verified_and_told_on_the_job_sheet(strip: Run) -> None:
    words = ("--registration", "l-marks", "--machine", "graphtec-summa-like")
    assert strip(*SMALL, *words).code == 0
    assert planned().registration.kind == "l-marks"
    assert strip("verify", "job").code == 0
    assert Path("job/1-front-marks.hpgl").is_file()
    assert Path("job/job-sheet.pdf").is_file()


def test_a_kind_the_machine_has_not_is_refused_with_those_it_has(strip: Run) -> None:
    told = strip(*SMALL, "--registration", "pins")
    assert told.code == 2
    assert "it can by holes, edge, none" in told.err
    assert not Path("job").exists()


def test_temperatures_go_into_the_plan(strip: Run) -> None:
    assert strip(*SMALL, "--temperature", "21,24.5").code == 0
    assert planned().temperatures == (21.0, 24.5)
    assert "write FRONT,REVERSE" in strip(*SMALL, "--temperature", "warm").err


def test_sending_tells_what_the_temperatures_of_the_day_do(strip: Run) -> None:
    assert strip(*SMALL).code == 0
    told = strip(
        "send", "job", "--port", "sim://generic-hpgl-600", "--yes", "--temperature", "18,31"
    )
    assert told.code == 0
    assert "The reverse likely lands within" in told.out
    assert "temperature" in told.out


def test_a_witness_mark_seen_where_it_was_stops_the_reverse(strip: Run) -> None:
    """The front is still up: the F is where the machine scored it."""
    assert strip(*SMALL).code == 0
    plan = planned()
    middle = witness_middle(plan)
    assert middle is not None
    send = ("send", "job", "--port", "sim://generic-hpgl-600", "--yes", "--witness")
    same = on_carrier([middle], plan.sheet)[0]
    over = seen_by_machine(plan, Face.REVERSE, [middle], NOMINAL)[0]
    told = strip(*send, f"{same[0]:.1f},{same[1]:.1f}")
    assert told.code == 2
    assert "not turned over: the front is still up" in told.err
    assert strip(*send, f"{over[0]:.1f},{over[1]:.1f}").code == 0
    assert "takes one place" in strip(*send, "1,2;3,4").err
