"""From a fold to a job folder, and the proof that it is right: plan, verify."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from foldmill import FoldmillError
from foldmill_fabricate.cli.account import describe, next_steps
from foldmill_fabricate.cli.choices import (
    BlankSize,
    CarrierSize,
    DxfChoice,
    FlipChoice,
    FlipKind,
    Folder,
    Formats,
    MachineSlug,
    MaterialSlug,
    ProcessChoice,
    RegistrationChoice,
    ReliefChoice,
    ScoreProcess,
    UnassignedChoice,
    counts,
    size,
    temperatures,
)
from foldmill_fabricate.cli.importing import PatternFile, imported, with_file_options
from foldmill_fabricate.cli.output import AsJson, exit_code, finding_data, say

if TYPE_CHECKING:
    from foldmill_fabricate.machines import Machine
    from foldmill_fabricate.materials import Material


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    app.command()(plan)
    app.command()(verify)


@with_file_options
def plan(
    file: PatternFile,
    output: Annotated[Path, typer.Option("-o", "--output", help="The job folder to write.")],
    material: MaterialSlug = "pp-0.75",
    machine: MachineSlug = "generic-hpgl-600",
    blank: BlankSize = None,
    carrier: CarrierSize = None,
    flip: FlipKind = FlipChoice.LEFT_RIGHT,
    unassigned: Annotated[
        UnassignedChoice | None, typer.Option(help="Where unassigned creases are scored.")
    ] = None,
    score: ScoreProcess = None,
    outline: Annotated[
        ProcessChoice | None,
        typer.Option(help="How the outline is made; default: the first the machine can do."),
    ] = None,
    relief: Annotated[
        ReliefChoice, typer.Option(help="Which vertices get a hole in which grooves end.")
    ] = ReliefChoice.NONE,
    copies: Annotated[
        int, typer.Option(min=1, help="How many copies on the blank, in the grid that suits it.")
    ] = 1,
    grid: Annotated[
        str | None, typer.Option(help="COLUMNSxROWS of copies, instead of --copies.")
    ] = None,
    registration: Annotated[
        RegistrationChoice,
        typer.Option(help="What keeps the faces in register; the machine must be able to."),
    ] = RegistrationChoice.HOLES,
    temperature: Annotated[
        str | None,
        typer.Option(help="FRONT,REVERSE: °C of the sheet at both passes, as 21,24."),
    ] = None,
    pen: Annotated[
        list[str] | None,
        typer.Option(
            help="Of an HP-GL drawing: PEN=score, cut, inner or skip; for each of its pens."
        ),
    ] = None,
    to: Formats = None,
    options: Any = None,
    profile: Annotated[
        str, typer.Option(help="Names and colours of the drawings' layers: a name or a TOML file.")
    ] = "foldmill",
    dxf: Annotated[DxfChoice, typer.Option(help="Which DXF: R12 for old software.")] = (
        DxfChoice.R2000
    ),
    as_json: AsJson = False,
) -> None:
    """Plan both faces of the sheet and write programs, drawings and job sheet into a folder."""
    from foldmill_fabricate import folder, profiles
    from foldmill_fabricate.cli import drawings
    from foldmill_fabricate.foreign import write_drawing
    from foldmill_fabricate.importing.reading import require_answers
    from foldmill_fabricate.plan import make
    from foldmill_fabricate.profiles import Style

    chosen_material, chosen_machine = presets(material, machine)
    formats = formats_for(to, chosen_machine)
    look = Style(profiles.find(profile), "R12" if dxf is DxfChoice.R12 else "R2000")
    asked: dict[str, Any] = {"score": score and score.value, "cut": outline and outline.value}
    asked |= {"blank": None if blank is None else size(blank, "--blank")}
    asked |= {"carrier": None if carrier is None else size(carrier, "--carrier")}
    if drawings.is_drawing(file):
        others = (unassigned, grid, temperature, relief.value != "none", copies > 1)
        drawings.refuse_options(any(others), registration.value != "holes", options)
        drawn = drawings.planned(file, pen or [], chosen_material, chosen_machine, asked)
        written = write_drawing(drawn, output, formats, look)
        told = f"{describe(written)}\n{next_steps(written, output)}"
        say(as_json, written.model_dump(mode="json"), told)
        return
    drawings.refuse_pens(pen or [])
    found = imported(file, options)
    require_answers(found, str(file))
    fold = found.fold
    made = make(
        fold,
        chosen_material,
        chosen_machine,
        **asked,
        flip=flip.value,
        unassigned=None if unassigned is None else unassigned.value,
        relief=relief.value,
        copies=copies,
        grid=None if grid is None else counts(grid, "--grid"),
        register=registration.value,
        temperatures=None if temperature is None else temperatures(temperature),
    )
    written = folder.write(fold, made, output, formats, look)
    data = {**written.model_dump(mode="json"), "quantity": written.quantity}
    data["figures"]["travel_gap"] = written.figures.travel_gap
    say(as_json, data, f"{describe(written)}\n{next_steps(written, output)}")
    exit_code(written.findings)


def formats_for(to: str | None, machine: Machine) -> list[str]:
    """Return the formats asked for, by default what the machine can use."""
    if to is None:
        from foldmill_fabricate.writers import usual_formats

        return usual_formats(machine)
    formats = [name.strip() for name in to.split(",") if name.strip()]
    if not formats:
        raise FoldmillError("--to names no format; write some of svg,dxf,hpgl.")
    return formats


def verify(
    path: Folder,
    picture: Annotated[
        Path | None, typer.Option(help="Draw what is missing, extra or moved into this PNG.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Replay a job folder on a virtual sheet and derive its plan again."""
    from foldmill_fabricate.verify import read_folder, report, verify_files

    if picture is not None and picture.suffix.lower() != ".png":
        raise FoldmillError(f"--picture writes a PNG; name it {picture.stem}.png.")
    files = read_folder(path)
    found = verify_files(files)
    if picture is not None:
        from foldmill_fabricate.files import write_all
        from foldmill_fabricate.pictures.faults import faults_picture

        write_all(picture.parent, {picture.name: faults_picture(files.plan, found)})
    data = {
        "ok": found.ok,
        "figures": asdict(found.figures),
        "findings": finding_data(found.findings),
    }
    say(as_json, data, report(found))
    exit_code(found.findings)


def presets(material: str, machine: str) -> tuple[Material, Machine]:
    """Return material and machine by slug; raises UnknownName."""
    from foldmill_fabricate import shelf

    return shelf.material(material), shelf.machine(machine)
