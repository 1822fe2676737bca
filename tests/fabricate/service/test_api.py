"""From a design to files over HTTP: the same values and sentences as at the terminal."""

from __future__ import annotations

import hashlib
import json
import time
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from services import running, square

from foldmill import Assignment, installed
from foldmill.exchange import fold as fold_file
from foldmill.exchange.options import Options
from foldmill_fabricate import shelf
from foldmill_fabricate.client import Client
from foldmill_fabricate.importing import read_pattern
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.service.models import Upload
from foldmill_fabricate.service.problems import status_of
from foldmill_fabricate.service.sandbox import TooBusy
from foldmill_fabricate.verify import verify_folder

STAR = {"family": "rotational", "preset": "star-n6"}
SHEET = {"material": "pp-0.75", "machine": "generic-hpgl-600"}


def planned(service: httpx.Client, request: dict[str, Any]) -> dict[str, Any]:
    answer = service.post("/api/v1/plans", json=request)
    assert answer.status_code in {200, 202}, answer.text
    while answer.json()["state"] == "waiting":
        time.sleep(0.05)
        answer = service.get(answer.headers.get("location") or str(answer.url))
    found: dict[str, Any] = answer.json()
    return found


def test_every_family_is_offered_with_its_schema_and_presets(service: httpx.Client) -> None:
    rows = service.get("/api/v1/families").json()
    assert [row["slug"] for row in rows] == sorted(installed().designs)
    for row in rows:
        told = service.get(f"/api/v1/families/{row['slug']}").json()
        design = installed().design(row["slug"])
        assert told["parameters"] == json.loads(json.dumps(design.schema()))
        for name, values in told["values"].items():
            preset = design.preset(name) if name else design.params()
            assert design.validate(values) == preset


def test_every_material_and_machine_is_told_with_units_and_can_be_read_back(
    service: httpx.Client,
) -> None:
    for kind, model in (("materials", Material), ("machines", Machine)):
        rows = service.get(f"/api/v1/{kind}").json()
        assert [row["slug"] for row in rows] == [*shelf.everything(model).presets]  # type: ignore[type-var]
        told = service.get(f"/api/v1/{kind}/{rows[0]['slug']}").json()
        assert model.model_validate(told["preset"]).slug == rows[0]["slug"]
        assert {"mm"} < {field["unit"] for field in told["fields"]}


def test_a_design_is_the_one_that_the_family_makes(service: httpx.Client) -> None:
    answer = service.post("/api/v1/designs", json=STAR)
    assert answer.status_code == 201
    design = installed().design("rotational")
    expected = fold_file.write(design.run(design.preset("star-n6"))).encode()
    content = service.get(f"{answer.headers['location']}/pattern.fold").content
    assert content == expected
    assert answer.json()["id"] == hashlib.sha256(expected).hexdigest()


def test_parameters_out_of_bounds_are_refused_with_the_sentence_of_the_terminal(
    service: httpx.Client,
) -> None:
    answer = service.post("/api/v1/designs", json={"family": "tuck", "params": {"n": -1}})
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    told = answer.json()
    assert told["detail"] == "n must be at least 3, not -1."
    assert (told["type"], told["status"]) == ("urn:foldmill:invalid-parameters", 422)


@pytest.mark.parametrize(
    ("path", "body", "sentence"),
    [
        ("designs", {"family": "umbrella"}, "There is no family 'umbrella'. There are: rota"),
        ("designs", {"familiy": "tuck"}, "family is missing: give it a value."),
        ("plans", SHEET, "Name a pattern by its id, or a design"),
        ("plans", {"design": STAR, **SHEET, "material": "steel"}, "There is no material 'steel'."),
        ("plans", {"design": STAR, **SHEET, "formats": ["bmp"]}, "There is no format 'bmp'."),
        ("plans", {"design": STAR, **SHEET, "options": {"copies": 0}}, "options.copies must be at"),
        ("plans", {"design": STAR, **SHEET, "profile": "/etc/passwd"}, "There is no profile"),
    ],
)
def test_a_request_that_means_nothing_is_refused_with_what_would(
    service: httpx.Client, path: str, body: dict[str, Any], sentence: str
) -> None:
    answer = service.post(f"/api/v1/{path}", json=body)
    assert answer.status_code == 422
    assert answer.json()["detail"].startswith(sentence)


@pytest.mark.parametrize("content", [b"{", b"\xff\xfe", b"[1, 2", b'{"family": NaN}'])
def test_a_body_that_is_no_json_is_refused(service: httpx.Client, content: bytes) -> None:
    headers = {"content-type": "application/json"}
    answer = service.post("/api/v1/designs", content=content, headers=headers)
    assert answer.status_code in {400, 422}
    assert answer.headers["content-type"] == "application/problem+json"


def test_an_uploaded_pattern_is_kept_under_its_own_digest(service: httpx.Client) -> None:
    answers = [
        service.post("/api/v1/patterns", json=square()),
        service.post(
            "/api/v1/patterns",
            content=json.dumps(square()).encode(),
            headers={"content-type": "application/octet-stream", "x-foldmill": "1"},
        ),
    ]
    assert [answer.status_code for answer in answers] == [201, 201]
    assert len({answer.json()["id"] for answer in answers}) == 1
    told = answers[0].json()
    assert told["creases"] == {"B": 4, "M": 1, "V": 0, "F": 0, "U": 0, "C": 0}
    assert (told["width"], told["height"]) == (100, 100)
    assert told in service.get("/api/v1/patterns").json()
    assert service.get(answers[0].headers["location"]).json() == told


def test_lines_that_cross_are_mended_when_asked_and_else_refused(service: httpx.Client) -> None:
    crossed = square()
    crossed["edges_vertices"].append([1, 3])
    crossed["edges_assignment"].append("V")
    assert service.post("/api/v1/patterns", json=crossed).status_code == 422
    answer = service.post("/api/v1/patterns?planarise=true", json=crossed)
    assert answer.status_code == 201
    assert (answer.json()["vertices"], answer.json()["creases"]["V"]) == (5, 2)


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("ff_pinwheel.opx", {}),
        ("os_simpleVertex.svg", {"width": 120}),
        ("os_waterbomb.svg", {"width": 200, "side": "back"}),
    ],
)
def test_a_drawing_of_another_program_is_read_as_at_the_terminal(
    service: httpx.Client, name: str, asked: dict[str, Any]
) -> None:
    file = Path(__file__).parents[2] / "samples" / name
    form = file.suffix.removeprefix(".")
    said = Upload.model_validate({"form": form, "width": 100, **asked})
    with Client(str(service.base_url)) as client:
        told = client.upload(file.read_bytes(), said)
        fold = client.fold(told.id).decode()
    here = read_pattern(file, Options(width=said.width, side=said.side))
    assert np.allclose(fold_file.read(fold).pattern.vertices, here.fold.pattern.vertices)
    assert told.creases == {each.name: here.fold.pattern.count(each) for each in Assignment}


def test_a_drawing_of_unknown_size_is_asked_about(service: httpx.Client) -> None:
    file = Path(__file__).parents[2] / "samples" / "ff_pinwheel.opx"
    headers = {"content-type": "application/octet-stream", "x-foldmill": "1"}
    path = "/api/v1/patterns"
    answers = [
        service.post(path, content=file.read_bytes(), headers=headers, params={"form": form})
        for form in ("opx", "svg", "cp")
    ]
    assert [answer.status_code for answer in answers] == [422, 422, 422]
    assert "--width" in answers[0].json()["detail"]


def test_drawings_are_made_of_what_is_there(service: httpx.Client) -> None:
    star = service.post("/api/v1/designs", json=STAR).headers["location"]
    magic = {"pattern.svg": b"<?xml", "pattern.png": b"\x89PNG", "folded.glb": b"glTF"}
    for name, begin in magic.items():
        answer = service.get(f"{star}/drawings/{name}")
        assert answer.status_code == 200
        assert answer.content.startswith(begin)
    flat = service.post("/api/v1/patterns", json=square()).headers["location"]
    answer = service.get(f"{flat}/drawings/folded.glb")
    assert answer.status_code == 422
    assert "folded form" in answer.json()["detail"]


def test_a_check_finds_what_the_terminal_finds(service: httpx.Client) -> None:
    from foldmill.check import check

    star = service.post("/api/v1/designs", json=STAR).headers["location"]
    told = service.get(f"{star}/check").json()
    design = installed().design("rotational")
    again = fold_file.read(fold_file.write(design.run(design.preset("star-n6"))))
    assert told["figures"] == json.loads(json.dumps(dict(check(again).figures)))


def test_a_plan_is_the_one_the_planner_makes_and_is_made_once(service: httpx.Client) -> None:
    request = {"pattern": service.post("/api/v1/patterns", json=square()).json()["id"], **SHEET}
    told = planned(service, request)
    assert told["state"] == "done", told["detail"]
    fold = fold_file.read(json.dumps(square()))
    expected = make(fold, shelf.material("pp-0.75"), shelf.machine("generic-hpgl-600"))
    plan = service.get(f"/api/v1/plans/{told['id']}/files/plan.json")
    found = Plan.model_validate_json(plan.content)
    assert found.passes == expected.passes
    assert told["figures"]["strokes"] == expected.figures.strokes
    again = service.post("/api/v1/plans", json=request)
    assert (again.status_code, again.json()) == (200, told)
    assert told in service.get("/api/v1/plans").json()


def test_the_files_of_a_plan_are_a_job_folder_that_verifies(
    service: httpx.Client, tmp_path: Path
) -> None:
    design = {"family": "rotational", "preset": "star-n6"}
    told = planned(service, {"design": design, **SHEET})
    assert told["state"] == "done", told["detail"]
    for row in told["files"]:
        content = service.get(f"/api/v1/plans/{told['id']}/files/{row['name']}").content
        assert len(content) == row["bytes"]
        assert row["sha256"] in {"", hashlib.sha256(content).hexdigest()}
        (tmp_path / row["name"]).write_bytes(content)
    assert verify_folder(tmp_path).ok
    verified = service.get(f"/api/v1/plans/{told['id']}/verification").json()
    assert verified["ok"]
    assert verified["figures"]["strokes"] == told["figures"]["strokes"]


def test_a_part_of_a_file_is_given_and_an_unchanged_file_not_again(service: httpx.Client) -> None:
    told = planned(service, {"design": STAR, **SHEET})
    path = f"/api/v1/plans/{told['id']}/files/plan.json"
    whole = service.get(path)
    part = service.get(path, headers={"range": "bytes=10-19"})
    assert (part.status_code, part.content) == (206, whole.content[10:20])
    beyond = service.get(path, headers={"range": f"bytes={len(whole.content)}-"})
    assert beyond.status_code == 416
    assert whole.headers["etag"]


def test_what_cannot_be_planned_says_why_and_may_be_asked_again(service: httpx.Client) -> None:
    large = service.post("/api/v1/patterns", json=square(side=900)).json()["id"]
    for _ in range(2):
        told = planned(service, {"pattern": large, **SHEET})
        assert told["state"] == "refused"
        assert "500 × 500" in told["detail"] or "blank" in told["detail"]
    answer = service.get(f"/api/v1/plans/{told['id']}/files/plan.json")
    assert answer.status_code == 404
    assert told["detail"] in answer.json()["detail"]


def test_what_is_kept_outlives_the_service(tmp_path: Path) -> None:
    with running(tmp_path) as first:
        made = first.post("/api/v1/patterns", json=square()).json()
        told = planned(first, {"pattern": made["id"], **SHEET})
        url = first.post("/api/v1/plans", json={"design": STAR, **SHEET}).json()["id"]
    with running(tmp_path) as second:
        assert second.get(f"/api/v1/patterns/{made['id']}").json() == made
        assert second.get(f"/api/v1/plans/{told['id']}").json() == told
        cut_short = second.get(f"/api/v1/plans/{url}").json()
        assert cut_short["state"] == "interrupted"
        assert "send the request again" in cut_short["detail"]
    assert not [*(tmp_path / "service/scratch").iterdir()]


def test_what_is_not_there_is_told_so(service: httpx.Client) -> None:
    for path in ("patterns", "plans"):
        answer = service.get(f"/api/v1/{path}/{'0' * 64}")
        assert answer.status_code == 404
        assert answer.json()["detail"].startswith("There is no p")
    assert service.get("/api/v2").status_code == 404
    wrong = service.request("DELETE", "/api/v1/families", json={})
    assert wrong.status_code == 405
    assert wrong.headers["allow"] == "GET"


def test_the_service_tells_how_it_is(service: httpx.Client) -> None:
    assert service.get("/healthz").json() == {"ok": True, "computing": 0, "waiting": 0}
    service.get("/api/v1/families/umbrella")
    figures = service.get("/metrics").text
    line = 'foldmill_requests_total{method="GET",route="/api/v1/families/{slug}",status="404"}'
    assert line in figures
    assert 'foldmill_computing{state="waiting"} 0.0' in figures
    assert "umbrella" not in figures


def test_too_much_at_once_is_answered_with_503() -> None:
    assert status_of(TooBusy("Try again.")) == 503
