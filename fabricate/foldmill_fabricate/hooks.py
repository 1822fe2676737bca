"""The hooks through which formats, interpreters, machines, materials and readers are offered.

They share the entry-point group ``foldmill`` with the families.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from foldmill import Fold
from foldmill.hooks import hookspec
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Fit, Plan

if TYPE_CHECKING:
    from foldmill.exchange.drawing import Drawing
    from foldmill.exchange.limits import Limits
    from foldmill.exchange.options import Options
    from foldmill_fabricate.profiles import Style
    from foldmill_fabricate.verify.interpreter import Trace

FORMATS = "foldmill_formats"
INTERPRETERS = "foldmill_interpreters"
MACHINES = "foldmill_machines"
MATERIALS = "foldmill_materials"
READERS = "foldmill_readers"


@dataclass(frozen=True)
class Format:
    """A way to write a plan: one pure function from plan and fold to named files."""

    slug: str
    title: str
    write: Callable[[Plan, Fold], Mapping[str, bytes]]
    layout: Callable[[Plan], Sequence[tuple[str, Face, tuple[int, ...]]]] | None = None
    """Which of its files drive a machine: name, face and numbers of the set-ups, in order of work;
    None for drawings. Such a format is named like the ``language`` of the machine's profile."""
    program: Callable[[Plan, Sequence[int], Fit | None], bytes] | None = None
    """Writes the program of some set-ups anew, fitted to how the flipped sheet really lies."""
    drawn: Callable[[Plan, Fold, Style], Mapping[str, bytes]] | None = None
    """Writes as ``write`` does, in a style that was asked for; None where there is none to ask."""


@dataclass(frozen=True)
class Interpreter:
    """A way to read programs back: what verification knows of a language.

    Whoever offers a format for machines offers its interpreter too, or nothing it writes can be
    proved. It shares no code with the writer: read the language anew, by the machine's manual.
    """

    slug: str
    """The language, as ``language`` of a machine's profile names it."""
    title: str
    replay: Callable[[bytes, str, Machine], Trace]
    """Takes a program, its name for findings, and the machine; says what it makes the machine do.
    What is wrong in the program becomes findings of the trace; nothing is raised."""


@dataclass(frozen=True)
class Sized:
    """A fold as a reader found it, and whether its file says how large it is."""

    fold: Fold
    is_sized: bool


@dataclass(frozen=True)
class Reader:
    """A way to read other people's patterns: one pure function from bytes to lines.

    It is called on files of strangers: it opens nothing, expands nothing, refuses what is above the
    limits, and raises UnreadableFile with a sentence for whatever it cannot read.
    """

    slug: str
    title: str
    suffixes: tuple[str, ...]
    """Of its files, as ".svg"."""
    read: Callable[[bytes, Options, Limits], Drawing | Sized]
    """Returns the lines as they are drawn, which then are joined to a sheet; or, from a format that
    knows sheets, the fold."""
    recognises: Callable[[bytes], bool] | None = None
    """Tells by the first kilobytes of a file whether it is one of these."""


HOOK_TYPES: dict[str, type] = {
    FORMATS: Format,
    INTERPRETERS: Interpreter,
    MACHINES: Machine,
    MATERIALS: Material,
    READERS: Reader,
}
"""What the values of each hook must be."""


@hookspec
def foldmill_formats() -> Iterable[Format]:
    """Return the file formats this plugin writes. Called once per registry."""
    return ()


@hookspec
def foldmill_interpreters() -> Iterable[Interpreter]:
    """Return the languages whose programs this plugin can replay. Called once per registry."""
    return ()


@hookspec
def foldmill_machines() -> Iterable[Machine]:
    """Return the machines this plugin knows. Called once per registry."""
    return ()


@hookspec
def foldmill_materials() -> Iterable[Material]:
    """Return the materials this plugin knows. Called once per registry."""
    return ()


@hookspec
def foldmill_readers() -> Iterable[Reader]:
    """Return the formats of crease patterns this plugin reads. Called once per registry."""
    return ()
