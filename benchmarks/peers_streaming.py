"""Other people's sender and other people's plotter beside ours, on one computer in one run.

    python benchmarks/peers_streaming.py [PYTHON WITH inkcut] [PYTHON WITH chiplotle3] [LINES]

*Inkcut* (GPL) runs as a program of its own, with its own device, HP-GL protocol and waiting, over a
pseudo-terminal: as it comes, and with XON/XOFF turned on. It asks the machine nothing and sleeps as
long as it thinks a motion takes; it scales by 1021/90 for every machine, and sends one pair of
coordinates per instruction. So it gets the same drawing as an SVG, and "exact" is whether what it
sent reached the machine, "lost" what the full buffer dropped of that.

*chiplotle3*'s virtual serial port (GPL) is a plotter that other people imagined: it follows whole
instructions and answers OA. Our sender, in another process, has it execute a job, and what it says
of its place is compared with the job's end. It knows neither ESC.B nor OE, so that the handshake is
"none" and the end is "sent, not confirmed".

Columns as in hpgl_buddy.py; motors: share of the time until the machine stands still in which it
moved; time: until the sender had done its part, with Inkcut not yet the end. Real time on a busy
computer costs utilisation; compare the rows of one run only. Both peers are installed into
environments of their own: pip install inkcut PyQt5 enaml enamlx twisted pyqtgraph jsonpickle lxml
pyserial qt-reactor, and pip install chiplotle3 apply.
"""

from __future__ import annotations

import os
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

INKCUT = """
import os, sys
os.environ["QT_QPA_PLATFORM"] = "offscreen"
import serial
from enaml.qt.qt_application import QtApplication
app = QtApplication()
from inkcut.device.extensions import DeviceDriver
from inkcut.device.plugin import Device, DeviceTransport
from types import SimpleNamespace
from inkcut.core.svg import QtSvgDoc
from inkcut.core.workbench import InkcutWorkbench
from inkcut.device.protocols.hpgl import HPGLProtocol
from inkcut.job.models import Job

port, baud, drawing, copy, speed, flow = sys.argv[1:7]
line, kept = serial.Serial(port, int(baud), xonxoff=flow == "xon"), open(copy, "wb")

class Wire(DeviceTransport):
    def connect(self):
        self.connected = True
        self.protocol.transport = self
        self.protocol.connection_made()
    def write(self, data):
        data = data.encode() if hasattr(data, "encode") else data
        line.write(data)
        kept.write(data)
    def read(self, size=None):
        return b""
    def disconnect(self):
        self.connected = False

device = Device(declaration=DeviceDriver(width="60cm", length="60cm"))
device.connection = Wire(protocol=HPGLProtocol())
device.config.interpolate = False
device.config.speed_units, device.config.speed = "cm/s", float(speed)
window = SimpleNamespace(dpi_default=96.0, dpi_auto_detect_inkscape=True)  # it asks its own window
InkcutWorkbench.instance = lambda: SimpleNamespace(get_plugin=lambda name: window)
job = Job()
job.doc = job.path = QtSvgDoc(drawing)
job.info.auto_approve = True
done = device.submit(job)
def ended(result):
    kept.close()
    line.flush()
    print(job.info.status, "" if result is None else result, flush=True)
    os._exit(0)
done.addBoth(ended)
app.start()
"""
"""Drives Inkcut's own device; runs with Inkcut's own Python."""

CHIPLOTLE = """
import os, re, sys, tty
from chiplotle3.tools.serialtools.virtual_serial_port import VirtualSerialPort
plotter = VirtualSerialPort((0, 0), (32767, 32767))
here, there = os.openpty()
tty.setraw(here); tty.setraw(there)
print("\\n" + os.ttyname(there), flush=True)
waiting = b""
while True:
    waiting += os.read(here, 4096)
    while b";" in waiting:
        one, _, waiting = waiting.partition(b";")
        one = one.strip().decode()
        if one in ("IN", "DF", "PA"):  # a bare PA crashes it
            continue
        plotter.write(one + ";")
        if re.match("O[A-Z]", one) and one != "OE":
            os.write(here, plotter.readline().replace(b" ", b""))
"""
"""Puts that virtual port behind a pseudo-terminal; runs with chiplotle3's own Python."""

Sender = Callable[[str, Machine], None]


def machine() -> Machine:
    """Return a cutter of 1024 bytes that guards its buffer by XON/XOFF, as both senders can."""
    base: Machine = installed().get(MACHINES, "machine", "generic-hpgl-600")
    serial = base.serial.model_copy(update={"handshake": "xon-xoff"})
    return base.model_copy(update={"serial": serial})


def zigzag(lines: int) -> list[tuple[float, float]]:
    """Return a saw-toothed way, mm."""
    return [(20 + 2.0 * k, 20 + 3.0 * (k % 2)) for k in range(lines + 1)]


def program(lines: int) -> bytes:
    """Return the way as a program of ours, one pair an instruction, at 20 cm/s."""
    (x, y), *onward = [(round(40 * u), round(40 * v)) for u, v in zigzag(lines)]
    body = "".join(f"PD{u},{v};" for u, v in onward)
    return f"IN;DF;PA;PU;SP1;VS20;PU{x},{y};{body}PU;SP0;".encode()


def drawing(lines: int) -> str:
    """Return the way as SVG."""
    way = " ".join(f"{x:g},{y:g}" for x, y in zigzag(lines))
    wide = 60 + 2 * lines
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}mm" height="60mm" '
        f'viewBox="0 0 {wide} 60"><polyline fill="none" stroke="black" points="{way}"/></svg>'
    )


def row(name: str, send_it: Callable[[str, Path], bytes], plotter: Machine) -> str:
    """Have a sender deliver over a pseudo-terminal, and measure what the machine saw."""
    simulator = Simulator(plotter, clock=RealClock())
    with tempfile.TemporaryDirectory() as folder, serve_pty(simulator) as port:
        began = time.perf_counter()
        sent = send_it(port, Path(folder))
        seconds = time.perf_counter() - began
        while not simulator.device.idle:
            time.sleep(0.05)
            simulator.advance()
        whole = time.perf_counter() - began
    traffic, tally = simulator.device.traffic, simulator.device.carriage.tally
    got = bytes(traffic.program).replace(b"OA;", b"").replace(b"OE;", b"")
    errors = tally.errors + sum(traffic.errors.values())
    motors = tally.moving / whole
    return (
        f"{name:11s} {len(sent):6d} {got == sent!s:>5s} {traffic.overruns:5d} "
        f"{traffic.fullest:7d} {errors:6d} {motors:7.1%} {seconds:7.1f} s"
    )


def ours(lines: int, plotter: Machine) -> Callable[[str, Path], bytes]:
    """Return our own sender."""

    def deliver(port: str, _folder: Path) -> bytes:
        data = as_sent(program(lines), plotter)
        with open_port(port, plotter) as opened:
            send(data, opened, plotter)
        return data

    return deliver


def inkcut(python: str, lines: int, plotter: Machine, flow: str) -> Callable[[str, Path], bytes]:
    """Return Inkcut as a sender."""

    def deliver(port: str, folder: Path) -> bytes:
        (folder / "way.svg").write_text(drawing(lines))
        copy = folder / "sent.hpgl"
        words = [python, "-c", INKCUT, port, str(plotter.serial.baud), str(folder / "way.svg")]
        words += [str(copy), "20", flow]
        said = subprocess.run(words, capture_output=True, text=True, timeout=600, check=False)
        print("Inkcut says:", said.stdout.strip() or said.stderr[-300:], flush=True)
        return copy.read_bytes()

    return deliver


def independent_fake(python: str, lines: int) -> str:
    """Send to chiplotle3's virtual port; return what both say of the end."""
    serial = machine().serial.model_copy(update={"handshake": "none"})
    plotter = machine().model_copy(update={"serial": serial})
    data = as_sent(program(lines), plotter)
    words = [python, "-u", "-c", CHIPLOTLE]
    with (
        tempfile.TemporaryDirectory() as home,  # it writes settings there, and asks whether it may
        subprocess.Popen(
            words,
            stdout=subprocess.PIPE,
            stdin=subprocess.PIPE,
            text=True,
            env=os.environ | {"HOME": home},
        ) as fake,
    ):
        assert fake.stdout is not None
        assert fake.stdin is not None
        fake.stdin.write("\n" * 20)
        fake.stdin.flush()
        port = next(each.strip() for each in fake.stdout if each.startswith("/dev/"))
        with open_port(port, plotter) as opened:
            delivery = send(data, opened, plotter)
        fake.terminate()
    x, y = (round(40 * value) for value in zigzag(lines)[-1])
    return (
        f"chiplotle3's virtual port: {delivery.status}; {len(instructions(data))} instructions, it "
        f"stands at {delivery.position}, the job ends at {(float(x), float(y))}"
    )


def main() -> None:
    """Print a row per sender, and what the other plotter says."""
    names = [shutil.which(each) if each else None for each in (*sys.argv[1:3], "", "")[:2]]
    lines = int(sys.argv[3]) if len(sys.argv) > 3 else 200
    plotter = machine()
    print(f"reserve {reserve(plotter.serial.buffer)} bytes of {plotter.serial.buffer}, 9600 baud")
    print("sender       bytes exact  lost fullest errors  motors    time")
    print(row("foldmill", ours(lines, plotter), plotter), flush=True)
    if names[0]:
        for flow in ("none", "xon"):
            peer = inkcut(names[0], lines, plotter, flow)
            print(row(f"Inkcut {flow}", peer, plotter), flush=True)
    else:
        print("Inkcut: name a Python that has it.")
    print(independent_fake(names[1], lines) if names[1] else "chiplotle3: name a Python with it.")


if __name__ == "__main__":
    main()
