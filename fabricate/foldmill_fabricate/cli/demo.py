"""The stool, end to end, with a short account of each stage."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import perf_counter

from foldmill import Fold, installed
from foldmill.check import check
from foldmill.finding import has_errors
from foldmill_fabricate import folder, pictures
from foldmill_fabricate.cli.account import describe
from foldmill_fabricate.cli.demo_job import make_job
from foldmill_fabricate.cli.designing import save
from foldmill_fabricate.cli.making import presets
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.files import write_whole
from foldmill_fabricate.operators import SimulatedOperator
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.draw import draw
from foldmill_fabricate.sending import open_job
from foldmill_fabricate.verify import report, verify_folder

Say = Callable[[str], None]

MACHINE = "generic-hpgl-600"
MATERIAL = "pp-0.75"


def make_stool(out: Path, say: Say) -> None:
    """Make ``stool-n8`` into a folder; raises CannotSend where a stage finds a fault."""
    began = perf_counter()
    fold = _design(out, say)
    _plan(fold, out, say)
    _verify(out, say)
    _send(out, say)
    make_job(out, f"sim://{MACHINE}", say)
    say(f"\nDone in {perf_counter() - began:.1f} s. Everything is in {out}/:")
    say("  " + "  ".join(sorted(path.name for path in out.iterdir())))


def _design(out: Path, say: Say) -> Fold:
    tuck = installed().design("tuck")
    fold = tuck.run(tuck.preset("stool-n8"))
    found = check(fold)
    figures = found.figures
    say("1. Design: a stool from one sheet, eight wedges with a tuck each")
    say(
        f"   {figures['mountains']} mountains, {figures['valleys']} valleys, {figures['flats']} "
        f"flats; angle sums within {figures['angle_sum_rad']:.0e} rad, isometric to "
        f"{figures['isometry']:.0e}, {figures['penetrations']} penetrations"
    )
    if has_errors(list(found.findings)):
        raise CannotSend(f"The stool does not fold: {found.findings[0]}")
    save(fold, out / "stool.fold")
    save(fold, out / "stool.glb")
    write_whole(out / "pattern.png", pictures.pattern_picture(fold))
    write_whole(out / "folded.png", pictures.folded_picture(fold))
    return fold


def _plan(fold: Fold, out: Path, say: Say) -> Plan:
    say("\n2. Plan: half-cut 0.75 mm polypropylene, one tool, the sheet turned left-right")
    plan = folder.write(fold, make(fold, *presets(MATERIAL, MACHINE)), out, ["svg", "dxf", "hpgl"])
    write_whole(out / "sheet.png", pictures.sheet_picture(plan))
    say(_indented(describe(plan)))
    return plan


def _verify(out: Path, say: Say) -> None:
    say("\n3. Verify: the programs replayed on a virtual sheet, the plan derived again")
    text = report(verify_folder(out))
    write_whole(out / "verification.txt", text.encode())
    say(_indented(text))


def _send(out: Path, say: Say) -> None:
    say("\n4. Send: to a simulated plotter, 9600 baud, 1024 bytes of buffer")
    url = f"sim://{MACHINE}"
    job = open_job(out)
    for sent in send_job(job, url, SimulatedOperator(url)):
        took = f"{sent.delivery.seconds / 60:.1f} min of the machine's time"
        say(
            f"   {sent.program.name:28} {sent.delivery.status}, {sent.delivery.bytes} bytes, {took}"
        )
    simulator = devices.behind(url)
    for path in draw(simulator.sheet, simulator.machine, out / "as-cut", job.plan):
        say(f"   drawn as cut: {path.relative_to(out)}")


def _indented(text: str) -> str:
    return "\n".join(f"   {line}" if line else "" for line in text.rstrip().splitlines())
