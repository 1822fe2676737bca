"""frame, jog and register, from the shell."""

from __future__ import annotations

import io
import re
from pathlib import Path

import pytest
import typer
from command import Run
from fabricate.bench import Bench, small_job, small_plan

from foldmill import FoldmillError
from foldmill_fabricate.cli.leading import read_step
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.jogging import expected_marks
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.ledger import Ledger, Program, State, devices
from foldmill_fabricate.plotter.ledger.run import Run as Sending
from foldmill_fabricate.plotter.lock import device_of
from foldmill_fabricate.sheet import turned

SIM = "sim://generic-hpgl-600"


def test_a_frame_is_traced_and_told(foldmill: Run) -> None:
    small_job(Path("job"))
    told = foldmill("frame", "job", "--port", SIM, "--pass", "reverse")
    assert told.code == 0, told.err
    assert re.search(r"Traced \(\d+\.\d+, \d+\.\d+\) to .* the tool up", told.out)


def test_a_step_is_made_within_the_limits_only(foldmill: Run) -> None:
    words = ("--port", "sim://jog?machine=generic-hpgl-600", "--machine", "generic-hpgl-600")
    assert "(30.00, 20.00) mm" in foldmill("jog", "30", "20", *words).out
    assert "(25.00, 20.50) mm" in foldmill("jog", "-5", "0.5", *words).out
    told = foldmill("jog", "-20", "0", *words)
    assert told.code == 2
    assert "5.00 mm beyond what generic-hpgl-600 reaches" in told.err


@pytest.fixture
def confirmed(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What a person was asked to confirm, and has."""
    asked: list[str] = []

    def confirm(text: str, **_: object) -> bool:
        asked.append(text)
        return True

    monkeypatch.setattr("typer.confirm", confirm)
    return asked


class Left:
    """A machine on which something was broken off, and the ledger that knows."""

    def __init__(self, place: Path, monkeypatch: pytest.MonkeyPatch, slug: str) -> None:
        small_job(Path("job"), small_plan(slug))
        self.ledger = Ledger(place / "ledger.sqlite")
        self.url = f"sim://{place.name}?machine={slug}"
        self.words = ("frame", "job", "--port", self.url)
        programs = [Program("1-front-score.hpgl", "front", "b" * 64, 9)]
        lay = self.ledger.lay
        self.sheet = lay("a" * 64, programs, title="Star", machine=slug, material="pp-0.75").id
        own = "foldmill_fabricate.delivering.own_ledger"
        monkeypatch.setattr(own, lambda _url, _who="": self.ledger)

    def run(self, acked: int) -> Sending:
        run = self.ledger.claim(self.sheet, 0, device_of(self.url))
        run.advance(9, acked)
        return run

    def try_(self, what: str) -> None:
        self.ledger.on_device(self.sheet, 0, what, device_of(self.url))


@pytest.fixture
def left(foldmill: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Left:
    return Left(tmp_path, monkeypatch, "roland-like-600")


def test_who_leads_a_machine_on_which_a_program_broke_off_says_once_that_nothing_is_left_in_it(
    foldmill: Run, left: Left, confirmed: list[str]
) -> None:
    """The first hop would end half an instruction, with the tool down."""
    left.run(acked=1)
    assert foldmill(*left.words).code == foldmill(*left.words).code == 0
    (asked,) = confirmed
    assert "switch the machine off and on" in asked
    assert "switched off and on" in left.ledger.history(left.sheet)[-1][2]


def test_without_a_word_nothing_is_sent(
    foldmill: Run, left: Left, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No terminal is there to say it at."""
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    left.run(acked=1)
    told = foldmill(*left.words)
    assert told.code == 2
    assert "Nothing was sent." in told.err


def test_a_test_cut_that_broke_off_is_asked_about_and_one_that_ended_is_not(
    foldmill: Run, left: Left, confirmed: list[str]
) -> None:
    left.try_(devices.TRYING)
    assert foldmill(*left.words).code == 0
    left.try_(devices.TRYING)
    left.try_(devices.TRIED)
    assert foldmill(*left.words).code == 0
    assert len(confirmed) == 1


def test_a_sheet_that_was_given_up_after_its_program_had_ended_leaves_nothing_in_the_machine(
    foldmill: Run, left: Left, confirmed: list[str]
) -> None:
    left.run(acked=9).end(State.DONE)
    left.ledger.give_up(left.sheet)
    assert foldmill(*left.words).code == 0
    assert confirmed == []


def test_a_machine_that_drops_half_an_instruction_is_told_to(
    foldmill: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, confirmed: list[str]
) -> None:
    left = Left(tmp_path, monkeypatch, "generic-hpgl-600")
    left.run(acked=1)
    assert foldmill(*left.words).code == 0
    assert confirmed == []


def test_marks_measured_by_jogging_fit_the_reverse_and_are_kept_for_the_sheet(
    foldmill: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The sheet lies turned by 0.2° and shifted; the operator leads the tool above each hole."""
    job, ledger = small_job(Path("job")), Ledger(tmp_path / "ledger.sqlite")
    monkeypatch.setattr("foldmill_fabricate.delivering.own_ledger", lambda _url, _who="": ledger)
    bench = Bench(small_plan())
    *_, front = send_job(job, bench.url, bench.hands, (Face.FRONT,), ledger=ledger)
    wanted = expected_marks(job.plan)
    seen = [(x + 1.2, y - 0.8) for x, y in turned(wanted, 0.2).tolist()]
    typed: list[str] = []
    for (x, y), (u, v) in zip(wanted, seen, strict=True):
        typed += [f"{u - x:.4f},0", f"w {v - y:.4f}", ""]
    monkeypatch.setattr("typer.prompt", lambda *_, **__: typed.pop(0))
    told = foldmill("register", "job", "--port", bench.url)
    assert told.code == 0, told.err
    assert "a, d, w, s (left, right, up, down)" in told.err
    assert "angle +0.200°" in told.out
    assert f"kept for sheet {front.sheet}" in told.out
    list(send_job(job, bench.url, bench.hands, (Face.REVERSE,), ledger=ledger))
    by_marks = job.fitted(seen)
    plain = Bench(small_plan())
    list(send_job(by_marks, plain.url, plain.hands))
    cut, asked = (each.simulator.sheet.strokes[Face.REVERSE] for each in (bench, plain))
    for one, other in zip(cut, asked, strict=True):
        far = max(
            abs(a - b)
            for p, q in zip(one.points, other.points, strict=True)
            for a, b in zip(p, q, strict=True)
        )
        assert far <= 1
    for each in (bench, plain):
        each.leave()


def test_marks_that_were_begun_to_be_measured_are_not_kept(
    foldmill: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    job, ledger = small_job(Path("job")), Ledger(tmp_path / "ledger.sqlite")
    monkeypatch.setattr("foldmill_fabricate.delivering.own_ledger", lambda _url, _who="": ledger)
    bench = Bench(small_plan())
    *_, front = send_job(job, bench.url, bench.hands, (Face.FRONT,), ledger=ledger)
    before = ledger.history(front.sheet)
    typed = [""]

    def typing(*_: object, **__: object) -> str:
        if not typed:
            raise typer.Abort
        return typed.pop()

    monkeypatch.setattr("typer.prompt", typing)
    told = foldmill("register", "job", "--port", bench.url)
    assert (told.code, told.out) == (1, "")
    assert told.err.endswith("keeps nothing.\n\nAborted.\n")
    assert ledger.history(front.sheet) == before
    bench.leave()


def test_keys_and_numbers_are_steps() -> None:
    assert [read_step(text) for text in ("d", "a 0.5", "w10", "S 2", "1,-2.5")] == [
        (1.0, 0.0),
        (-0.5, 0.0),
        (0.0, 10.0),
        (0.0, -2.0),
        (1.0, -2.5),
    ]
    for wrong in ("x", "1", "d far", "1,2,3"):
        with pytest.raises(FoldmillError, match="Write dx,dy in mm"):
            read_step(wrong)
