"""Docs, models and presets say the same, and every field is used or said to be information."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import stools
from pydantic import BaseModel

import foldmill_fabricate
from foldmill.schema import models
from foldmill_fabricate import handbook
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.presets import Sourced, unit_of

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "materials-and-machines.md").read_text(encoding="utf-8")
CODE = Path(foldmill_fabricate.__file__).parent


def fields() -> list[tuple[type[BaseModel], str]]:
    every = {model for kind in (Material, Machine) for model in models(kind)}
    return sorted(
        ((model, name) for model in every for name in model.model_fields),
        key=lambda pair: (pair[0].__name__, pair[1]),
    )


def is_information(model: type[BaseModel], name: str) -> bool:
    extra = model.model_fields[name].json_schema_extra
    return isinstance(extra, dict) and "x-information" in extra


@pytest.fixture(scope="module")
def code() -> str:
    """Everything that computes: neither the models nor what lists their fields."""
    own = ("materials", "machines", "presets.py", "handbook.py")
    return "\n".join(
        path.read_text(encoding="utf-8")
        for path in sorted(CODE.rglob("*.py"))
        if path.relative_to(CODE).parts[0] not in own
    )


def test_every_field_is_used_by_the_code_or_named_as_information(code: str) -> None:
    models_text = "\n".join(
        path.read_text(encoding="utf-8")
        for folder in ("materials", "machines")
        for path in (CODE / folder).glob("*.py")
    )
    for model, name in fields():
        used = re.search(rf"\.{name}\b", code) or re.search(rf"self\.{name}\b", models_text)
        assert bool(used) != is_information(model, name), f"{model.__name__}.{name}"


def test_every_field_stands_on_the_page_with_its_meaning() -> None:
    assert handbook.fields() in PAGE
    for _, name in fields():
        assert f"| `{name}` |" in PAGE


PLAIN = {"kind", "slug", "title", "baud", "notes"}
"""Names that need no words."""


def test_every_field_has_a_unit_or_says_what_it_is() -> None:
    for model, name in fields():
        field = model.model_fields[name]
        part = isinstance(field.annotation, type) and issubclass(field.annotation, BaseModel)
        assert field.description or unit_of(field) or part or name in PLAIN, (model, name)


def test_the_table_has_every_machine_with_every_material_once() -> None:
    rows = [line.split(" | ")[:2] for line in PAGE.splitlines() if line.startswith("| ")]
    pairs = [(machine.slug, m.slug) for machine in handbook.shipped_machines() for m in MATERIALS]
    found = [(a.removeprefix("| "), b) for a, b in rows if (a.removeprefix("| "), b) in pairs]
    assert found == pairs
    assert len(pairs) == 72


MATERIALS = handbook.shipped_materials()


@pytest.mark.long
@pytest.mark.parametrize("machine", handbook.shipped_machines(), ids=lambda m: m.slug)
def test_the_table_says_what_planning_says(machine: Machine) -> None:
    """One material for each machine, another for every machine; the command makes all."""
    number = [each.slug for each in handbook.shipped_machines()].index(machine.slug)
    for material in (MATERIALS[number % 6], MATERIALS[(number + 3) % 6]):
        assert handbook.row(stools.stool(), material, machine) in PAGE


def test_the_other_parts_of_the_page_are_those_the_code_makes() -> None:
    for part in (handbook.INTRODUCTION, handbook.sections(), handbook.relief()):
        assert part in PAGE
    for name in handbook.pictures():
        assert f"({name})" in PAGE
        assert (ROOT / "docs" / name).is_file()


def test_presets_are_sourced() -> None:
    assert issubclass(Material, Sourced)
    assert issubclass(Machine, Sourced)
