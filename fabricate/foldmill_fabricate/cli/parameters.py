"""A family's parameters on the command line: dotted names, as in every other place.

``--points.3.a 172.5`` sets one value over those of the preset; nothing here knows a family.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from foldmill import Design, InvalidParameters, Params, UnreadableFile


def gather(
    design: Design[Any], preset: str | None, file: Path | None, options: Sequence[str]
) -> Params:
    """Return parameters: the preset's or the defaults, then the file's, then the options'."""
    base = design.preset(preset) if preset else design.params()
    values: dict[str, Any] = base.model_dump()
    if file is not None:
        for path, value in _leaves(_toml(file)):
            _put(values, path, value)
    for name, text in _pairs(options):
        _put(values, name.split("."), _value(text))
    params: Params = design.validate(values)
    return params


def rows(model: type[BaseModel], values: BaseModel) -> Iterator[tuple[str, str, str, str]]:
    """Yield name, value, unit and documentation of every parameter, nested ones by dotted name."""
    for name, info in model.model_fields.items():
        extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
        unit = str(extra.get("x-unit", ""))
        about = " ".join((info.description or "").split())
        yield from _rows(name, getattr(values, name), unit, about)


def _rows(name: str, value: Any, unit: str, about: str) -> Iterator[tuple[str, str, str, str]]:
    if isinstance(value, BaseModel):
        for row in rows(type(value), value):
            yield (f"{name}.{row[0]}", *row[1:])
    elif isinstance(value, Mapping):
        for key, each in value.items():
            yield from _rows(f"{name}.{key}", each, unit, about)
    elif isinstance(value, tuple | list) and value and isinstance(value[0], BaseModel):
        for key, each in enumerate(value):
            yield from _rows(f"{name}.{key}", each, unit, about)
    else:
        shown = "" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
        yield (name, shown, unit, about)


def _toml(file: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UnreadableFile(f"{file} is no TOML file: {error}.") from None


def _leaves(values: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[list[str], Any]]:
    items = values.items() if isinstance(values, dict) else enumerate(values)
    for key, value in items:
        here = (*path, str(key))
        if isinstance(value, dict | list):
            yield from _leaves(value, here)
        else:
            yield list(here), value


def _pairs(options: Sequence[str]) -> Iterator[tuple[str, str]]:
    words = iter(options)
    for word in words:
        if not word.startswith("--"):
            raise InvalidParameters(f"{word!r} belongs to no parameter; write --name value.")
        name, equals, value = word[2:].partition("=")
        if not equals:
            given = next(words, None)
            if given is None:
                raise InvalidParameters(f"--{name} needs a value.")
            value = given
        yield name.replace("-", "_"), value


def _value(text: str) -> Any:
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


def _put(values: Any, path: Sequence[str], value: Any) -> None:
    """Set the value at a dotted path, making what is missing on the way."""
    name = ".".join(path)
    for depth, part in enumerate(path):
        key = _key(values, part, name)
        if depth == len(path) - 1:
            _set(values, key, value)
            return
        below = values[key] if _has(values, key) else {}
        below = list(below) if isinstance(below, tuple) else below
        if not isinstance(below, dict | list):
            raise InvalidParameters(f"{name}: {'.'.join(path[: depth + 1])} has no parts.")
        _set(values, key, below)
        values = below


def _key(values: Any, part: str, name: str) -> Any:
    if isinstance(values, list):
        if not part.isdigit() or int(part) > len(values):
            raise InvalidParameters(f"{name}: {part!r} is no place from 0 to {len(values)}.")
        return int(part)
    numbered = values and all(isinstance(key, int) for key in values)
    return int(part) if numbered and part.isdigit() else part


def _has(values: Any, key: Any) -> bool:
    return key < len(values) if isinstance(values, list) else key in values


def _set(values: Any, key: Any, value: Any) -> None:
    if isinstance(values, list) and key == len(values):
        values.append(value)
    else:
        values[key] = value
