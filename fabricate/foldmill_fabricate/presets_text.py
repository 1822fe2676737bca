"""A preset written as the TOML it is read from: units in the values."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from foldmill_fabricate.presets import Preset, unit_of


def written(preset: Preset, comment: str = "") -> str:
    """Return a preset as TOML; reading it gives the same preset again."""
    lines = [f"# {line}" for line in comment.splitlines()]
    lines += _table(preset, "")
    return "\n".join(lines).strip() + "\n"


def _table(model: BaseModel, name: str) -> Iterator[str]:
    """Yield a model's plain fields, then its tables: TOML has them in this order."""
    plain: list[tuple[str, Any, str]] = []
    tables: list[tuple[str, Any, str]] = []
    for field, info in type(model).model_fields.items():
        value = getattr(model, field)
        if value in (None, "", ()) or value == {}:
            continue
        (tables if _is_table(value) else plain).append((field, value, unit_of(info)))
    for field, value, unit in plain:
        yield f"{field} = {_value(value, unit)}"
    for field, value, _ in tables:
        yield from _tables(f"{name}{field}", value)


def _is_table(value: Any) -> bool:
    if isinstance(value, tuple):
        return bool(value) and isinstance(value[0], BaseModel)
    return isinstance(value, BaseModel | dict)


def _tables(name: str, value: Any) -> Iterator[str]:
    if isinstance(value, tuple):
        for part in value:
            yield from ("", f"[[{name}]]", *_table(part, f"{name}."))
    elif isinstance(value, dict):
        yield from ("", f"[{name}]")
        yield from (f"{json.dumps(str(key))} = {_value(each, '')}" for key, each in value.items())
    else:
        yield from ("", f"[{name}]", *_table(value, f"{name}."))


def _value(value: Any, unit: str) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return f"[{', '.join(_value(each, unit) for each in value)}]"
    if isinstance(value, int | float):
        return json.dumps(f"{value!r} {unit}") if unit else repr(value)
    # TOML wants this one escaped, JSON does not
    return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")
