"""frame, jog and register, from the shell."""

from __future__ import annotations

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
from foldmill_fabricate.plotter.ledger import Ledger, Program
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


@pytest.mark.parametrize(
    ("slug", "word", "code"),
    [("roland-like-600", "", 2), ("roland-like-600", "yes", 0), ("generic-hpgl-600", "", 0)],
)
def test_who_leads_a_machine_on_which_a_program_broke_off_says_first_that_nothing_is_left_in_it(
    foldmill: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, slug: str, word: str, code: int
) -> None:
    """The first hop would end half an instruction; one that can drop it is told to."""
    small_job(Path("job"), small_plan(slug))
    ledger = Ledger(tmp_path / "ledger.sqlite")
    monkeypatch.setattr("foldmill_fabricate.delivering.own_ledger", lambda _url, _who="": ledger)
    url = f"sim://broken-off-{code}?machine={slug}"
    programs = [Program("1-front-score.hpgl", "front", "b" * 64, 9)]
    sheet = ledger.lay("a" * 64, programs, title="Star", machine=slug, material="pp-0.75").id
    ledger.claim(sheet, 0, device_of(url)).advance(3, 1)
    asked: list[str] = []

    def confirm(text: str, **_: object) -> bool:
        asked.append(text)
        return word == "yes"

    monkeypatch.setattr("typer.confirm", confirm)
    told = foldmill("frame", "job", "--port", url)
    assert told.code == code, told.err
    assert [("switch the machine off and on" in text) for text in asked] == (
        [] if slug == "generic-hpgl-600" else [True]
    )
    assert ("Traced" in told.out) == (code == 0)


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
