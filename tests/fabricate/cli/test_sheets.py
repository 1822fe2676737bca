"""A sheet that was left half made is drawn, and its rest planned, from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command import Run
from fabricate.bench import Bench, small_plan
from fabricate.half_made import PENS, job_of, left_half_made

from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.jobs import JobStore, Places
from foldmill_fabricate.plotter.errors import Spoiled
from foldmill_fabricate.plotter.ledger import Ledger, Said, Word, ledger_file, ledger_place
from foldmill_fabricate.sending import open_job


@pytest.fixture
def half(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[str, Bench]:
    """The id of a sheet whose reverse was stopped, and the plotter it lies on."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "state"))
    job = job_of(tmp_path / "job", small_plan(PENS))
    bench, ledger = Bench(job.plan), Ledger(ledger_file())
    sheet = left_half_made(job, bench, ledger, 1, 12)
    ledger.close()
    return sheet.id, bench


def test_its_rest_is_planned_and_made_once_somebody_has_said_what_is_cut(
    half: tuple[str, Bench], foldmill: Run, tmp_path: Path
) -> None:
    name, bench = half
    silent = foldmill("sheets", name, "--remake", "-o", "rest")
    assert silent.code == 2
    assert "reverse.hpgl: 1-3. Look at the sheet" in " ".join(silent.err.split())
    assert not Path("rest").exists()
    said = foldmill("sheets", name, "--remake", "-o", "rest", "--doubtful", "2-3", "--json")
    assert said.code == 0, said.err
    assert json.loads(said.out)["remakes"]["sheet"] == name
    assert foldmill("verify", "rest").code == 0
    rest = open_job(Path("rest"))
    with_state = Ledger(ledger_file())
    sent = list(send_job(rest, bench.url, bench.hands, ledger=with_state))
    assert [one.state.value for one in sent] == ["done"]
    with_state.close()
    again = foldmill("send", "rest", "--port", f"sim://{PENS}", "--yes")
    assert again.code == 2  # that simulator's ledger is another
    assert "knows no sheet" in again.err
    bench.leave()
    assert {file.name for file in Path("rest").iterdir()} >= {
        "reverse.svg",
        "reverse.hpgl",
        "job-sheet.pdf",
        "pattern.fold",
        "plan.json",
    }
    assert not (tmp_path / "rest" / "front.hpgl").exists()


def test_it_is_drawn_as_cut(half: tuple[str, Bench], foldmill: Run) -> None:
    name, bench = half
    assert foldmill("sheets", name.lower(), "-o", "as-cut.png").code == 0
    assert Path("as-cut.png").read_bytes().startswith(b"\x89PNG")
    Path("job").rename("elsewhere")
    moved = foldmill("sheets", name, "-o", "again.png")
    assert moved.code == 2
    assert "There is no folder" in moved.err
    assert foldmill("sheets", name, "-o", "again.png", "--job", "elsewhere").code == 0
    assert Path("again.png").read_bytes() == Path("as-cut.png").read_bytes()
    bench.leave()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--remake",), "name its id"),
        (("AAAA", "--remake"), "name it with --output"),
        (("AAAA", "-o", "x", "--doubtful", "cut"), "give that, too"),
        (("AAAA", "--remake", "-o", "x"), "knows no sheet"),
        (("AAAA", "-o", "x.svg"), "drawn as a PNG"),
    ],
)
def test_what_makes_no_sense_is_refused(
    words: tuple[str, ...],
    told: str,
    foldmill: Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "state"))
    found = foldmill("sheets", *words)
    assert found.code == 2
    assert told in " ".join(found.err.split())


def test_a_sheet_that_is_being_cut_is_given_up_and_its_machine_stops(
    half: tuple[str, Bench], foldmill: Run
) -> None:
    name, bench = half
    ledger = Ledger(ledger_file())
    number = next(k for k, one in enumerate(ledger.sheet(name).records) if one.doubtful)
    record = ledger.record(name, number)
    ledger.say(name, number, Said(Word.GO_ON, record.doubtful[0]))
    run = ledger.claim(name, number, "dev")
    told = foldmill("sheets", name, "--spoiled")
    assert told.code == 0
    words = " ".join(told.err.split())
    assert f"{record.program.name} was under way: whoever sends it stops the machine now" in words
    with pytest.raises(Spoiled):
        run.advance(record.doubtful[0] + 2, 0)
    ledger.close()
    bench.leave()


def test_sheets_are_in_the_database_that_jobs_are_in(
    half: tuple[str, Bench], foldmill: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name, bench = half
    assert name in foldmill("sheets").out
    monkeypatch.setenv("FOLDMILL_DATABASE", f"sqlite:///{tmp_path / 'other.sqlite'}")
    assert "No sheet is under work" in foldmill("sheets").out
    assert foldmill("sheets", name).code == 2
    ledger = JobStore(Places().ledger).ledger
    other = left_half_made(job_of(tmp_path / "other", small_plan(PENS)), bench, ledger, 1, 12)
    ledger.close()
    assert other.id in foldmill("sheets").out
    assert foldmill("sheets", other.id, "--spoiled").code == 0
    ledger = Ledger(ledger_place())
    assert ledger.sheet(other.id).is_given_up
    ledger.close()
    bench.leave()


@pytest.mark.parametrize(
    ("database", "why"),
    [
        ("postgresql+psycopg://ada:secret@127.0.0.1:1/none", "refused"),
        ("sqlite:////nowhere/at/all.sqlite", "unable to open"),
        ("nonsense", "cannot be opened"),
        ("oracle+nodriver://ada:secret@host/db", "cannot be opened"),
    ],
)
@pytest.mark.parametrize("words", [("sheets",), ("job", "list")])
def test_a_database_that_cannot_be_reached_is_told_of_without_its_password(
    words: tuple[str, ...],
    database: str,
    why: str,
    foldmill: Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.setenv("FOLDMILL_DATABASE", database)
    told = foldmill(*words)
    assert told.code == 2
    assert told.err.startswith(("foldmill: The ledger", "foldmill: The database"))
    assert why in " ".join(told.err.split())
    assert "secret" not in told.err
