"""The test sheet of a material on a machine: made, and recorded once a person has read it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from foldmill import FoldmillError
from foldmill_fabricate.cli.account import describe, next_steps
from foldmill_fabricate.cli.choices import (
    BlankSize,
    CarrierSize,
    FlipChoice,
    FlipKind,
    Formats,
    MachineSlug,
    MaterialSlug,
    ProcessChoice,
    ScoreProcess,
    size,
)
from foldmill_fabricate.cli.making import formats_for, presets
from foldmill_fabricate.cli.output import AsJson, exit_code, say

if TYPE_CHECKING:
    from foldmill_fabricate.coupon.record import Recorded
    from foldmill_fabricate.passes import Plan


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    app.command()(coupon)


def coupon(
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="The job folder to write.")
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(
            help="A coupon's folder, or the answers in it: make presets of what was read."
        ),
    ] = None,
    material: MaterialSlug = "pp-0.75",
    machine: MachineSlug = "generic-hpgl-600",
    blank: BlankSize = None,
    carrier: CarrierSize = None,
    flip: FlipKind = FlipChoice.LEFT_RIGHT,
    score: ScoreProcess = None,
    outline: Annotated[
        ProcessChoice | None,
        typer.Option(help="How cuts are made; default: the first the machine can do."),
    ] = None,
    degree: Annotated[int, typer.Option(help="How many creases meet in a patch: 4 or 6.")] = 4,
    suffix: Annotated[
        str, typer.Option(help="With --record: what the slugs of your presets end with.")
    ] = "mine",
    force: Annotated[
        bool, typer.Option("--force", help="With --record: write over presets that are there.")
    ] = False,
    to: Formats = None,
    as_json: AsJson = False,
) -> None:
    """Make a test sheet for depth, spacing, relief and flip, or record what was read from one."""
    if (output is None) == (record is None):
        raise FoldmillError("Say -o FOLDER to make a coupon, or --record FOLDER to record one.")
    if record is not None:
        _record(record, material, machine, suffix, force=force, as_json=as_json)
        return
    from foldmill_fabricate.coupon.make import make

    if degree not in (4, 6):
        raise FoldmillError(f"--degree is 4 or 6, not {degree}.")
    of, on = presets(material, machine)
    formats = formats_for(to, on)
    fold, made = make(
        of,
        on,
        blank=None if blank is None else size(blank, "--blank"),
        carrier=None if carrier is None else size(carrier, "--carrier"),
        flip=flip.value,
        score=None if score is None else score.value,
        cut=None if outline is None else outline.value,
        degree=_degree(degree),
    )
    from foldmill_fabricate import folder

    assert output is not None
    written = folder.write(fold, made, output, formats)
    say(as_json, written.model_dump(mode="json"), _account(written, output))
    exit_code(written.findings)


def _degree(number: int) -> Literal[4, 6]:
    return 4 if number == 4 else 6


def _account(plan: Plan, folder: Path) -> str:
    from foldmill_fabricate.coupon.answers import NAME

    left_out = plan.coupon.left_out if plan.coupon else ()
    told = [
        describe(plan),
        *left_out,
        next_steps(plan, folder),
        f"How it is read stands on {folder / 'job-sheet.pdf'};",
    ]
    told.append(f"write what you read into {folder / NAME}, then foldmill coupon --record {folder}")
    return "\n".join(told)


def _record(
    path: Path, material: str, machine: str, suffix: str, *, force: bool, as_json: bool
) -> None:
    from foldmill_fabricate.coupon import record

    plan, coupon, answers = record.read(path)
    of, on = presets(material, machine)
    found = record.record(plan, coupon, answers, of, on, suffix)
    files = record.save(found, force)
    data = {
        "files": [str(file) for file in files],
        "material": found.material and found.material.slug,
        "machine": found.machine and found.machine.slug,
        "advice": list(found.advice),
    }
    say(as_json, data, "\n".join([*_lines(found), *(f"written: {file}" for file in files)]))


def _lines(found: Recorded) -> list[str]:
    lines = []
    if found.material:
        state = "tested" if found.material.tested else "still untested"
        lines.append(f"material {found.material.slug}: {state}; plan with it from now on")
    if found.machine:
        axes, off = found.machine.axes, found.machine.two_sides
        lines.append(
            f"machine {found.machine.slug}: scale {axes.scale_x:.5f}, {axes.scale_y:.5f}, skew "
            f"{axes.skew:.3f}°, a flipped sheet lies {off.dx:+.2f}, {off.dy:+.2f} mm off"
        )
    return [*lines, *found.advice]
