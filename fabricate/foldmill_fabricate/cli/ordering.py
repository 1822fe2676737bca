"""What becomes a job as it is named on the command line: a folder, a drawing, or a design."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from foldmill import FoldmillError
from foldmill_fabricate.names import PLAN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from foldmill_fabricate.jobs import Jobs, Order


class Words(NamedTuple):
    """What is said beside the name of what becomes a job."""

    preset: str
    params: Sequence[str]
    """NAME=VALUE of a family"""
    material: str
    options: Sequence[str]
    """NAME=VALUE of planning"""
    pens: Sequence[str]
    """PEN=USE of a drawing"""


def wanted(desk: Jobs, what: str, plotter: str, words: Words) -> dict[str, Any]:
    """Return ``plan`` or ``design`` of a submission; folders and drawings are kept at once."""
    from foldmill_fabricate.cli import drawings

    path = Path(what)
    if drawings.is_drawing(path) and not path.is_dir():
        return {"plan": _drawn(desk, path, plotter, words)}
    drawings.refuse_pens(words.pens)
    if (path / PLAN).is_file():
        if words.preset or words.params or words.options:
            raise FoldmillError("--preset, --param and --option are of a design, not of a folder.")
        return {"plan": desk.keep(path)}
    if path.exists():
        raise FoldmillError(f"{what} is no job folder: plan it first, or name a family.")
    machine = desk.machine_of(plotter)
    preset, params, material, options, _ = words
    _refuse_neither(what)
    return {"design": ordered(what, preset, params, material, machine, options)}


def _refuse_neither(what: str) -> None:
    """Raise UnknownName, which is about folders too, for what is no family either."""
    from foldmill import UnknownName, installed

    try:
        installed().design(what)
    except UnknownName as error:
        raise UnknownName(
            f"There is no job folder {what} here, and no such family: {error}"
        ) from None


def _drawn(desk: Jobs, file: Path, plotter: str, words: Words) -> str:
    """Have a drawing planned and kept; return the id of its plan."""
    from foldmill_fabricate.cli import drawings

    if words.preset or words.params:
        raise FoldmillError("--preset and --param are of a design, not of a drawing.")
    options, machine = _chosen(words.options), desk.machine_of(plotter)
    asked = drawings.asked(file, words.pens, words.material, machine, options)
    return desk.keep_drawing(drawings.content(file), asked)


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
        options=read_options(_chosen(options)),
    )


def _chosen(options: Sequence[str]) -> dict[str, Any]:
    return {name: _value(name, value) for name, value in map(_pair, options)}


def _pair(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise FoldmillError(f"{text!r}: write NAME=VALUE.")
    return name.strip(), value.strip()


def _value(name: str, text: str) -> Any:
    """Read a value: a number, a word, or WIDTHxHEIGHT."""
    if name in {"blank", "carrier"}:
        from foldmill_fabricate.cli.choices import size

        return size(text, name)
    try:
        return json.loads(text)
    except ValueError:
        return text
