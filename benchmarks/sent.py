"""Send a job folder to a simulated plotter, and compare what that drew with the plan.

    python benchmarks/sent.py JOB sim://MACHINE

The folder is verified and sent as ``foldmill send --yes`` does. Then each stroke that the machine
drew is laid beside the stroke of the plan that is its turn: as many, in that order, on that face,
and how far apart at most. Used by benchmarks/sheets.py; ends with an error where they differ by
more than a step.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray

from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.operators import SimulatedOperator
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.drawing import Drawn
from foldmill_fabricate.sending import open_job

Points = NDArray[np.float64]


def planned(plan: Plan, face: Face) -> Iterator[Points]:
    """Give the strokes of a face in order of work, mm on the sheet, each as often as it is cut."""
    for work in (each for each in plan.passes if each.face is face):
        for setup in work.setups:
            for operation in setup.operations:
                for stroke in operation.strokes:
                    yield np.array(stroke.points)


def on_sheet(drawn: Drawn, plan: Plan, face: Face) -> Points:
    """Return where a stroke lies on the sheet, mm seen from the front."""
    told = drawn.millimetres(plan.machine.axes) - (plan.sheet.dx, plan.sheet.dy)
    if face is Face.FRONT:
        return told
    mirrored: Points = told * (-1, 1) + (2 * plan.flip.axis, 0)
    return mirrored


def apart(drawn: Points, wanted: Points) -> float:
    """Return how far one line goes from the other, mm."""
    if drawn.shape == wanted.shape:
        return float(np.hypot(*(drawn - wanted).T).max())
    lines = [shapely.LineString(each) for each in (drawn, wanted)]
    return float(shapely.hausdorff_distance(*lines, densify=0.1))


def compared(plan: Plan, url: str) -> tuple[int, float]:
    """Return how many strokes were drawn, and how far they are from the plan's at most, mm."""
    sheet, count, farthest = devices.behind(url).sheet, 0, 0.0
    for face in Face:
        pairs = zip(sheet.strokes[face], planned(plan, face), strict=True)
        for drawn, wanted in pairs:
            farthest = max(farthest, apart(on_sheet(drawn, plan, face), wanted))
            count += 1
    return count, farthest


def main(path: Path, url: str) -> None:
    """Send, compare and print what was found."""
    job = open_job(path)
    if job.plan.flip.kind != "left-right":
        sys.exit(
            f"{path} is turned {job.plan.flip.kind}; this compares sheets turned left to right."
        )
    ends = [sent.delivery for sent in send_job(job, url, SimulatedOperator(url))]
    seconds = sum(each.seconds for each in ends)
    said = ", ".join(each.status for each in ends)
    count, farthest = compared(job.plan, url)
    step = 1 / job.plan.machine.axes.units_per_mm
    print(
        f"{said} in {seconds / 3600:.1f} h of the machine; {count} strokes drawn, at most "
        f"{farthest:.4f} mm from the plan's (a step is {step:g} mm)"
    )
    if farthest > step:
        sys.exit("What was drawn is not what was planned.")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
