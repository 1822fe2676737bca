"""Whatever comes back from a wire, a delivery ends: with a sentence, or in what is known."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from soaking import Soak

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import VirtualClock
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.sender import send

Make = Callable[..., Machine]
SEED = 20261124
HPGL = b"IN;SP1;VS10;" + b"PU0,0;PD400,400;PD0,400;" * 20 + b"PU;SP0;"
GCODE = b"G21G90\nG0Z5\n" + b"G0X1Y1\nG1Z-1F600\nG1X9F6000\nG0Z5\n" * 20
GPGL = b"J1\x03" + b"M100,100\x03D200,200,300,100\x03" * 20
KINDS = {
    ("generic-hpgl-600", "esc-b"): HPGL,
    ("generic-hpgl-600", "enq-ack"): HPGL,
    ("generic-hpgl-600", "xon-xoff"): HPGL,
    ("grbl-laser", "grbl"): GCODE,
    ("silhouette-like", "gp-gl"): GPGL,
}
HP = b"0\r 1024\r 255\r 16\r 400,400,0\r 0,400,0\r0\r -1,,\r \x06 \x13 \x11 \r 8\r"
OTHERS = (
    rb"ok [GC:G1] error:20 <Idle|MPos:0.000,0.000,0.000|FS:0,0> <Run> ALARM:3 [OPT:V,15,128] Grbl"
)
STATUS = b"0\x03 1\x03 2\x03 \x03 \xff\x00 \n"
WORDS = [*HP.split(b" "), *STATUS.split(b" "), *(each + b"\r\n" for each in OTHERS.split(b" "))]


class Noise:
    """A port at whose other end is nobody, and on which there is much to hear."""

    timeout: float | None = 0.02
    out_waiting = 0
    dsr = True

    def __init__(self, chance: random.Random) -> None:
        self.clock, self.heard, self._chance = VirtualClock(), 0, chance
        self._ready = b""

    @property
    def in_waiting(self) -> int:
        return len(self._ready)

    def write(self, data: bytes) -> int:
        self.clock.sleep(len(data) / 960)
        self._speak()
        return len(data)

    def read(self, size: int = 1) -> bytes:
        if not self._ready:
            self.clock.sleep(0.02)
            self._speak()
        taken, self._ready = self._ready[:size], self._ready[size:]
        self.heard += len(taken)
        return taken

    def _speak(self) -> None:
        chance = self._chance
        if chance.random() < 0.8:
            word = chance.choice(WORDS) if chance.random() < 0.8 else chance.randbytes(3)
            self._ready += word * chance.choice([1, 1, 1, 50])

    def reset_input_buffer(self) -> None:
        self.heard += len(self._ready)
        self._ready = b""

    def reset_output_buffer(self) -> None:
        pass


def ended(program: bytes, port: Noise, machine: Machine) -> str:
    """Return how a delivery ended, in words."""
    try:
        return send(program, port, machine).status
    except PlotterError as error:
        return str(error)


@pytest.mark.parametrize("kind", list(KINDS), ids="-".join)
def test_no_replies_crash_a_delivery_or_keep_it_for_ever(
    kind: tuple[str, str], machine: Make, soak: Soak
) -> None:
    cutter = machine(kind[0], handshake=kind[1])
    wanted = soak.size(20_000, 2_000_000)
    with soak.part(f"reply-fuzz-{kind[1]}", SEED, wanted, "bytes") as progress:
        heard, number = progress.before, 0
        while heard < wanted:
            number += 1
            port = Noise(random.Random(f"{SEED} {heard} {number}"))
            assert ended(KINDS[kind], port, cutter)
            assert port.clock.now() < 3600
            heard += port.heard
            progress.reached(heard)
