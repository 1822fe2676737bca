"""Submit a job folder to a plotter, here a simulated one, and see what it cut on each face."""

import sys
from pathlib import Path

from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.operators import SimulatedOperator
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.draw import draw
from foldmill_fabricate.sending import open_job

# A real machine: "/dev/ttyUSB0" or "socket://host:port", and an operator who loads and flips.
URL = "sim://workshop?machine=generic-hpgl-pens"


def main(folder: Path) -> None:
    """Send every program of the folder, in order; both faces end up beside it as pictures."""
    job = open_job(folder)  # verified here, whatever was said of it before
    for sent in send_job(job, URL, SimulatedOperator(URL)):
        print(sent.program.name, sent.delivery.status, f"{sent.delivery.seconds:.0f} s")
    simulator = devices.behind(URL)
    for picture in draw(simulator.sheet, simulator.machine, folder / "as-cut"):
        print(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/stool-sheet"))
