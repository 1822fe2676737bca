"""How well the sender uses a serial line, on simulated machines and simulated time.

    python benchmarks/streaming.py [BYTES]

Each row streams one program (default 200,000 bytes). Under "limit", *line* means that the motors
are faster than the line, *motion* that the line is faster, so that the buffer is full most of the
time. Columns:

lost         bytes dropped by a full buffer
same         whether the machine got exactly the bytes of the program
fullest      highest occupancy of the buffer
utilisation  time in which the line was busy, of that and the time in which it stood idle although
             the next whole instruction could have gone (free bytes less those on the wire at least
             its length and the reserve; on XON/XOFF: the machine did not hold; and at most three
             seconds of motion, or one stroke, not begun by the machine)
filling      the same, without the last condition: what a sender would do that fills the buffer
payload      HP-GL among all bytes sent
motors       time in which the machine moved, of all

Where motion is the limit and the buffer large, room is left unused on purpose: at most three
seconds of motion are in flight, so that stopping means something; "filling" is low there and says
so. The answer's own way, 3-10 ms an instruction, is hidden by lending up to half of the reserve,
and where motion is waited for by believing the motion model shortly after an answer. At 115200
baud and 255 bytes an instruction takes as long as a question and its answer, and some is lost. The
motors never wait. A machine that is not asked at all ("none") is fed by the motion model, with
caution, and so does wait.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from typing import Literal

from foldmill import installed
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator.trial import fine_lines, stream

_STEP = 8
"""Steps: 0.2 mm a tooth."""


@dataclass(frozen=True)
class Case:
    """A serial line, and what limits the work on it."""

    handshake: Literal["none", "xon-xoff", "esc-b"]
    baud: int
    buffer: int
    limit: Literal["line", "motion"]


CASES = [
    Case("esc-b", 9600, 255, "line"),
    Case("esc-b", 9600, 255, "motion"),
    Case("esc-b", 9600, 1024, "line"),
    Case("esc-b", 9600, 1024, "motion"),
    Case("esc-b", 115200, 255, "line"),
    Case("esc-b", 115200, 255, "motion"),
    Case("esc-b", 115200, 1024, "line"),
    Case("esc-b", 115200, 1024, "motion"),
    Case("esc-b", 9600, 15_358, "line"),
    Case("esc-b", 9600, 15_358, "motion"),
    Case("esc-b", 115200, 15_358, "line"),
    Case("esc-b", 115200, 15_358, "motion"),
    Case("xon-xoff", 9600, 255, "line"),
    Case("xon-xoff", 9600, 255, "motion"),
    Case("xon-xoff", 115200, 1024, "line"),
    Case("xon-xoff", 115200, 1024, "motion"),
    Case("none", 9600, 255, "line"),
    Case("none", 9600, 255, "motion"),
]


def machine(case: Case) -> Machine:
    """Return a machine whose motors, or whose line, are about three times the faster of the two."""
    base: Machine = installed().get(MACHINES, "machine", "generic-hpgl-600")
    pair = 11 * 10 / case.baud
    seconds = pair / 3 if case.limit == "line" else pair * 3
    length = _STEP * 2**0.5 / base.axes.units_per_mm
    motion = base.motion.model_copy(
        update={"acceleration": 4 * length / seconds**2, "travel_speed": 1000.0, "lift_time": 0.01}
    )
    serial = base.serial.model_copy(
        update={"handshake": case.handshake, "baud": case.baud, "buffer": case.buffer}
    )
    return base.model_copy(update={"motion": motion, "serial": serial})


def main() -> None:
    """Print one row per case."""
    size = int(sys.argv[1]) if len(sys.argv) > 1 else 200_000
    program = fine_lines(size, _STEP)
    print(
        "handshake   baud buffer  limit   bytes lost  same fullest utilisation filling payload "
        "motors"
    )
    for case in CASES:
        began = time.perf_counter()
        trial = stream(program, machine(case))
        real = time.perf_counter() - began
        seconds = trial.delivery.seconds
        print(
            f"{case.handshake:8s} {case.baud:7d} {case.buffer:6d} {case.limit:>6s} "
            f"{trial.delivery.bytes:7d} {trial.traffic.overruns:4d} {trial.identical!s:>5s} "
            f"{trial.traffic.fullest:7d} {trial.use.utilisation:11.2%} {trial.use.filling:7.1%} "
            f"{trial.use.payload:7.1%} {trial.moving / seconds:6.1%}  "
            f"{seconds:5.0f} s simulated in {real:.1f} s"
        )


if __name__ == "__main__":
    main()
