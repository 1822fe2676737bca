"""A design as it is ordered on the command line: NAME=VALUE pairs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from foldmill import FoldmillError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from foldmill_fabricate.jobs import Order


def ordered(
    family: str,
    preset: str,
    params: Sequence[str],
    material: str,
    machine: str,
    options: Sequence[str],
) -> Order:
    """Return an order; raises UnknownName or InvalidInput with the sentence."""
    from foldmill import installed
    from foldmill_fabricate.cli.parameters import gather
    from foldmill_fabricate.jobs import Order
    from foldmill_fabricate.plan_options import read_options

    design = installed().design(family)
    given = [f"--{name}={value}" for name, value in map(_pair, params)]
    values = gather(design, preset or None, None, given)
    return Order(
        family=family,
        preset=preset,
        params=values.model_dump(mode="json"),
        material=material,
        machine=machine,
        options=read_options({name: _value(name, value) for name, value in map(_pair, options)}),
    )


def _pair(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise FoldmillError(f"{text!r}: write NAME=VALUE.")
    return name.strip(), value.strip()


def _value(name: str, text: str) -> Any:
    """Read a value: a number, a word, or WIDTHxHEIGHT."""
    if name in {"blank", "carrier"}:
        from foldmill_fabricate.cli.making import size

        return size(text, name)
    try:
        return json.loads(text)
    except ValueError:
        return text
