"""The hooks through which formats, machines and materials are offered.

They share the entry-point group ``foldmill`` with the families.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from foldmill import Fold
from foldmill.hooks import hookspec
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Plan

FORMATS = "foldmill_formats"
MACHINES = "foldmill_machines"
MATERIALS = "foldmill_materials"


@dataclass(frozen=True)
class Format:
    """A way to write a plan: one pure function from plan and fold to named files."""

    slug: str
    title: str
    write: Callable[[Plan, Fold], Mapping[str, bytes]]
    layout: Callable[[Plan], Sequence[tuple[str, Face, tuple[int, ...]]]] | None = None
    """Which of its files drive a machine: name, face and numbers of the set-ups, in order of work;
    None for drawings."""


HOOK_TYPES: dict[str, type] = {FORMATS: Format, MACHINES: Machine, MATERIALS: Material}
"""What the values of each hook must be."""


@hookspec
def foldmill_formats() -> Iterable[Format]:
    """Return the file formats this plugin writes. Called once per registry."""
    return ()


@hookspec
def foldmill_machines() -> Iterable[Machine]:
    """Return the machines this plugin knows. Called once per registry."""
    return ()


@hookspec
def foldmill_materials() -> Iterable[Material]:
    """Return the materials this plugin knows. Called once per registry."""
    return ()
