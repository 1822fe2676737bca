"""A machine that is off makes a coupon, a person reads it, and the next sheet comes out right."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import stools
from command import Run
from coupon_reader import Reader, lines_on

from foldmill import Fold
from foldmill_fabricate import shelf
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.files import write_whole
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.operators import SimulatedOperator
from foldmill_fabricate.passes import Face, Plan, ProgramFile
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.sender import Status
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.draw import groups, svg
from foldmill_fabricate.plotter.simulator.drawing import Imperfection
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.sending import Job, open_job
from foldmill_fabricate.verify import verify

OFF = Imperfection(scale_x=1.003, scale_y=1.003, flip_dx=0.35, flip_dy=-0.35)
"""0.3 % too long, and a flipped sheet that lies 0.35 mm off both ways."""
REGISTER = 0.05
"""mm that front and reverse may be apart on a calibrated machine."""


@pytest.fixture
def shop(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Iterator[Run]:
    """The command in an empty workshop, with a config folder of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    yield Run(capsys, monkeypatch)
    devices.unplug("sim://shop")


def cut(job: Job, pictures: Path) -> Path:
    """Have the machine that is off cut a job; return the folder of its pictures."""
    url = devices.plug("shop", Simulator(job.plan.machine, imperfection=OFF))
    statuses = [sent.delivery.status for sent in send_job(job, url, SimulatedOperator(url))]
    assert statuses == [Status.EXECUTED] * len(job.plan.programs)
    for face, strokes in devices.behind(url).sheet.strokes.items():
        found = groups(strokes)
        black = dict.fromkeys(found, "#000000")
        write_whole(pictures / f"{face}.svg", svg(found, job.plan.machine, face, black))
    return pictures


def verified(plan: Plan, fold: Fold) -> Job:
    """Return a job as it would be read from its folder."""
    programs = {part.name: hpgl.program(plan, part.setups) for part in hpgl.layout(plan)}
    named = [
        ProgramFile(name=part.name, face=part.face, setups=part.setups, sha256="")
        for part in hpgl.layout(plan)
    ]
    complete = plan.model_copy(update={"programs": tuple(named)})
    proof = verify(complete, fold.pattern, programs)
    assert proof.ok, proof.findings
    return Job(complete, programs, proof, None, fold.pattern, Path("coupon"))


def answers(bars: dict[str, float], x: float, y: float) -> str:
    lengths = "\n".join(f'{name} = "{length} mm"' for name, length in bars.items())
    return f"""
read_by = "A. Reader"
read_on = "2026-05-04"
temperature = "21 °C"
[best]
depth = "0.5 mm"
repeats = 3
relief = "2.5 mm"
[hinge]
at_90 = "22 deg"
at_180 = "31 deg"
[bars]
{lengths}
[vernier]
x = {x}
y = {y}
"""


def register(plan: Plan, pictures: Path) -> tuple[float, float]:
    """Return how far the reverse lies beside the front: in the middle of all, and at worst, mm.

    Each line's end is compared with where the plan has it; a sheet that is drawn too large, or
    askew, on both faces alike is no fault of the register.
    """
    corner, width = np.array([plan.sheet.dx, plan.sheet.dy]), plan.sheet.width
    off, at = {}, {}
    for work in plan.passes:
        ends = np.array(
            [p for s in work.setups for op in s.operations for k in op.strokes for p in k.points]
        )
        drawn = np.vstack(lines_on(pictures / f"{work.face}.svg")) - corner
        if work.face is Face.REVERSE:
            drawn[:, 0] = width - drawn[:, 0]
        gaps = np.hypot(*(drawn[:, None] - ends[None]).transpose(2, 0, 1))
        at[work.face] = ends[gaps.argmin(axis=1)]
        off[work.face] = drawn - at[work.face]
    front = np.column_stack([at[Face.FRONT], np.ones(len(at[Face.FRONT]))])
    rule, *_ = np.linalg.lstsq(front, off[Face.FRONT], rcond=None)
    behind = np.column_stack([at[Face.REVERSE], np.ones(len(at[Face.REVERSE]))])
    beside = off[Face.REVERSE] - behind @ rule
    return float(np.hypot(*np.median(beside, axis=0))), float(np.hypot(*beside.T).max())


def test_a_machine_that_is_off_is_brought_into_register_by_its_coupon(shop: Run) -> None:
    assert shop("coupon", "--to", "hpgl", "-o", "coupon").code == 0
    assert "#depth =" in Path("coupon/coupon-answers.toml").read_text(encoding="utf-8")
    plan = Plan.model_validate_json(Path("coupon/plan.json").read_bytes())
    assert plan.coupon is not None
    seen = Reader(plan, plan.coupon, cut(open_job(Path("coupon")), Path("coupon-cut")))
    bars, x, y = seen.bars(), seen.vernier("x"), seen.vernier("y")
    assert bars["ab"] == pytest.approx(1.003 * plan.coupon.bars.width, abs=0.06)
    assert abs(x) > 10, "the reverse lies more than a millimetre off: scale and flip together"
    Path("coupon/coupon-answers.toml").write_text(answers(bars, x, y), encoding="utf-8")
    recorded = shop("coupon", "--record", "coupon")
    assert recorded.code == 0, recorded.err

    material, machine = shelf.material("pp-0.75-mine"), shelf.machine("generic-hpgl-600-mine")
    assert material.tested
    assert "A. Reader on 2026-05-04, 21 °C" in material.provenance
    assert (material.score.exposure, material.score.repeats) == (0.5, 3)
    assert machine.axes.scale_x == pytest.approx(1 / 1.003, abs=3e-4)
    assert machine.axes.skew == pytest.approx(0, abs=0.02)
    assert machine.two_sides.dx == pytest.approx(0.35, abs=0.15)
    assert machine.two_sides.dy == pytest.approx(-0.35, abs=0.05)

    stool = stools.stool()
    after = make(stool, material, machine)
    assert "untested-material" not in {finding.code for finding in after.findings}
    middle, worst = register(after, cut(verified(after, stool), Path("stool-cut")))
    assert middle < REGISTER / 2
    assert worst < REGISTER
