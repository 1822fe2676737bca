"""Machines that differ in their line or their motors, and a simulator to talk to by hand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from foldmill import installed
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator


@pytest.fixture
def machine() -> Callable[..., Machine]:
    """A generic cutter, or another machine, with other serial or motion settings."""

    def changed(slug: str = "generic-hpgl-600", **settings: Any) -> Machine:
        base: Machine = installed().get(MACHINES, "machine", slug)
        moving = {
            key: settings.pop(key)
            for key in list(settings)
            if key in type(base.motion).model_fields
        }
        return base.model_copy(
            update={
                "serial": base.serial.model_copy(update=settings),
                "motion": base.motion.model_copy(update=moving),
            }
        )

    return changed


@pytest.fixture
def told() -> Callable[..., bytes]:
    """Write to a simulator, and return what comes back within some seconds."""

    def answered(simulator: Simulator, data: bytes, seconds: float = 30.0) -> bytes:
        simulator.write(data)
        simulator.clock.sleep(seconds)
        return simulator.read()

    return answered


@pytest.fixture
def plugged() -> Iterator[Callable[[Simulator], str]]:
    """Put simulators behind sim:// addresses for one test."""
    urls: list[str] = []

    def plug(simulator: Simulator) -> str:
        urls.append(devices.plug(f"bench-{len(urls)}", simulator))
        return urls[-1]

    yield plug
    for url in urls:
        devices.unplug(url)


@pytest.fixture
def programs() -> dict[str, bytes]:
    """Of each language a program of many strokes of some seconds each."""
    far = range(10, 210, 2)
    return {
        "hpgl": b"IN;SP1;VS10;"
        + b"".join(b"PU%d,0;PD%d,4000;PD%d,0;" % (40 * x, 40 * x, 40 * x) for x in far)
        + b"PU;",
        "gcode": b"G21G90\nG0Z5\n"
        + b"".join(
            b"G0X%dY10\nG1Z-1F600\nG1X%dY110F6000\nG1X%dY10\nG0Z5\n" % (x, x, x) for x in far
        ),
        "gp-gl": b"J1\x03!10\x03FX10\x03"
        + b"".join(b"M%d,0\x03D%d,2000,%d,0\x03" % (20 * x, 20 * x, 20 * x) for x in far)
        + b"M0,0\x03",
    }
