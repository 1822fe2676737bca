"""A sender by other people against the simulated plotter: hpgl-buddy over a pseudo-terminal.

    python benchmarks/hpgl_buddy.py [PATH OF hpgl-buddy] [BYTES]

hpgl-buddy (`pip install hpgl-buddy`, in an environment of its own) asks for the free bytes by ESC.B
as our own sender does, so both are shown on the same machine, an HP 7475A, in real time. It is a
program of its own here; without it only our row appears. Columns:

exact        whether the machine got the bytes of the file, and nothing else but questions
lost         bytes dropped by a full buffer
fullest      highest occupancy of the buffer
split        times ESC.B came in the middle of an instruction
errors       HP-GL and I/O errors
utilisation  time in which the line was busy, of that and the time in which it stood idle although
             the next whole instruction had room
payload      HP-GL among all bytes sent

Real time on a busy computer costs utilisation; compare the rows of one run only.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from foldmill import installed
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.languages import reserve
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.program import instructions
from foldmill_fabricate.plotter.sender import as_sent, send
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.servers import serve_pty
from foldmill_fabricate.plotter.simulator.trial import fine_lines

_QUESTIONS = (b"OA;", b"OE;", b"OS;", b"OI;", b"OH;")


def machine(baud: int) -> Machine:
    """Return an HP 7475A at a rate."""
    base: Machine = installed().get(MACHINES, "machine", "hp-7475a")
    return base.model_copy(update={"serial": base.serial.model_copy(update={"baud": baud})})


def ours(program: bytes, port: str, plotter: Machine) -> None:
    """Send it by our own sender."""
    with open_port(port, plotter) as opened:
        send(program, opened, plotter)


def theirs(command: str) -> Callable[[bytes, str, Machine], None]:
    """Return a sender that runs hpgl-buddy."""

    def sender(program: bytes, port: str, plotter: Machine) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "program.hpgl"
            path.write_bytes(program)
            words = [command, "plot", str(path), "--port", port, "--baud", str(plotter.serial.baud)]
            said = subprocess.run(words, capture_output=True, text=True, timeout=600, check=False)
            if said.returncode:
                print(said.stdout[-400:], said.stderr[-400:])

    return sender


def row(name: str, sender: Callable[[bytes, str, Machine], None], size: int, baud: int) -> str:
    """Deliver a program over a pseudo-terminal, and measure."""
    plotter = machine(baud)
    program = fine_lines(size, 8, speed=38)
    simulator = Simulator(plotter, clock=RealClock(), speed_up=4)
    program = as_sent(program, plotter)
    if sender is not ours:
        program = program.replace(b"\n", b"")  # hpgl-buddy leaves line ends out
    with serve_pty(simulator) as port:
        gauge = simulator.watch(instructions(program), reserve(plotter.serial.buffer))
        began = time.perf_counter()
        sender(program, port, plotter)
        seconds = time.perf_counter() - began
        simulator.advance()
    traffic, tally = simulator.device.traffic, simulator.device.carriage.tally
    got = bytes(traffic.program)
    for question in _QUESTIONS:
        got = got.replace(question, b"")
    exact = got == program
    return (
        f"{name:11s} {baud:6d} {len(program):7d} {exact!s:>5s} {traffic.overruns:5d} "
        f"{traffic.fullest:7d} {traffic.split:6d} {tally.errors + sum(traffic.errors.values()):6d} "
        f"{gauge.use.utilisation:11.1%} {gauge.use.payload:7.1%} {seconds:7.1f} s"
    )


def main() -> None:
    """Print one row per sender and rate."""
    command = shutil.which(sys.argv[1] if len(sys.argv) > 1 else "hpgl-buddy")
    size = int(sys.argv[2]) if len(sys.argv) > 2 else 12_000
    print(
        "sender        baud   bytes exact  lost fullest  split errors utilisation payload    time"
    )
    if command is None:
        print("hpgl-buddy is not installed: pip install hpgl-buddy, and name its path.")
    for baud in (9600, 38400):
        print(row("foldmill", ours, size, baud), flush=True)
        if command is not None:
            print(row("hpgl-buddy", theirs(command), size, baud), flush=True)


if __name__ == "__main__":
    main()
