"""How a delivery ends."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from foldmill_fabricate.plotter.program import XY


class Status(StrEnum):
    """How a delivery ended."""

    EXECUTED = "executed"
    """the machine has answered, in order, that all of it is done and nothing was lost"""
    ENDED = "at its end"
    """the machine has answered, in order, that it is done; it cannot tell whether all was received
    """
    UNCONFIRMED = "sent, not confirmed"
    """all bytes are sent; nobody knows whether they were executed"""
    FAULT = "executed with a fault"
    """the machine has answered, and reports an error or another place than the program's end"""

    @property
    def is_done(self) -> bool:
        """Whether the machine has said that it is done, and nothing is known to be wrong."""
        return self in (Status.EXECUTED, Status.ENDED)


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
    proved: str = ""
    """what the machine's answers prove, and what they do not; empty for nothing"""
