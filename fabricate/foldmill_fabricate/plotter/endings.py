"""How a delivery ends."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from foldmill_fabricate.plotter.program import XY


class Status(StrEnum):
    """How a delivery ended."""

    EXECUTED = "executed"
    """the machine has answered, in order, that all of it is done"""
    UNCONFIRMED = "sent, not confirmed"
    """all bytes are sent; nobody knows whether they were executed"""
    FAULT = "executed with a fault"
    """the machine has answered, and reports an error or another place than the program's end"""


@dataclass(frozen=True)
class Ending:
    """What a machine said when all was sent."""

    status: Status
    position: XY | None = None
    """where it says its tool is: steps, of GRBL mm"""
    error: int | None = None
    """the error it reports; 0 for none"""
    fault: str = ""
    """what is wrong, a sentence; empty for nothing"""
