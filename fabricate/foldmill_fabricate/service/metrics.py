"""What Prometheus is told: requests, computing, and, of machines, jobs and bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from prometheus_client import (
    CollectorRegistry,
    Counter,
    GCCollector,
    Histogram,
    PlatformCollector,
    ProcessCollector,
    generate_latest,
)
from prometheus_client.metrics_core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

MEDIA_TYPE = "text/plain; version=0.0.4; charset=utf-8"
_BUCKETS = (0.002, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60)
"""s"""


class _Asked(Collector):
    """Asks for its figures when it is read."""

    def __init__(self, ask: Callable[[], Iterable[Metric]]) -> None:
        self._ask = ask

    def describe(self) -> Iterable[Metric]:
        """Tell nothing before it is asked."""
        return ()

    def collect(self) -> Iterator[Metric]:
        """Yield the figures of now."""
        yield from self._ask()


class Metrics:
    """The figures of one service."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry(auto_describe=False)
        ProcessCollector(registry=self.registry)
        PlatformCollector(registry=self.registry)
        GCCollector(registry=self.registry)
        self._requests = Counter(
            "foldmill_requests_total",
            "Requests that were answered.",
            ["method", "route", "status"],
            registry=self.registry,
        )
        self._seconds = Histogram(
            "foldmill_request_seconds",
            "Time until a request was answered.",
            ["method", "route"],
            buckets=_BUCKETS,
            registry=self.registry,
        )

    def answered(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request; ``route`` : its path with names for its parts, empty for none."""
        known = method if method in {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE"} else "other"
        self._requests.labels(known, route or "none", str(status)).inc()
        self._seconds.labels(known, route or "none").observe(seconds)

    def ask(self, source: Callable[[], Iterable[Metric]]) -> None:
        """Ask for further figures whenever these are read."""
        self.registry.register(_Asked(source))

    def text(self) -> bytes:
        """Return all figures as Prometheus reads them."""
        return generate_latest(self.registry)


def computing(load: Callable[[], tuple[int, int]]) -> Callable[[], Iterator[Metric]]:
    """Return a source of the figures of a sandbox: pieces of work under way, and waiting."""

    def figures() -> Iterator[Metric]:
        under_way, waiting = load()
        about = "Pieces of work that other processes compute or that wait for one."
        family = GaugeMetricFamily("foldmill_computing", about, labels=["state"])
        family.add_metric(["under way"], under_way)
        family.add_metric(["waiting"], waiting)
        yield family

    return figures
