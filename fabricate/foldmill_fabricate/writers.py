"""Which of the offered formats writes the programs that a machine runs."""

from __future__ import annotations

from foldmill import installed
from foldmill_fabricate.hooks import FORMATS, Format
from foldmill_fabricate.machines import Machine


def writer(machine: Machine) -> Format | None:
    """Return the format that is named like the machine's language; None where nobody offers it."""
    found: Format | None = installed().of(FORMATS).get(machine.language)
    return found
