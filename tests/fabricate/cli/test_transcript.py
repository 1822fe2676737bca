"""What `send --transcript` wrote down is every byte, and it plays the same job again."""

from __future__ import annotations

import json
from pathlib import Path

from command import Run

from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.endings import Status
from foldmill_fabricate.plotter.sender import send
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.transcript import Replayed
from foldmill_fabricate.sending import open_job


def test_a_transcript_of_the_command_line_is_the_wire_and_can_be_played_back(
    foldmill: Run, tmp_path: Path
) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    url, paper = "sim://written-down?machine=generic-hpgl-600", tmp_path / "wire.jsonl"
    sent = foldmill(
        "send", "job", "--port", url, "--yes", "--pass", "front", "--transcript", str(paper)
    )
    assert sent.code == 0
    rows = [json.loads(row) for row in paper.read_text().splitlines()]
    written = b"".join(bytes.fromhex(row["data"]) for row in rows if row["to"] == "machine")
    assert written == bytes(devices.behind(url).device.traffic.received)
    assert {row["to"] for row in rows} == {"machine", "host"}
    job, wire = open_job(tmp_path / "job"), Replayed.of(paper)
    for part in (each for each in job.plan.programs if each.face is Face.FRONT):
        delivery = send(job.programs[part.name], wire, job.plan.machine)
        assert delivery.status is Status.EXECUTED
    assert wire.is_over


def test_a_transcript_that_cannot_be_written_is_told_before_anything_is_cut(foldmill: Run) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    url = "sim://not-written?machine=generic-hpgl-600"
    told = foldmill("send", "job", "--port", url, "--yes", "--transcript", "nowhere/wire.jsonl")
    assert told.code == 2
    assert "The transcript nowhere/wire.jsonl cannot be written" in told.err
    assert not devices.behind(url).device.traffic.received
