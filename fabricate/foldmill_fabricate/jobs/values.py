"""What is told of jobs: values that a terminal, the HTTP API and its client share."""

from __future__ import annotations

from enum import StrEnum
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from foldmill_fabricate.jobs.states import ENDED, JobState
from foldmill_fabricate.plan_options import PlanOptions

MOST_URGENT = 1000
"""The highest priority; the lowest is its negative."""


class _Value(BaseModel):
    model_config = ConfigDict(
        frozen=True, extra="forbid", use_attribute_docstrings=True, allow_inf_nan=False
    )


def _example(*bodies: dict[str, Any]) -> ConfigDict:
    """Return the configuration of a value that the description of the API shows so."""
    return ConfigDict(json_schema_extra={"examples": [*bodies]})


class Order(_Value):
    """A design to be planned: what `design` and `plan` are given on the command line."""

    family: str = Field(max_length=100)
    """slug of a family of designs"""
    preset: str = Field(default="", max_length=100)
    """whose parameters the others are laid over; empty for the family's own defaults"""
    params: dict[str, Any] = Field(default_factory=dict)
    """of the family, by name; lengths in mm, angles in degrees"""
    material: str = Field(default="pp-0.75", max_length=100)
    """slug of the sheet's material"""
    machine: str = Field(default="generic-hpgl-600", max_length=100)
    """slug of the machine it is planned for: the plotter's"""
    options: PlanOptions = PlanOptions()
    """of planning, by the names of `foldmill plan`"""


class Submission(_Value):
    """What is asked for: a plan that is kept, or a design to be planned; on which plotter."""

    model_config = _example(
        {"design": {"family": "rotational", "preset": "star-n6"}, "plotter": "bench", "copies": 2},
        {"plan": "5f" * 32, "plotter": "bench", "key": "order 1172, lamp 3"},
    )

    plan: str = Field(default="", max_length=64)
    """id of a plan that is kept; empty where a design is ordered"""
    design: Order | None = None
    """what is designed and planned first; none where a plan is named"""
    plotter: str = Field(max_length=100)
    """its name, as `plotters` lists it"""
    copies: int = Field(default=1, ge=1, le=1000)
    """how many sheets of it"""
    priority: int = Field(default=0, ge=-MOST_URGENT, le=MOST_URGENT)
    """jobs of higher priority are made first, those of the same one in the order they came"""
    key: str = Field(default="", max_length=200)
    """idempotency key: the same one again gives the job that is there"""
    remakes: str = Field(default="", max_length=8)
    """id of a sheet whose missing strokes the plan holds; empty for a sheet of its own"""


class JobRecord(_Value):
    """A job, as it stands."""

    id: str
    title: str
    plotter: str
    material: str
    machine: str
    plan: str
    """id of its plan; empty while that is made"""
    copies: int
    priority: int
    state: JobState
    note: str
    """why it stands so, a sentence; empty for nothing to tell"""
    wish: str
    """what a person wants of it and is not done yet: pause, cancel; empty for nothing"""
    begun: bool
    """whether it has had its plotter"""
    sheets: tuple[str, ...]
    """ids of the sheets it has begun, in order"""
    who: str
    submitted: str
    """UTC, ISO 8601"""
    ended: str
    """UTC, ISO 8601; empty while it has not ended"""
    remakes: str = ""

    @property
    def is_ended(self) -> bool:
        """Whether nothing more will happen to it."""
        return self.state in ENDED


class Rest(_Value):
    """What a person says of the strokes in doubt on a sheet, of which the rest is to be made."""

    model_config = _example({"doubtful": ["cut"]}, {"sheet": "K7QF", "doubtful": ["1:3,5-8"]})

    sheet: str = Field(default="", max_length=8)
    """id of the sheet; empty for the last one of the job"""
    doubtful: tuple[str, ...] = Field(default=(), max_length=100)
    """cut, missing, or the missing strokes, as 3,5-8; PROGRAM: before it for one of many"""
    half: tuple[str, ...] = Field(default=(), max_length=100)
    """strokes that are cut in part, likewise"""
    priority: int = Field(default=0, ge=-1000, le=1000)
    """of the job that makes the rest"""


class Kind(StrEnum):
    """What a person is asked for."""

    LOAD = "load"
    TOOL = "tool"
    FLIP = "flip"
    RE_REGISTER = "re-register"
    REMOVE = "remove"
    TRY = "try"
    """whether an untested preset is tried in the waste first"""
    JUDGE = "judge"
    """what a test cut looks like"""
    DECIDE = "decide"
    """how a program goes on that ended before its end"""
    FINISHED = "finished"
    """whether a machine that cannot say so has cut all of a program"""
    TROUBLE = "trouble"
    """something is in the way: to be tried again once it is not"""
    ANOTHER = "another"
    """a sheet was given up: whether another one is made in its place"""


class Reply(_Value):
    """What a person answers; which parts count depends on the question."""

    model_config = _example(
        {"thickness": 0.76, "temperature": 21.5}, {"word": "go on", "stroke": 12}, {"ok": False}
    )

    ok: bool = True
    """done, yes, good, go on, again; False: no, stop the job"""
    sheet: str = Field(default="", max_length=8)
    """the id that is written on the sheet"""
    thickness: float | None = None
    """mm"""
    temperature: float | None = None
    """°C of the sheet"""
    exposure: float | None = None
    """mm, where another was set than the plan's"""
    touched: bool = False
    """whether the sheet was moved, or taken off"""
    marks: tuple[tuple[float, float], ...] = Field(default=(), max_length=100)
    """where registration marks are seen now, carrier coordinates in mm"""
    verdict: Literal["", "good", "again", "stop"] = ""
    """of a test cut"""
    word: Literal["", "go on", "finished", "spoiled"] = ""
    """of a program in doubt"""
    stroke: int = Field(default=0, ge=0)
    """with go on: the first that is cut next, 1, 2, 3 …; 0: where the machine proves to stand"""
    vertex: int = Field(default=0, ge=0)
    """with stroke: the corner of it that is gone on from, 0 for its beginning"""
    overlap: float = Field(default=0.0, ge=0.0, le=20.0)
    """mm that a through-cut is cut again"""


class Question(_Value):
    """What a person is asked at a machine. Its id is good for one answer."""

    id: str
    job: str
    sheet: str
    program: int | None
    """0, 1, 2 … in order of work; None for the whole sheet"""
    kind: Kind
    setup: str
    """name of the set-up that comes next; empty for none"""
    face: str
    """the face that is up afterwards"""
    text: str
    """what to do, in words"""
    data: dict[str, Any]
    """figures that the answer is judged by"""
    asked: str
    """UTC, ISO 8601"""


class Event(_Value):
    """Something that happened to a job."""

    number: int
    """1, 2, 3 … over all jobs: what was heard last, to hear the rest"""
    when: str
    job: str
    who: str
    what: str
    state: JobState
    """where the job stood afterwards"""


class Happening(_Value):
    """A line of a job's history: of the job itself, or of one of its sheets."""

    when: str
    who: str
    what: str
    sheet: str = ""
