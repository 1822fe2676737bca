"""Figures of jobs and machines for Prometheus, counted as programs are sent."""

from __future__ import annotations

from collections.abc import Iterator

from prometheus_client import CollectorRegistry, Counter, Histogram
from prometheus_client.metrics_core import GaugeMetricFamily, Metric

from foldmill_fabricate.jobs import Desk, JobState
from foldmill_fabricate.jobs.values import JobRecord
from foldmill_fabricate.jobs.work import Tell
from foldmill_fabricate.passes import ProgramFile
from foldmill_fabricate.plotter.sender import Progress

_SHARES = (0.5, 0.7, 0.8, 0.9, 0.95, 1, 1.05, 1.1, 1.2, 1.5, 2, 3)


class Measured(Tell):
    """Hears how far programs are, and counts."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self.registry = CollectorRegistry(auto_describe=False)
        self._last: dict[tuple[str, str, str], Progress] = {}
        self._took: dict[str, float] = {}
        self._bytes = self._counter("foldmill_bytes", "Bytes of programs sent to a plotter.")
        self._units = self._counter("foldmill_instructions", "Whole instructions sent.")
        self._strokes = self._counter("foldmill_strokes", "Strokes known to be executed.")
        self._doubts = self._counter("foldmill_interruptions", "Programs that ended in doubt.")
        self._seconds = self._counter("foldmill_program_seconds", "Time that programs took.")
        self._share = Histogram(
            "foldmill_time_share",
            "Time that a sheet took at the machine, by the time that was estimated for it.",
            ["plotter"],
            buckets=_SHARES,
            registry=self.registry,
        )

    def _counter(self, name: str, about: str) -> Counter:
        return Counter(name, about, ["plotter"], registry=self.registry)

    def sent(self, job: JobRecord, sheet: str, part: ProgramFile, progress: Progress) -> None:
        """Count what has left since this program was heard of last."""
        key = (job.id, sheet, part.name)
        before = self._last.get(key)
        if before is None or before.bytes > progress.bytes:
            before = Progress(0, 0, 0, 0)
        self._last[key] = progress
        self._bytes.labels(job.plotter).inc(progress.bytes - before.bytes)
        self._units.labels(job.plotter).inc(progress.instructions - before.instructions)

    def ended(self, job: JobRecord, sheet: str, part: ProgramFile, seconds: float) -> None:
        """Count the strokes of a program that has ended, and compare its time."""
        self._last.pop((job.id, sheet, part.name), None)
        self._seconds.labels(job.plotter).inc(seconds)
        records = self._desk.sheet(sheet).records
        record = next((each for each in records if each.program.name == part.name), None)
        if record is None:
            return
        if record.doubtful:
            self._doubts.labels(job.plotter).inc()
        if record.runs:
            low, high = record.runs[-1].certain
            self._strokes.labels(job.plotter).inc(high - low)
        self._compare(job, sheet, seconds)

    def _compare(self, job: JobRecord, sheet: str, seconds: float) -> None:
        """Compare the time of a sheet that went through at once with its estimate."""
        self._took[sheet] = self._took.get(sheet, 0.0) + seconds
        found = self._desk.sheet(sheet)
        if found.is_open:
            return
        took = self._took.pop(sheet)
        if all(len(record.runs) == 1 for record in found.records):
            estimate = self._desk.plans.plan(job.plan).figures.seconds
            self._share.labels(job.plotter).observe(took / max(estimate, 0.1))

    def collect(self) -> Iterator[Metric]:
        """Yield the figures of now: what is counted here, and jobs by state."""
        yield from self.registry.collect()
        about = "Jobs that stand so; ended ones of the last thousand."
        family = GaugeMetricFamily("foldmill_jobs", about, labels=["state"])
        found = [job.state for job in self._desk.jobs()]
        for state in JobState:
            family.add_metric([state.value], found.count(state))
        yield family
