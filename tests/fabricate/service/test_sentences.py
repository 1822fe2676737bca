"""What is wrong with a request is said in a sentence: which field, what it must be, what came."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from pydantic import BaseModel, ValidationError

from foldmill.refusals import explain, sentence_of
from foldmill_fabricate.foreign import Asked
from foldmill_fabricate.jobs import JobRecord, Order, Reply, Rest, Submission
from foldmill_fabricate.plan_options import PlanOptions
from foldmill_fabricate.service.answers import ServiceRefused, understood
from foldmill_fabricate.service.ids import SPELLED
from foldmill_fabricate.service.models import (
    DesignRequest,
    Nothing,
    PlanRequest,
    Priority,
    Upload,
)

REQUESTS: list[type[BaseModel]] = [
    Asked,
    DesignRequest,
    Nothing,
    Order,
    PlanOptions,
    PlanRequest,
    Priority,
    Reply,
    Rest,
    Submission,
    Upload,
]
JUNK: list[Any] = [
    None,
    "",
    "junk",
    "x" * 500,
    -1,
    0,
    1.5,
    10**9,
    10**30,
    1e300,
    float("nan"),
    float("inf"),
    True,
    [],
    ["x" * 500],
    [0, 0, 0],
    [[1]],
    ["junk"] * 200,
    {},
    {"junk": 1},
    {"junk": {"junk": []}},
    "\ud800",
]
"""Values that hardly any field takes."""
MACHINE_TALK = re.compile(
    r"Input|should|String|Tuple|List|Value error|Field|match|instance|validation|required|"
    r"valid (string|integer|number|dict|list|bool)|\^|\$"
)
SENTENCE = re.compile(
    r"There is no [\w.]+ to set\.|[\w.]+: (?P<words>.+) \(got .+\)\.|"
    r"[\w.]+ (is missing: give it a value|must (not )?be (?P<what>.+?)|must have (?P<size>.+?))"
    r"(, not (?P<came>.+))?\.",
    re.DOTALL,
)


def faulty(model: type[BaseModel]) -> Iterator[tuple[str, Any, ValidationError]]:
    """Yield every refusal of a field that is given junk, beside others that are left out."""
    for name in [*model.model_fields, "junk"]:
        for value in JUNK:
            try:
                model.model_validate({name: value})
            except ValidationError as error:
                yield name, value, error


@pytest.mark.parametrize("model", REQUESTS, ids=lambda model: str(model.__name__))
def test_every_field_refuses_in_a_sentence_that_names_it(model: type[BaseModel]) -> None:
    seen = set()
    for name, _, error in faulty(model):
        for fault in error.errors():
            said = sentence_of(fault, SPELLED)
            parts = SENTENCE.fullmatch(said)
            assert parts, said
            assert not MACHINE_TALK.search(f"{parts['what']} {parts['size']} {parts['words']}"), (
                said
            )
            assert len(said) < 400
            if str(fault["loc"][0]) == name:
                assert name in said.split(" must", 1)[0].split(" to set", 1)[0]
                seen.add(name)
        assert explain(error, model)
    anything = {"params", "ok", "touched"}  # they take whatever there is, or nearly
    assert seen >= {*model.model_fields} - anything


@pytest.mark.parametrize(
    ("model", "given", "sentence"),
    [
        (
            Reply,
            {"verdict": "maybe"},
            "verdict must be empty, 'good', 'again' or 'stop', not 'maybe'.",
        ),
        (
            Reply,
            {"word": "perhaps"},
            "word must be empty, 'go on', 'finished' or 'spoiled', not 'perhaps'.",
        ),
        (Reply, {"overlap": 21}, "overlap must be at most 20, not 21."),
        (Rest, {"sheet": "K7QFK7QFK"}, "sheet must have at most 8 characters, not 9."),
        (Rest, {"doubtful": ["1"] * 101}, "doubtful must have at most 100 entries, not 101."),
        (Submission, {"plotter": "x", "copies": 0}, "copies must be at least 1, not 0."),
        (
            Submission,
            {"plotter": "x", "design": {"family": "f", "options": {"relief": "much"}}},
            "design.options.relief must be 'none', 'needed' or 'all', not 'much'.",
        ),
        (PlanOptions, {"blank": [500]}, "blank.1 is missing: give it a value."),
        (PlanOptions, {"blank": [500, 1, 2]}, "blank must have at most 2 entries, not 3."),
    ],
)
def test_a_value_that_cannot_be_is_told_with_what_could(
    model: type[BaseModel], given: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(ValidationError) as refused:
        model.model_validate(given)
    assert explain(refused.value) == sentence


@pytest.mark.parametrize(
    ("method", "path", "body", "sentence"),
    [
        ("GET", "patterns/junk", None, "pattern must be an id of 64 digits, 0-9 and a-f, not"),
        ("GET", "jobs/a-b", None, "job must be the id of a job, such as K3PX7Q, not 'a-b'."),
        ("GET", "questions?job=a-b", None, "job must be the id of a job, such as K3PX7Q, or empty"),
        ("POST", "questions/QX/answer", {}, "question must be the id of a question, digits 0-9"),
        ("GET", "jobs/ABC/sheets/a-b/front.svg", None, "sheet must be the id that is written on"),
        ("GET", "jobs/ABC/sheets/ABCD/side.svg", None, "face must be 'front' or 'reverse', not"),
        ("GET", "jobs?state=idle", None, "state.0 must be 'planning', 'submitted', 'running'"),
        ("GET", "events?after=-1&seconds=0", None, "after must be at least 0, not '-1'."),
        ("POST", "jobs?who=" + "x" * 61, {"plotter": "b"}, "who must have at most 60 characters"),
        ("POST", "patterns?form=pdf", {}, "form must be 'fold', 'svg', 'dxf', 'cp' or 'opx', not"),
        ("POST", "patterns?width=0", {}, "width must be more than 0, not '0'."),
        ("POST", "designs", [1], "The body must be a table of names and values, not [1]."),
        ("POST", "plans", {"pattern": "x"}, "pattern must be an id of 64 digits, 0-9 and a-f, n"),
        ("POST", "jobs/ABC/priority", {"priority": "high"}, "priority must be a whole number, not"),
        ("POST", "jobs/ABC/pause", {"x": 1}, "There is no x to set."),
    ],
)
def test_whatever_is_sent_amiss_is_answered_in_sentences(
    service: httpx.Client, method: str, path: str, body: Any, sentence: str
) -> None:
    answer = service.request(method, f"/api/v1/{path}", json=body)
    assert (answer.status_code, answer.json()["type"]) == (422, "urn:foldmill:invalid-request")
    assert answer.json()["detail"].startswith(sentence)


def test_a_body_that_is_not_there_is_missed(service: httpx.Client) -> None:
    headers = {"content-type": "application/json"}
    answer = service.post("/api/v1/designs", headers=headers)
    assert answer.json()["detail"] == "The body is missing: send a JSON object."


def test_an_answer_of_another_version_is_told_as_that() -> None:
    with pytest.raises(ServiceRefused, match=r"There is no colour to set.* of the same version"):
        understood(JobRecord, b'{"id": "ABC", "colour": "red"}', "http://here")
