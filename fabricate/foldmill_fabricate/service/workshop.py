"""The jobs of this computer's plotters: the verbs, and who works on them while the service runs."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from typing import TYPE_CHECKING

from foldmill_fabricate.jobs import Desk, Places
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.jobs.states import ACTIVE
from foldmill_fabricate.jobs.values import JobRecord
from foldmill_fabricate.service.measuring import Measured
from foldmill_fabricate.service.models import PlotterStatus, ProgramRow, SheetPage

if TYPE_CHECKING:
    from foldmill_fabricate.jobs.host import Host


class Workshop:
    """Jobs, plotters and, unless ``works`` is False, the work on them in threads of this process.

    name : of this computer, where other computers use the same database.
    """

    def __init__(
        self,
        places: Places,
        plotters: Mapping[str, Plotter] | None = None,
        name: str = "",
        *,
        works: bool = True,
    ) -> None:
        self.places, self.works, self._name = places, works, name
        places.root.mkdir(parents=True, exist_ok=True)
        self.desk = Desk(places, plotters or {})
        self.gauges = Measured(self.desk)
        self._host: Host | None = None

    def start(self) -> None:
        """Begin to work; raises JobRefused where another process does so already."""
        if self.works and self._host is None:
            from foldmill_fabricate.jobs.host import Host

            logging.getLogger("dbos").setLevel(logging.ERROR)
            self._host = Host(self.places, self.desk.plotters, self._name, self.gauges)
            self._host.start()

    def stop(self) -> None:
        """Stop the machines; what is under way is taken up again by the next service."""
        host, self._host = self._host, None
        if host is not None:
            host.stop()

    def close(self) -> None:
        """Stop, and let go of the database."""
        self.stop()
        self.desk.store.close()

    @property
    def is_at_work(self) -> bool:
        """Whether anybody works on jobs here."""
        return self._host is not None

    def wake(self) -> None:
        """Have new jobs looked at now."""
        if self._host is not None:
            self._host.wake()

    def sheets(self, job: JobRecord) -> list[SheetPage]:
        """Return how far each sheet of a job is, stroke by stroke, as the ledger has it."""
        return [self._sheet(name) for name in job.sheets]

    def _sheet(self, name: str) -> SheetPage:
        found = self.desk.sheet(name)
        rows = tuple(
            ProgramRow(
                number=record.number,
                name=record.program.name,
                face=record.program.face,
                state=record.state.value,
                strokes=record.program.strokes,
                certain=len(record.certain),
                doubtful=tuple(stroke + 1 for stroke in record.doubtful),
                note=record.note,
            )
            for record in found.records
        )
        return SheetPage(id=found.id, begun=found.begun, programs=rows)

    def plotters(self) -> list[PlotterStatus]:
        """Return how each plotter stands, by name."""
        waiting = self.desk.store.due()
        under_way = {job.plotter: job for job in self.desk.jobs([*ACTIVE]) if job.begun}
        return [
            self._plotter(plotter, waiting.get(name, 0), under_way.get(name))
            for name, plotter in sorted(self.desk.plotters.items())
        ]

    def _plotter(self, plotter: Plotter, due: int, job: JobRecord | None) -> PlotterStatus:
        return PlotterStatus(
            name=plotter.name,
            port=plotter.port,
            machine=plotter.machine,
            at_work=self.is_at_work,
            job=job.id if job else "",
            state=job.state.value if job else "free",
            note=job.note if job else "",
            waiting=due - (job is not None),
            sheet=self._sheet(job.sheets[-1]) if job and job.sheets else None,
        )
