"""Read a preset file: TOML into a frozen model, or one sentence that says what is wrong in it."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator
from importlib.resources import files
from typing import Any, NamedTuple, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from foldmill.errors import UnreadableFile
from foldmill.refusals import sentences
from foldmill_fabricate.toml_lines import line_of

INFORMATION: dict[str, Any] = {"x-information": True}
"""Marks a field that nothing computes with: it is kept for people."""


class Preset(BaseModel):
    """Base of material and machine models: frozen, closed, documented by attribute docstrings."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False
    )


class Row(NamedTuple):
    """One field of a preset, for people."""

    name: str
    """Dotted; the fields of a process stand under its kind, such as ``half-cut.force``."""
    value: Any
    unit: str
    about: str
    is_information: bool


class Sourced(Preset):
    """A preset that says of each field where its value comes from."""

    sources: dict[str, str] = Field(default_factory=dict)
    """Where single values come from, by dotted name such as ``half-cut.force``."""

    @model_validator(mode="after")
    def _sources_name_fields(self) -> Self:
        known = {row.name for row in rows(self)}
        for name in self.sources:
            if name not in known:
                raise ValueError(f"sources names {name}, which is no field of this preset")
        return self


def rows(preset: BaseModel, within: str = "") -> Iterator[Row]:
    """Yield every field of a preset, those of its parts after it by dotted name."""
    for name, field in type(preset).model_fields.items():
        if name in {"sources", "kind"}:
            continue
        value = getattr(preset, name)
        parts = value if isinstance(value, tuple) and value else (value,)
        if isinstance(parts[0], BaseModel):
            for part in parts:
                yield from rows(part, f"{within}{_known_as(part, name)}.")
            continue
        if name in {"other_scores", "other_cuts"}:
            continue
        extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
        about = " ".join((field.description or "").split())
        yield Row(f"{within}{name}", value, unit_of(field), about, "x-information" in extra)


def _known_as(part: BaseModel, name: str) -> str:
    """Return the name a part's fields stand under: a process goes by its kind."""
    return str(getattr(part, "known_as", getattr(part, "kind", name)))


def shown(value: Any) -> str:
    """Return a field's value as people write it."""
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, dict):
        return ", ".join(f"{key} {each}" for key, each in value.items())
    if isinstance(value, tuple):
        return ", ".join(shown(each) for each in value) or "-"
    return str(value)


def unit_of(field: Any) -> str:
    """Return the unit of a field, of an optional one as well; empty where it has none."""
    stated = [field, *(each for each in getattr(field, "metadata", ()))]
    for part in getattr(field.annotation, "__args__", ()):
        stated += getattr(part, "__metadata__", ())
    for each in stated:
        extra = getattr(each, "json_schema_extra", None)
        if isinstance(extra, dict) and "x-unit" in extra:
            return str(extra["x-unit"])
    return ""


M = TypeVar("M", bound=Preset)


def read(model: type[M], text: str, name: str) -> M:
    """Read one preset; raises UnreadableFile naming the file, the line and the field."""
    try:
        return model.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{name} is no TOML file: {error}.") from None
    except ValidationError as error:
        told = [
            f"line {line_of(text, place)}: {sentence}"
            for place, sentence in sentences(error, model)
        ]
        raise UnreadableFile(f"{name}, {' '.join(told)}") from None


def shipped(model: type[M], package: str) -> Iterable[M]:
    """Read every preset that lies beside a package, by name."""
    folder = files(package)
    names = sorted(entry.name for entry in folder.iterdir() if entry.name.endswith(".toml"))
    return [read(model, (folder / name).read_text(encoding="utf-8"), name) for name in names]
