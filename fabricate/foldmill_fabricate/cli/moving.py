"""How a form moves: the command motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from foldmill import FoldmillError, UnknownName
from foldmill.finding import Severity
from foldmill_fabricate.cli.importing import load
from foldmill_fabricate.cli.output import AsJson, finding_lines, say

if TYPE_CHECKING:
    from foldmill import Fold
    from foldmill.motion import Motion

MOST_STEPS = 1000


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    settings = {"allow_extra_args": True, "ignore_unknown_options": True}
    app.command(context_settings=settings)(motion)


def motion(
    context: typer.Context,
    source: Annotated[str, typer.Argument(help="A family, or a FILE.fold that a family made.")],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="FILE.fold (frames), .glb (morph targets), .gif or .webp; by suffix. "
            "With --dihedral .csv .png or .svg.",
        ),
    ],
    preset: Annotated[str | None, typer.Option(help="Start from a preset of the family.")] = None,
    params: Annotated[Path | None, typer.Option(help="Parameters from a TOML file.")] = None,
    name: Annotated[
        str | None, typer.Option("--motion", help="Which motion; default: the first.")
    ] = None,
    steps: Annotated[int, typer.Option(help="Steps from start to end.")] = 24,
    dihedral: Annotated[
        int | None,
        typer.Option(help="Write the dihedral angles at this vertex of the pattern instead."),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Write it even where it does not fold; it is marked.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Write how a form moves: foldmill motion FAMILY [--PARAM V]… --steps N -o FILE."""
    from foldmill.check.motion import scan
    from foldmill_fabricate.files import write_whole

    if not 1 <= steps <= MOST_STEPS:
        raise FoldmillError(f"--steps must be from 1 to {MOST_STEPS}, not {steps}.")
    fold = _marked(_fold(source, preset, params, context.args), force)
    moving = _motion(fold, name)
    if dihedral is not None:
        _angles(fold, moving, dihedral, steps, output, as_json)
        return
    write_whole(output, _bytes(fold, moving, steps, output))
    seen = scan(fold, moving, steps)
    data = {
        "motion": moving.name,
        "reach": moving.reach,
        "reason": moving.reason,
        "free_until": seen.free_until,
        "penetrating_faces": seen.faces,
    }
    stops = f" It stops at t = {moving.reach:g}: {moving.reason}" if moving.reason else ""
    free = (
        f" No facet passes through another at the {seen.looked_at} places looked at."
        if seen.is_free
        else f" Facets {seen.faces} pass through each other from t = {seen.free_until:.4f} on."
    )
    say(as_json, data, f"{output}: {moving.title}, {steps} steps.{stops}{free}")


def _marked(fold: Fold, force: bool) -> Fold:
    """Refuse a form that does not fold, unless it is wanted all the same; then it is marked."""
    from foldmill.check import check
    from foldmill.exchange.marking import marked

    found = [each for each in check(fold).findings if each.severity is Severity.ERROR]
    if found and not force:
        typer.echo(finding_lines(found))
        typer.echo("It does not fold, so nothing is written; --force writes it, marked.", err=True)
        raise typer.Exit(1)
    return marked(fold, found)


def _angles(fold: Fold, moving: Motion, vertex: int, steps: int, file: Path, as_json: bool) -> None:
    """Write the dihedral angles of a vertex along a motion, as a table or as a plot."""
    import numpy as np

    from foldmill.dihedral import dihedral_angles
    from foldmill.exchange.angles import dihedral_csv
    from foldmill_fabricate.files import write_whole
    from foldmill_fabricate.pictures import angles_picture

    suffix = file.suffix.lower()
    if suffix not in {".csv", ".png", ".svg"}:
        raise FoldmillError(f"{file}: dihedral angles are written as .csv .png or .svg.")
    angles = dihedral_angles(fold, moving, vertex, np.linspace(0.0, moving.reach, steps + 1))
    if not angles.names:
        raise FoldmillError(
            f"Vertex {vertex} has no crease, only edges of the outline; take one inside."
        )
    as_table = suffix == ".csv"
    written = dihedral_csv(angles, moving).encode() if as_table else b""
    write_whole(file, written or angles_picture(angles, moving, suffix))
    stop = {"reach": moving.reach, "reason": moving.reason}
    rows = {"t": angles.times.tolist(), "creases": angles.names, "deg": angles.angles.tolist()}
    stops = f" It stops at t = {moving.reach:g}: {moving.reason}" if moving.reason else ""
    said = f"{file}: creases at vertex {vertex}: {len(angles.names)}, {steps} steps.{stops}"
    say(as_json, {"motion": moving.name, "vertex": vertex, **stop, **rows}, said)


def _fold(source: str, preset: str | None, params: Path | None, options: list[str]) -> Fold:
    """Return the fold with its motions, made anew where it comes from a file."""
    from foldmill import installed
    from foldmill_fabricate.cli.parameters import gather

    if not source.endswith(".fold"):
        offered = installed().design(source)
        return offered.run(gather(offered, preset, params, options))
    if preset or params or options:
        raise FoldmillError("A FILE.fold has its parameters in it; name a family to change them.")
    made = load(Path(source)).meta.get("design")
    if not made:
        raise FoldmillError(f"{source} was not made by a family, so how it moves is not known.")
    return installed().design(made["slug"]).run(made["params"])


def _motion(fold: Fold, name: str | None) -> Motion:
    if not fold.motions:
        raise FoldmillError("This form has no motion that is known.")
    chosen = name or next(iter(fold.motions))
    if chosen not in fold.motions:
        raise UnknownName.of("motion", chosen, fold.motions)
    return fold.motions[chosen]


def _bytes(fold: Fold, moving: Motion, steps: int, file: Path) -> bytes:
    from foldmill.exchange import fold as fold_file
    from foldmill.exchange.glb import write_motion
    from foldmill.exchange.motion import with_frames
    from foldmill_fabricate.pictures import motion_picture

    suffix = file.suffix.lower()
    if suffix == ".fold":
        return fold_file.write(with_frames(fold, moving, steps)).encode()
    if suffix in {".gif", ".webp"}:
        return motion_picture(fold, moving, steps, suffix)
    if suffix == ".glb":
        return write_motion(fold, moving, steps)
    raise FoldmillError(f"{file}: a motion is written as .fold .glb .gif or .webp.")
