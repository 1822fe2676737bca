"""Which of the offered formats writes the programs that a machine runs."""

from __future__ import annotations

from foldmill import installed
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.hooks import FORMATS, Format
from foldmill_fabricate.machines import Machine


def writer(machine: Machine) -> Format | None:
    """Return the format that is named like the machine's language; None where nobody offers it."""
    found: Format | None = installed().of(FORMATS).get(machine.language)
    return found


def require_writer(machine: Machine) -> None:
    """Raise CannotPlan where nobody offers to write the programs of a machine."""
    if writer(machine) is None:
        raise CannotPlan(f"Nothing installed writes programs in {machine.language}.")


def usual_formats(machine: Machine) -> list[str]:
    """Return the formats of a job folder that nobody chose: drawings, and programs if any can."""
    return ["svg", "dxf", *([machine.language] if writer(machine) else [])]
