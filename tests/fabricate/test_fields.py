"""Every field of a preset that is not kept for people alone is really read where work is done."""

from __future__ import annotations

import sys
from inspect import get_annotations
from pathlib import Path
from types import FrameType

import pytest
from fabricate.plan.test_make import square
from fabricate.test_handbook import fields, is_information
from pydantic import BaseModel

from foldmill.finding import has_errors
from foldmill_fabricate import folder, jobsheet, shelf
from foldmill_fabricate.coupon.make import make as coupon
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.formats import svg
from foldmill_fabricate.operators import SimulatedOperator
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import send
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.presets import Preset
from foldmill_fabricate.sending import open_job
from foldmill_fabricate.sheet import seen_by_machine
from foldmill_fabricate.verify import verify
from foldmill_fabricate.writers import writer

MODELS = ("materials", "machines", "presets", "handbook", "units", "shelf")
"""Rooms that describe presets: reading a field there is no use of it."""
JOBS: list[tuple[str, str, str | None, str | None]] = [
    ("pp-0.75", "generic-hpgl-600", None, None),
    ("pp-0.75", "generic-hpgl-drag-knife", "half-cut", "score-and-snap"),
    ("pp-0.75", "generic-hpgl-pens", "perforation", "through-cut"),
    ("pp-0.8", "flatbed-wheel-knife", "v-score", "through-cut"),
    ("card-250", "flatbed-wheel-knife", "crease-wheel", "through-cut"),
    ("paper-80-120", "generic-hpgl-600", "stylus", "through-cut"),
    ("paper-80-120", "hp-7475a", "pen", "pen"),
    ("pet-0.25", "grbl-laser", "perforation", "through-cut"),
    ("pp-0.5", "silhouette-like", None, None),
    ("paper-80-120", "grbl-drag-knife", "pen", "through-cut"),
]


REGISTERS = {("pp-0.5", "silhouette-like"): "l-marks", ("pp-0.8", "flatbed-wheel-knife"): "pins"}
"""Jobs that are not registered by holes."""
SHOWN = ("Sourced", "sources")
"""What `foldmill materials --show` and `machines --show` tell of every field."""


def declared(kind: type[BaseModel], name: str) -> tuple[str, str]:
    """Return a field under the model that describes it: what all processes have is one field."""
    owner = next(each for each in kind.__mro__ if name in get_annotations(each))
    return owner.__name__, name


def worker(frame: FrameType | None) -> str:
    """Return the module of ours that reads a field, past the models and past pydantic."""
    while frame is not None:
        name = str(frame.f_globals.get("__name__", ""))
        room = name.removeprefix("foldmill_fabricate.").split(".")[0]
        if name.startswith("foldmill_fabricate.") and room not in MODELS:
            return name
        if not name.startswith("foldmill_fabricate.") and name != __name__:
            return ""
        frame = frame.f_back
    return ""


@pytest.fixture(scope="module")
def read(tmp_path_factory: pytest.TempPathFactory) -> set[tuple[str, str]]:
    """Plan, write, verify and send small jobs; return each field that was read for it."""
    known: set[tuple[type[BaseModel], str]] = set()

    def look(self: Preset, name: str) -> object:
        kind = type(self)
        new = (kind, name) not in known and name in kind.__pydantic_fields__
        if new and worker(sys._getframe(1)):
            known.add((kind, name))
        return object.__getattribute__(self, name)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Preset, "__getattribute__", look, raising=False)
        for number, job in enumerate(JOBS):
            work(tmp_path_factory.mktemp(f"job-{number}"), *job)
    return {declared(kind, name) for kind, name in known}


def work(into: Path, material: str, machine: str, score: str | None, cut: str | None) -> None:
    """Plan a small job, write its drawings and programs, and prove it."""
    fold, used = square("MVMV", 90), shelf.machine(machine)
    whole = (material, machine) == ("pp-0.75", "generic-hpgl-600")
    options: dict[str, object] = {"score": score, "cut": cut}
    options["register"] = REGISTERS.get((material, machine), "holes")
    options["temperatures"] = (20.0, 22.0)
    if machine != "grbl-laser":  # there the material's own blank
        options |= {"blank": (200, 200), "relief": "all" if whole else "none"}
    plan = make(fold, shelf.material(material), used, **options)  # type: ignore[arg-type]
    assert svg.write(plan, fold)
    spoken = writer(used)
    assert spoken is not None
    assert not has_errors(verify(plan, fold.pattern, spoken.write(plan, fold)).findings)
    assert jobsheet.words.setup_rows(plan)
    if whole:
        assert coupon(shelf.material(material), used)
        seven = Simulator(shelf.machine("hp-7550a"))
        seven.write(b"IN;IN;\x1b.A")
        seven.rest()
        slow = used.serial.model_copy(update={"handshake": "paced", "answers": False})
        blind = used.model_copy(update={"serial": slow})
        with open_port("sim://paced?machine=generic-hpgl-600&answers=no", blind) as port:
            assert send(b"IN;PU40,40;PD80,80;PU;", port, blind).bytes
        told = shelf.machine("graphtec-summa-like")
        with open_port("sim://graphtec-summa-like", told) as port:
            assert send(b"IN;PU40,40;PD80,80;PU;", port, told).bytes
        folder.write(fold, plan, into, ["hpgl"])
        holes = [(hole.x, hole.y) for hole in plan.holes]
        marks = seen_by_machine(plan, Face.REVERSE, holes).tolist()
        url = f"sim://{machine}"
        assert list(send_job(open_job(into, marks), url, SimulatedOperator(url)))


def holds_words_only(kind: type[BaseModel], name: str, working: set[type[BaseModel]]) -> bool:
    """Tell whether a field is a part of a preset whose every field is kept for people."""
    part = kind.model_fields[name].annotation
    return isinstance(part, type) and issubclass(part, BaseModel) and part not in working


def test_every_field_is_read_where_work_is_done_or_is_named_as_information(
    read: set[tuple[str, str]],
) -> None:
    parts = {kind for kind, name in fields() if not is_information(kind, name)}
    wanted = {
        declared(kind, name)
        for kind, name in fields()
        if not is_information(kind, name) and not holds_words_only(kind, name, parts)
    } - {SHOWN}
    kept = {declared(kind, name) for kind, name in fields() if is_information(kind, name)}
    assert sorted(wanted - read) == []
    assert sorted(read & kept) == []
