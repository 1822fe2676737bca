"""Figures of jobs and machines for Prometheus, counted as programs are sent."""

from __future__ import annotations

import re
from collections.abc import Iterator

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram
from prometheus_client.metrics_core import GaugeMetricFamily, Metric

from foldmill_fabricate.delivering import Sent
from foldmill_fabricate.jobs import Desk, Kind
from foldmill_fabricate.jobs.values import JobRecord
from foldmill_fabricate.jobs.work import Tell
from foldmill_fabricate.passes import ProgramFile
from foldmill_fabricate.plotter.errors import Fenced, LineDisturbed, NoAnswer, PlotterError, Stopped
from foldmill_fabricate.plotter.sender import Delivery, Progress, Status

_SHARES = (0.5, 0.7, 0.8, 0.9, 0.95, 1, 1.05, 1.1, 1.2, 1.5, 2, 3)
_NOTHING = Progress(0, 0, 0, 0)
_WHY: dict[type[PlotterError], str] = {
    LineDisturbed: "bytes lost",
    NoAnswer: "no answer",
    Stopped: "stopped",
    Fenced: "taken over",
}
"""What a program that broke off is counted as; any other is a matter of the port or the machine."""
_OTHER, _FAULT, _UNCONFIRMED = "port or machine", "fault", "not confirmed"
REASONS = (*_WHY.values(), _OTHER, _FAULT, _UNCONFIRMED)


class Measured(Tell):
    """Hears how far programs are, and counts."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self.registry = CollectorRegistry(auto_describe=False)
        self._last: dict[str, tuple[str, Progress]] = {}
        """By plotter: the program under way, and how far it was when it was heard of last."""
        self._took: dict[str, float] = {}
        self._bytes = self._counter("foldmill_bytes", "Bytes of programs sent to a plotter.")
        self._units = self._counter("foldmill_instructions", "Whole instructions sent.")
        self._strokes = self._counter("foldmill_strokes", "Strokes known to be executed.")
        self._doubts = self._counter(
            "foldmill_interruptions", "Programs that ended in doubt.", "reason"
        )
        self._seconds = self._counter("foldmill_program_seconds", "Time that programs took.")
        self._starved = self._counter(
            "foldmill_starved_seconds", "Time that a machine had nothing to do within a program."
        )
        self._gap = self._gauge("foldmill_gap_seconds", "Longest such time in its last program.")
        self._late = self._gauge(
            "foldmill_late_seconds", "How late its sender woke at worst in its last program."
        )
        self._flying = self._gauge(
            "foldmill_in_flight_bytes", "Bytes sent and not executed yet, by the motion model."
        )
        self._left = self._gauge("foldmill_left_bytes", "Bytes of its program still to be sent.")
        self._share = self._shares("foldmill_time_share", "A sheet's time by its estimate.")
        self._set_up = self._shares(
            "foldmill_set_up_time_share",
            "A set-up's time, without pauses, by its motion.",
            "set_up",
        )
        for name in desk.plotters:
            self._begin(name)

    def sent(self, job: JobRecord, sheet: str, part: ProgramFile, progress: Progress) -> None:
        """Count what has left since this program was heard of last."""
        program = f"{job.id}/{sheet}/{part.name}"
        known, before = self._last.get(job.plotter, ("", _NOTHING))
        if known != program or before.bytes > progress.bytes:
            before = _NOTHING
        self._last[job.plotter] = program, progress
        self._bytes.labels(job.plotter).inc(progress.bytes - before.bytes)
        self._units.labels(job.plotter).inc(progress.instructions - before.instructions)
        flow, was = progress.flow, before.flow
        self._starved.labels(job.plotter).inc(flow.starved - was.starved)
        self._gap.labels(job.plotter).set(flow.gap)
        self._late.labels(job.plotter).set(flow.late)
        self._flying.labels(job.plotter).set(flow.in_flight)
        self._left.labels(job.plotter).set(progress.of_bytes - progress.bytes)

    def ended(self, job: JobRecord, sent: Sent) -> None:
        """Count the strokes of a program that has ended, and compare its time."""
        self._clear(job)
        delivery = sent.delivery
        self._seconds.labels(job.plotter).inc(delivery.seconds)
        self._compare_set_up(job, sent.program.name, delivery)
        records = self._desk.sheet(sent.sheet).records
        record = next((each for each in records if each.program.name == sent.program.name), None)
        if record is None:
            return
        if record.doubtful:
            unconfirmed = delivery.status is Status.UNCONFIRMED
            self._doubts.labels(job.plotter, _UNCONFIRMED if unconfirmed else _FAULT).inc()
        if record.runs:
            low, high = record.runs[-1].certain
            self._strokes.labels(job.plotter).inc(high - low)
        self._compare(job, sent.sheet, delivery.seconds)

    def broke_off(self, job: JobRecord, why: PlotterError) -> None:
        """Count a program that did not get to its end, by its reason."""
        if job.plotter in self._last:  # something had left
            self._doubts.labels(job.plotter, _WHY.get(type(why), _OTHER)).inc()
        self._clear(job)

    def collect(self) -> Iterator[Metric]:
        """Yield the figures of now: what is counted here, and jobs and questions as they stand."""
        yield from self.registry.collect()
        family = GaugeMetricFamily("foldmill_jobs", "Jobs that stand so.", labels=["state"])
        for state, count in self._desk.store.counts().items():
            family.add_metric([state.value], count)
        yield family
        about = "What people are asked at the machines and have not answered."
        family = GaugeMetricFamily("foldmill_questions", about, labels=["kind"])
        asked = [question.kind for question in self._desk.questions()]
        for kind in Kind:
            family.add_metric([kind.value], asked.count(kind))
        yield family

    def _begin(self, plotter: str) -> None:
        """Have all figures of a plotter there from the beginning, so that a rate can be told."""
        for each in (self._bytes, self._units, self._strokes, self._seconds, self._starved):
            each.labels(plotter)
        for gauge in (self._gap, self._late, self._flying, self._left):
            gauge.labels(plotter)
        for reason in REASONS:
            self._doubts.labels(plotter, reason)

    def _clear(self, job: JobRecord) -> None:
        """Let nothing be under way to a plotter; gap and lateness stay to be looked at."""
        self._last.pop(job.plotter, None)
        self._flying.labels(job.plotter).set(0)
        self._left.labels(job.plotter).set(0)

    def _compare_set_up(self, job: JobRecord, program: str, delivery: Delivery) -> None:
        """Compare the time of one program with its motion, whatever of it was left to be sent."""
        if delivery.modelled > 0:
            took = delivery.seconds - delivery.flow.paused
            name = re.fullmatch(r"(?:\d+-)?(.*?)(?:\.\w+)?", program)
            self._set_up.labels(job.plotter, name[1] if name else program).observe(
                took / delivery.modelled
            )

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

    def _counter(self, name: str, about: str, *more: str) -> Counter:
        return Counter(name, about, ["plotter", *more], registry=self.registry)

    def _gauge(self, name: str, about: str) -> Gauge:
        return Gauge(name, about, ["plotter"], registry=self.registry)

    def _shares(self, name: str, about: str, *more: str) -> Histogram:
        labels = ["plotter", *more]
        return Histogram(name, about, labels, buckets=_SHARES, registry=self.registry)
