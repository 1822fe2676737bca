"""A family's parameters on the command line: dotted names, as in every other place.

``--points.3.a 172.5`` sets one value over those of the preset; ``--insert points.3`` makes room for
another point 3, and ``--drop points.3`` leaves point 3 out; the later ones get new numbers. Nothing
here knows a family.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import BaseModel

from foldmill import Design, InvalidParameters, Params, UnreadableFile
from foldmill.numbered import inserted, moved, removed
from foldmill.schema import Leaf, leaves

_EDITS = ("insert", "drop")
_OPTIONS = ("preset", "params", "output", "force", "json")
"""Options that commands have beside a family's parameters."""


def gather(
    design: Design[Any], preset: str | None, file: Path | None, options: Sequence[str]
) -> Params:
    """Return parameters: the preset's or the defaults, then the file's, then the options'.

    What the file states replaces what was there, whole: a file with three points has three. What
    is inserted or dropped is so before any value is set, in the order in which it is said.
    """
    base = design.preset(preset) if preset else design.params()
    values: dict[str, Any] = base.model_dump()
    if file is not None:
        values |= _toml(file)
    given = list(pairs(options))
    _refuse_mistyped([name for name, _ in given], design)
    for name, text in given:
        if name in _EDITS:
            values = _renumber(design.params, values, name, text)
    placed = [(name.split("."), _value(text)) for name, text in given if name not in _EDITS]
    _start_anew(values, placed)
    for path, value in placed:
        _put(values, path, value)
    params: Params = design.validate(values)
    return params


def _refuse_mistyped(names: Sequence[str], design: Design[Any]) -> None:
    """Refuse what is no parameter and nearly an option: --presets is not a parameter misspelt."""
    from difflib import get_close_matches

    for name in names:
        near = get_close_matches(name, _OPTIONS, 1, 0.75)
        if near and name.split(".")[0] not in {*design.params.model_fields, *_EDITS}:
            raise InvalidParameters(f"There is no option --{name}. Did you mean --{near[0]}?")


def _renumber(model: type[Params], values: dict[str, Any], edit: str, place: str) -> dict[str, Any]:
    """Insert an empty part at a dotted place, such as points.3, or drop the one that is there."""
    name, _, last = place.replace("-", "_").partition(".")
    held = values.get(name)
    if not isinstance(held, dict | list | tuple) or not last.isdigit():
        raise InvalidParameters(
            f"--{edit} {place}: write the name of a numbered part, such as points.3."
        )
    items, i = held if isinstance(held, dict) else dict(enumerate(held)), int(last)
    try:
        numbers = inserted(items, i) if edit == "insert" else removed(items, i)
    except InvalidParameters as error:
        raise InvalidParameters(f"--{edit} {place}: {error}") from None
    parts = moved(items, numbers) | ({i: {}} if edit == "insert" else {})
    parts = dict(sorted(parts.items()))
    values[name] = parts if isinstance(held, dict) else list(parts.values())
    return model.renumbered(values, name, numbers)


def _start_anew(values: dict[str, Any], pairs: Sequence[tuple[list[str], Any]]) -> None:
    """Empty each object that an option gives a value it does not have: it becomes another kind.

    So ``--points.5.r 100 --points.5.z -140`` makes a point on its line a free one; and so does
    another ``kind``, where an object has one.
    """
    for path in {tuple(path[:-1]) for path, _ in pairs if len(path) > 1}:
        held = _at(values, path)
        given = {own[-1]: value for own, value in pairs if tuple(own[:-1]) == path}
        if (
            isinstance(held, dict)
            and all(isinstance(key, str) for key in held)
            and (set(given) - set(held) or given.get("kind", held.get("kind")) != held.get("kind"))
        ):
            held.clear()


def _at(values: Any, path: Sequence[str]) -> Any:
    """Return what stands at a dotted path, or None."""
    for part in path:
        if isinstance(values, list | tuple):
            values = values[int(part)] if part.isdigit() and int(part) < len(values) else None
        elif isinstance(values, dict):
            values = values.get(int(part) if part.isdigit() else part, values.get(part))
        else:
            return None
    return values


class Row(NamedTuple):
    """One parameter for people."""

    name: str
    value: str
    unit: str
    bounds: str
    about: str


def rows(values: BaseModel) -> Iterator[Row]:
    """Yield every parameter of a model, nested ones by dotted name."""
    plain = values.model_dump(mode="json")
    for leaf in leaves(values.model_json_schema(), plain):
        if leaf.schema.get("type") == "null":
            continue  # an optional value is told once, by what it may be
        about = " ".join(str(leaf.schema.get("description", "")).split())
        yield Row(
            leaf.name, _shown(_at(plain, leaf.name.split("."))), leaf.unit, _range(leaf), about
        )


def _shown(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:g}" if isinstance(value, float) else str(value)


def _range(leaf: Leaf) -> str:
    low = next((f"{b.value:g}" for b in leaf.bounds if b.side < 0), "")
    high = next((f"{b.value:g}" for b in leaf.bounds if b.side > 0), "")
    return f"{low}…{high}" if low or high else ""


def _toml(file: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UnreadableFile(f"{file} is no TOML file: {error}.") from None


def pairs(options: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield name and text of --name value and --name=value; raises InvalidParameters."""
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
