"""HP-GL drawings from elsewhere, as `foldmill plan` takes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foldmill import FoldmillError

if TYPE_CHECKING:
    from foldmill_fabricate.foreign import Asked, Use
    from foldmill_fabricate.machines import Machine
    from foldmill_fabricate.materials import Material
    from foldmill_fabricate.passes import Plan

_SUFFIXES = frozenset({".hpgl", ".hpg", ".hgl", ".plt"})


def is_drawing(file: Path) -> bool:
    """Tell from its name whether a file holds HP-GL."""
    return file.suffix.lower() in _SUFFIXES


def refuse_options(given: bool, registers: bool, options: Any) -> None:
    """Raise FoldmillError where an option is given that only a pattern can follow.

    options : those of reading a file, None for none.
    """
    from foldmill.exchange.options import Options

    if given or registers or options not in (None, Options()):
        raise FoldmillError(
            "An HP-GL drawing is made as it is drawn, on one face: --unassigned, --relief, "
            "--copies, --grid, --registration, --temperature and --planarise and its like are for "
            "patterns. Leave them out."
        )


def refuse_pens(pens: Sequence[str]) -> None:
    """Raise FoldmillError where pens of a pattern are spoken of, which has none."""
    if pens:
        raise FoldmillError("--pen is about the pens of an HP-GL drawing; this file has none.")


def planned(
    file: Path,
    pens: Sequence[str],
    material: Material,
    machine: Machine,
    asked: Mapping[str, Any],
) -> Plan:
    """Read a drawing and plan it; ``asked`` : score, cut, blank and carrier, as they were given.

    Raises what ``read`` and ``plan_drawing`` raise.
    """
    from foldmill_fabricate.foreign import plan_drawing, read

    data = content(file)
    uses = dict(_pen(each) for each in pens)
    if len(uses) < len(pens):
        raise FoldmillError("--pen says two things of one pen; say one.")
    drawing = read(data, file.name)
    return plan_drawing(drawing, uses, material, machine, **asked)


def content(file: Path) -> bytes:
    """Return the bytes of a drawing, at most one more than is read of any."""
    from foldmill_fabricate.foreign import limits

    try:
        with file.open("rb") as opened:
            return opened.read(limits.BYTES + 1)
    except OSError as error:
        raise FoldmillError(f"{file}: {error.strerror or error}.") from None


def asked(
    file: Path, pens: Sequence[str], material: str, machine: str, options: Mapping[str, Any]
) -> Asked:
    """Return what is said of a drawing that becomes a job; options : of planning, by name."""
    from pydantic import ValidationError

    from foldmill.refusals import explain
    from foldmill_fabricate.foreign import Asked

    said = [f"{number}={use.value}" for number, use in map(_pen, pens)]
    head: dict[str, Any] = {
        "name": file.name,
        "pen": said,
        "material": material,
        "machine": machine,
    }
    if unknown := sorted({*options} - {"score", "outline", "blank", "carrier"}):
        raise FoldmillError(
            f"--option {unknown[0]} is not for an HP-GL drawing, which is made as it is drawn: "
            "score, outline, blank and carrier are."
        )
    try:
        return Asked.model_validate({**head, **options})
    except ValidationError as error:
        raise FoldmillError(explain(error)) from None


def _pen(text: str) -> tuple[int, Use]:
    from foldmill_fabricate.foreign import Use

    number, _, use = text.strip().partition("=")
    if not (number.isascii() and number.isdecimal()) or use not in {*Use} or len(number) > 3:
        raise FoldmillError(f"--pen {text!r}: write PEN=USE, such as 1=cut; {', '.join(Use)}.")
    return int(number), Use(use)
