"""The parameters of a design, one by one, as its JSON schema states them.

A parameter inside another has one dotted name everywhere, such as ``points.3.a`` or ``tucks.0.t``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, get_args

from pydantic import BaseModel

Schema = dict[str, Any]
Path = tuple[str | int, ...]

ANY = "*"
"""Stands for every key of a mapping and every place in a list where there are no values."""
_NO_VALUES: Any = object()
_BOUNDS = (
    ("minimum", -1, False),
    ("exclusiveMinimum", -1, True),
    ("maximum", 1, False),
    ("exclusiveMaximum", 1, True),
)


@dataclass(frozen=True)
class Bound:
    """One end of a parameter's range."""

    value: float
    side: int
    """-1 for a lower bound, 1 for an upper one."""
    is_exclusive: bool


@dataclass(frozen=True)
class Leaf:
    """A parameter that holds no others."""

    path: Path
    """Where it stands among the values; ANY where there are none."""
    kind: str
    """Its name with ANY for every key and place: alike for alike parameters."""
    schema: Schema

    @property
    def name(self) -> str:
        """Its dotted name."""
        return ".".join(str(part) for part in self.path)

    @property
    def is_integer(self) -> bool:
        """Whether it is a whole number."""
        return bool(self.schema.get("type") == "integer")

    @property
    def is_number(self) -> bool:
        """Whether it is a number and not one of a few choices."""
        is_choice = "enum" in self.schema or "const" in self.schema
        return self.schema.get("type") in {"integer", "number"} and not is_choice

    @property
    def unit(self) -> str:
        """ "mm", "deg" or nothing."""
        return str(self.schema.get("x-unit", ""))

    @property
    def is_ratio(self) -> bool:
        """Whether it runs from 0 to 1, and so needs no unit."""
        return [bound.value for bound in self.bounds] == [0, 1]

    @property
    def bounds(self) -> list[Bound]:
        """The ends of its range, the lower ones first."""
        stated = [row for row in _BOUNDS if row[0] in self.schema]
        return [Bound(self.schema[key], side, exclusive) for key, side, exclusive in stated]


def leaves(schema: Schema, values: Any = _NO_VALUES) -> Iterator[Leaf]:
    """Yield every parameter that holds no others: those of ``values`` if given, else every kind."""
    for path, kind, node in _walk(schema, schema.get("$defs", {}), (), (), values):
        if not _holds_others(node):
            yield Leaf(path, ".".join(kind), node)


def objects(schema: Schema) -> Iterator[tuple[str, Schema]]:
    """Yield the dotted kind and the schema of every parameter that holds others by name."""
    for _, kind, node in _walk(schema, schema.get("$defs", {}), (), (), _NO_VALUES):
        if node.get("type") == "object":
            yield ".".join(kind), node


def models(kind: Any) -> Iterator[type[BaseModel]]:
    """Yield the parameter models in a type, the type itself and those of its fields included."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield kind
        for field in kind.model_fields.values():
            yield from models(field.annotation)
    for part in get_args(kind):
        yield from models(part)


def outside(bound: Bound, is_integer: bool) -> float:
    """Return the number nearest to a bound that it does not allow."""
    if bound.is_exclusive:
        return bound.value
    return (
        bound.value + bound.side
        if is_integer
        else math.nextafter(bound.value, bound.side * math.inf)
    )


def inside(bound: Bound, is_integer: bool) -> float:
    """Return the number nearest to a bound that it allows."""
    if not bound.is_exclusive:
        return bound.value
    return (
        bound.value - bound.side
        if is_integer
        else math.nextafter(bound.value, -bound.side * math.inf)
    )


def placed(values: dict[str, Any], path: Path, new: Any) -> dict[str, Any]:
    """Return a copy of the values with one of them changed."""
    changed = deepcopy(values)
    holder: Any = changed
    for part in path[:-1]:
        holder = holder[part]
    holder[path[-1]] = new
    return changed


def _holds_others(node: Schema) -> bool:
    return node.get("type") in {"object", "array"}


def _walk(
    node: Schema, defs: Schema, path: Path, kind: tuple[str, ...], value: Any
) -> Iterator[tuple[Path, tuple[str, ...], Schema]]:
    """Yield path, kind and schema of a parameter and of all in it, with references followed."""
    for option in _options(node, defs, value):
        yield path, kind, option
        for part, name, child in _children(option, value):
            inner = value if value is _NO_VALUES else _inside(value, part)
            yield from _walk(child, defs, (*path, part), (*kind, name), inner)


def _inside(value: Any, part: str | int) -> Any:
    return value.get(part) if isinstance(value, dict) else value[part]


def _options(node: Schema, defs: Schema, value: Any) -> Iterator[Schema]:
    """Yield the schemas that may describe a value: several for a union, one for all else."""
    if "$ref" in node:
        target = defs[node["$ref"].rsplit("/", 1)[1]]
        yield from _options(
            {**target, **{k: v for k, v in node.items() if k != "$ref"}}, defs, value
        )
    elif "anyOf" in node or "oneOf" in node:
        shared = {"description": node["description"]} if "description" in node else {}
        for each in node["anyOf"] if "anyOf" in node else node["oneOf"]:
            yield from _options(shared | each, defs, value)
    elif value is _NO_VALUES or _fits(node, value):
        yield node


def _fits(node: Schema, value: Any) -> bool:
    if isinstance(value, dict):
        known = node.get("properties", value)
        return node.get("type") == "object" and all(key in known for key in value)
    return _holds_others(node) == isinstance(value, list)


def _children(node: Schema, value: Any) -> Iterator[tuple[str | int, str, Schema]]:
    """Yield the part, its name among kinds and the schema of each parameter inside one."""
    for name, child in node.get("properties", {}).items():
        yield name, name, child
    entry = node.get("additionalProperties", node.get("items"))
    if isinstance(entry, dict):
        for part in _parts(node, value):
            yield part, ANY, entry


def _parts(node: Schema, value: Any) -> list[str | int]:
    if value is _NO_VALUES:
        return [ANY]
    if node.get("type") == "array":
        return list(range(len(value)))
    return [key for key in value if key not in node.get("properties", {})]
