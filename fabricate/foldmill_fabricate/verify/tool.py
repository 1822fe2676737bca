"""A tool that a program sends about: where it went, and what it drew with which settings."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.verify.interpreter import Run, Trace

Floats = NDArray[np.float64]
XY = tuple[float, float]


@dataclass
class Tool:
    """The state that every language has; steps of the machine."""

    name: str
    """The program's, for findings."""
    at: XY | None = None
    """None until the program has said where to go: nobody knows where the tool stands then."""
    number: int | None = None
    choices: int = 0
    speed: float | None = None
    """mm/s"""
    force: float | None = None
    """gf"""
    settings: dict[str, float] = field(default_factory=dict)
    runs: list[Run] = field(default_factory=list)
    visited: list[XY] = field(default_factory=list)
    bytes: list[int] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    _drawing: list[XY] | None = None
    _down_at: int = 0
    _state: tuple[object, ...] = ()

    @property
    def down(self) -> bool:
        """Whether it is in the sheet."""
        return self._drawing is not None

    def complain(self, code: str, byte: int, message: str, remedy: str = "") -> None:
        """Note what is wrong at a byte of the program."""
        where = f"{self.name}, byte {byte}"
        self.findings.append(Finding(code, Severity.ERROR, where, message, remedy))

    def lower(self, byte: int) -> None:
        """Put it into the sheet where it is."""
        if self._drawing is not None:
            return
        if self.at is None:
            self.complain("no-position", byte, "The tool goes down before it was sent anywhere.")
        self._drawing = [] if self.at is None else [self.at]
        self._down_at, self._state = byte, self._now()

    def lift(self) -> None:
        """Take it out of the sheet."""
        if self._drawing:
            points: Floats = np.array(self._drawing, float).reshape(-1, 2)
            tool, speed, force, choice, settings = self._state
            state = tool, speed, force, self._down_at, choice, settings
            self.runs.append(Run(points, *state))  # type: ignore[arg-type]
        self._drawing = None

    def go(self, to: XY, byte: int) -> None:
        """Send it somewhere, as it is; every run has one speed, one force and the same settings."""
        if self._drawing is not None and self._state != self._now():
            if len(self._drawing) > 1:
                self.lift()
                self.lower(byte)
            self._state = self._now()
        self.at = to
        self.visited.append(to)
        self.bytes.append(byte)
        if self._drawing is not None:
            self._drawing.append(to)

    def ended(self, byte: int) -> Trace:
        """Return what was done; at the end the tool must be out of the sheet."""
        if self.down:
            self.complain("pen-left-down", byte, "The program ends with the tool in the sheet.")
            self.lift()
        visited: Floats = np.array(self.visited, float).reshape(-1, 2)
        return Trace(tuple(self.runs), visited, tuple(self.bytes), tuple(self.findings))

    def _now(self) -> tuple[object, ...]:
        settings = tuple(sorted(self.settings.items()))
        return self.number, self.speed, self.force, self.choices, settings
