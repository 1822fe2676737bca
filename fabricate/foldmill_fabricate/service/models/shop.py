"""Plotters and the sheets of jobs; jobs themselves are the values of ``jobs.values``."""

from __future__ import annotations

from pydantic import Field

from foldmill_fabricate.service.models.wire import Wire, example


class ProgramRow(Wire):
    """A program of a sheet, and how far it is."""

    number: int
    """0, 1, 2 … in order of work"""
    name: str
    face: str
    state: str
    strokes: int
    certain: int
    """How many strokes are cut, by the machine's answers or a person's word."""
    doubtful: tuple[int, ...]
    """Numbers of strokes that may be cut, whole or in part: 1, 2, 3 …"""
    note: str
    """Why it ended as it did."""


class SheetPage(Wire):
    """A sheet of a job."""

    id: str
    """As it is written on the sheet."""
    begun: str
    """UTC, ISO 8601"""
    programs: tuple[ProgramRow, ...]


class PlotterStatus(Wire):
    """A plotter, and what it does now."""

    name: str
    port: str
    machine: str
    """slug of its profile"""
    at_work: bool
    """Whether anybody works on its jobs."""
    job: str
    """Id of the job that has it; empty for none."""
    state: str
    """Of that job; "free" where none has it."""
    note: str
    """Why the job stands so."""
    waiting: int
    """How many jobs wait for it."""
    sheet: SheetPage | None = None
    """The sheet that is worked on."""


class Priority(Wire):
    """A place in the queue."""

    model_config = example({"priority": 5})

    priority: int = Field(ge=-1000, le=1000)
    """Jobs of higher priority are made first."""


class Nothing(Wire):
    """An empty body: what is wanted stands in the path."""
