"""HP-GL from elsewhere becomes a job over HTTP, and no byte of it reaches a port."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import httpx
import pytest
from command import Run
from fabricate.bench import Bench
from services import running, said

from foldmill.errors import UnknownName, UnreadableFile
from foldmill_fabricate import shelf
from foldmill_fabricate.client import Client
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.foreign import Asked, Use, limits, plan_drawing, read
from foldmill_fabricate.jobs import Places
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plotter.ledger import State
from foldmill_fabricate.sending import open_job
from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens
from foldmill_fabricate.verify import verify_folder

LAMP = (
    b"in;sp1 PU-400,0;PD4000,0 , +4000. 3999.96;PD-400,4000,-400,0;PU;SP2;VS20;PU0,2000;"
    b"pd4000,2000;PU;SP3;PU1000,3000;CI400;SP0;"
)
"""In spellings that our own writer does not use."""
PENS = ("1=cut", "2=score", "3=inner")
MACHINE = "generic-hpgl-600"
ASKED = Asked(name="lamp.plt", pen=PENS, material="pp-0.75", machine=MACHINE, blank=(200, 180))
PATH = "/api/v1/plans/drawn"
HEADERS = {"content-type": "application/octet-stream", "x-foldmill": "1"}
WORDS = {"pen": [*PENS], "material": "pp-0.75", "machine": MACHINE}


class House(NamedTuple):
    """A service, and where it keeps plans."""

    http: httpx.Client
    client: Client
    kept: Plans


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[House]:
    folder = tmp_path_factory.mktemp("house")
    with running(folder) as http, Client(str(http.base_url)) as client:
        yield House(http, client, Plans(Places(folder, "").plans))


@pytest.fixture
def foldmill(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    return Run(capsys, monkeypatch)


def planned_here() -> Plan:
    uses = {1: Use.CUT, 2: Use.SCORE, 3: Use.INNER}
    of, on = shelf.material("pp-0.75"), shelf.machine(MACHINE)
    return plan_drawing(read(LAMP, "lamp.plt"), uses, of, on, blank=(200.0, 180.0))


def test_its_plan_is_the_one_that_the_terminal_makes_proved_and_kept_by_its_digest(
    house: House,
) -> None:
    told = house.client.plan_drawing(LAMP, ASKED)
    assert house.client.keep_drawing(LAMP, ASKED) == told.plan
    plan, folder = house.kept.plan(told.plan), house.kept.folder(told.plan)
    assert plan.digest == told.plan
    assert plan.passes == planned_here().passes
    assert (told.title, told.material, told.machine) == ("lamp", "pp-0.75", MACHINE)
    assert told.figures.strokes == plan.figures.strokes
    assert {finding.code for finding in told.findings} >= {"no-pattern", "not-followed"}
    assert verify_folder(folder).ok
    assert house.client.keep(folder) == told.plan, "its folder is kept like any other"


def test_what_a_machine_gets_is_our_writers_and_not_the_files(house: House, tmp_path: Path) -> None:
    job = open_job(house.kept.folder(house.client.keep_drawing(LAMP, ASKED)))
    bench = Bench(job.plan)
    assert {one.state for one in send_job(job, bench.url, bench.hands)} == {State.DONE}
    wire = bytes(bench.simulator.device.traffic.program)
    ours = b"".join((job.path / part.name).read_bytes() for part in job.plan.programs)
    assert spoken(wire) == spoken(ours)
    for odd in (b"in;", b"pd", b" ", b"CI", b"VS20", b"3999.96", b"+"):
        assert odd in LAMP
        assert odd not in wire
    bench.leave()


def spoken(data: bytes) -> list[bytes]:
    """Return the instructions of HP-GL, without what a session asks the machine in between."""
    return [each for each in re.sub(rb"\x1b\.[A-Z@(]|O[A-Z];|\s", b"", data).split(b";") if each]


@pytest.mark.parametrize(
    ("data", "new", "kind", "sentence"),
    [
        (b"IN;SP1;PU0,0;PD9,9;OA;", {}, UnreadableFile, r"byte 19: OA asks the machine something"),
        (b"\x1b.(IN;SP1;PD9,9;", {}, UnreadableFile, "byte 0: there is an escape sequence"),
        (b"", {}, UnreadableFile, "lamp.plt draws nothing"),
        (LAMP, {"pen": PENS[:1]}, CannotPlan, "what is to be made of these: pen 2 draws 1 line"),
        (LAMP, {"pen": (*PENS, "7=cut")}, CannotPlan, "lamp.plt has no pen 7"),
        (LAMP, {"pen": (*PENS, "1=skip")}, Exception, "says two things of one pen"),
        (LAMP, {"blank": (90, 90)}, DoesNotFit, "mm are missing"),
        (LAMP, {"machine": "lathe"}, UnknownName, "There is no machine 'lathe'"),
        (LAMP, {"score": "pen"}, Exception, "pen"),
    ],
)
def test_what_cannot_be_made_is_refused_with_the_sentence_of_the_terminal(
    house: House, data: bytes, new: dict[str, Any], kind: type[Exception], sentence: str
) -> None:
    with pytest.raises(kind, match=sentence) as refused:
        house.client.plan_drawing(data, ASKED.model_copy(update=new))
    assert str(refused.value).endswith((".", "?"))


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ({"pen": "1=burn"}, "pen.0: write PEN=USE, such as 1=cut"),
        ({"pen": ["1=cut"] * 101}, "pen"),
        ({"name": "../../tokens.json"}, "name: a drawing's name has no slashes"),
        ({"name": "lamp\n"}, "name: a drawing's name"),
        ({"name": ""}, "name"),
        ({"blank": [200, "NaN"]}, "blank.1 must be"),
        ({"blank": "200"}, "blank"),
        ({"title": "lamp"}, "There is no title to set."),
        ({"material": None}, "material is missing"),
    ],
)
def test_words_that_mean_nothing_are_refused_before_the_file_is_looked_at(
    house: House, words: dict[str, Any], sentence: str
) -> None:
    asked = {name: value for name, value in {**WORDS, **words}.items() if value is not None}
    answer = house.http.post(PATH, content=LAMP, params=asked, headers=HEADERS)
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["detail"].startswith(sentence)


def test_a_drawing_that_is_too_large_is_refused_by_its_stated_size(house: House) -> None:
    head = (
        f"POST {PATH}?pen=1%3Dcut&material=pp-0.75&machine={MACHINE} HTTP/1.1\r\n"
        f"Host: {house.http.base_url.netloc.decode()}\r\nX-Foldmill: 1\r\n"
        f"Content-Type: application/octet-stream\r\nContent-Length: {limits.BYTES + 1}\r\n\r\n"
    )
    status, answer = said(house.http, head.encode())
    assert status == 413
    assert b"8000001 bytes; at most 8,000,000 are read here" in answer


def test_who_may_only_look_hands_nothing_over(tmp_path: Path) -> None:
    secret = Tokens(tmp_path).new("anna", Scope.VIEW)
    with running(tmp_path, policy(tmp_path, "127.0.0.1", (), demand=True)) as service:
        for key, status in ((secret, 403), ("wrong", 401)):
            headers = {**HEADERS, "authorization": f"Bearer {key}"}
            answer = service.post(PATH, content=LAMP, params=WORDS, headers=headers)
            assert answer.status_code == status
    assert not (tmp_path / "plans").exists()


def test_the_terminal_submits_a_drawing_through_the_service_and_without_one(
    foldmill: Run, house: House, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    file = tmp_path / "lamp.plt"
    file.write_bytes(LAMP)
    pens = [word for pen in PENS for word in ("--pen", pen)]
    words = ("job", "submit", str(file), "--on", "bench", *pens, "--option", "blank=200x180")
    queued = foldmill(*words, "--plotter", f"bench=sim://{MACHINE}", "--json")
    monkeypatch.setenv("FOLDMILL_SERVICE", house.client.url)
    served = foldmill(*words, "--json")
    assert (queued.code, served.code) == (0, 0), queued.err + served.err
    assert json.loads(queued.out)["plan"] == json.loads(served.out)["plan"]
    assert json.loads(served.out)["title"] == "lamp"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("lamp.plt",), "Nobody has said what is to be made of these: pen 1 draws 1 line"),
        (("lamp.plt", "--preset", "stool-n8"), "--preset and --param are of a design"),
        (("lamp.plt", "--pen", "1=cut", "--option", "relief=all"), "--option relief is not for an"),
        (("lamp.plt", "--pen", "1=burn"), "write PEN=USE, such as 1=cut"),
        (("lamp.plt", "--pen", "1=cut", "--option", "blank=-1x2"), "blank: both sides must be"),
        (("lamp.plt", "--option", "score=burning"), "score must be"),
        (("gone.plt", "--pen", "1=cut"), "gone.plt: No such file"),
        (("tuck", "--pen", "1=cut"), "--pen is about the pens of an HP-GL drawing"),
    ],
)
def test_a_drawing_that_is_submitted_wrongly_is_told_so_in_one_line(
    foldmill: Run,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    words: tuple[str, ...],
    sentence: str,
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    Path("lamp.plt").write_bytes(LAMP)
    what, *rest = words
    bench = ("--on", "bench", "--plotter", f"bench=sim://{MACHINE}")
    told = foldmill("job", "submit", what, *bench, *rest)
    assert told.code == 2
    assert sentence in told.err
    assert "Traceback" not in told.err
