"""The page on materials and machines, made from the models and presets themselves.

``page`` puts together what people read: the table of which machine makes a fold of which material,
one fold in section for each process, and every field with its unit and meaning.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from pydantic import BaseModel

from foldmill import Assignment, Fold
from foldmill_fabricate import machines, materials, presets
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.materials.processes import AnyScore
from foldmill_fabricate.pictures.section import section_picture
from foldmill_fabricate.plan import make

SECTIONS: tuple[tuple[str, str], ...] = (
    ("pp-0.75", "half-cut"),
    ("card-250", "crease-wheel"),
    ("paper-80-120", "stylus"),
    ("paper-80-120", "perforation"),
    ("pp-0.8", "v-score"),
)
"""Material and process of each picture."""

INTRODUCTION = """# Materials and machines

A material says how it is creased and parted: each process with the tool's depth, force, speed and
repeats, which face of the fold carries the groove, and where every value comes from. A machine says
which processes it offers, with what force, up to which thickness. `foldmill plan` takes the first
process of the material that the machine can do, or says what is missing and what would work;
`--score` and `--outline` choose another. `--to places` draws where planning found something.

`--copies 6` or `--grid 3x2` make several parts of one blank: turned alike, the material's
`part_clearance` apart, numbered row by row from the lower left, one cut out after the other. What
does not fit is refused with the missing millimetres, how many would fit, and the smallest blank
that works.

    foldmill materials --show pp-0.75
    foldmill plan stool.fold --material card-250 --machine flatbed-wheel-knife -o job
    foldmill plan stool.fold --score half-cut --outline score-and-snap --to svg,places -o job
    foldmill plan star.fold --grid 2x2 -o job

**No value was tried on hardware.** All materials are marked untested and all machines unverified:
cut a piece of waste before a sheet.

Presets of your own are files `materials/SLUG.toml` and `machines/SLUG.toml` in
`$XDG_CONFIG_HOME/foldmill` (on Windows `%APPDATA%\\foldmill`, by default `~/.config/foldmill`);
the shipped ones are the pattern to copy. Plugins offer theirs through the hooks
`foldmill_materials` and `foldmill_machines`. A wrong field is refused with its line and the reason.
"""


def page(fold: Fold) -> str:
    """Return the whole page; fold : what the table of all machines and materials plans."""
    return "\n".join([INTRODUCTION, table(fold), sections(), relief(), fields()])


def table(fold: Fold) -> str:
    """Return what becomes of a fold on every machine of every material."""
    about = (
        f"What planning says of the stool (tuck, {fold.pattern.count(Assignment.M)} mountains, "
        f"{fold.pattern.count(Assignment.V)} valleys) on a blank of the material's own size: how "
        f"creases and outline are made, or why not."
    )
    lines = [
        "## Every machine with every material",
        "",
        about,
        "",
        "| machine | material | creases | outline | what planning says |",
        "|---|---|---|---|---|",
    ]
    for machine in shipped_machines():
        lines += [row(fold, material, machine) for material in shipped_materials()]
    return "\n".join([*lines, ""])


def row(fold: Fold, material: Material, machine: Machine) -> str:
    """Return one row of that table."""
    try:
        plan = make(fold, material, machine)
    except CannotPlan as refusal:
        return f"| {machine.slug} | {material.slug} | - | - | {refusal} |"
    score, cut = plan.material.score, plan.material.cut
    passes = "both faces" if len(plan.passes) > 1 else f"{plan.passes[0].face} only"
    codes = [f.code for f in plan.findings if f.code != "untested-material"]
    said = ", ".join(sorted(set(codes) - {"unverified-machine"}))
    told = f"a plan, {passes}; {said}" if said else f"a plan, {passes}"
    return f"| {machine.slug} | {material.slug} | {score.kind} | {cut.kind} | {told} |"


def sections() -> str:
    """Return the pictures of one fold for each process, with their words."""
    lines = ["## One fold in section", ""]
    for slug, kind in SECTIONS:
        _, score = _process(slug, kind)
        lines += [f"**{kind}** ({slug}). {_doc(type(score))}", ""]
        lines += [f"![{kind} in section](pictures/section-{kind}.png)", ""]
    return "\n".join(lines)


def relief() -> str:
    """Return what is said about vertices."""
    return (
        "## Vertices\n\n"
        "Scores stop short of a vertex at which grooves meet. Where grooves of both faces would "
        "still end\nnearer to each other than a web, planning finds an error, and "
        "`--relief needed` cuts a hole there:\nas wide as 2.5 thicknesses, 3 from six creases on, "
        "never less than the material's\n`relief_diameter` and 1.5 mm. `--relief all` does so at "
        "every such vertex.\n"
    )


def fields() -> str:
    """Return every field of both models."""
    parts = ["## Fields", ""]
    parts.append("*Information*: kept for people, nothing computes with it.\n")
    for heading, model in _models():
        parts += [
            f"### {heading}",
            "",
            _doc(model),
            "",
            "| field | unit | meaning |",
            "|---|---|---|",
        ]
        parts += list(_field_rows(model))
        parts.append("")
    return "\n".join(parts)


def pictures() -> Mapping[str, bytes]:
    """Return the pictures of the page by file name."""
    return {
        f"pictures/section-{kind}.png": section_picture(*_process(slug, kind))
        for slug, kind in SECTIONS
    }


def shipped_materials() -> Sequence[Material]:
    """Return the shipped materials by slug."""
    return list(presets.shipped(Material, materials.__name__))


def shipped_machines() -> Sequence[Machine]:
    """Return the shipped machines by slug."""
    return list(presets.shipped(Machine, machines.__name__))


def _process(slug: str, kind: str) -> tuple[Material, AnyScore]:
    material = next(each for each in shipped_materials() if each.slug == slug)
    return material, next(score for score in material.scores if score.kind == kind)


def _models() -> Iterator[tuple[str, type[BaseModel]]]:
    processes = materials.processes
    yield "Material", Material
    for made in (
        processes.HalfCut,
        processes.CreaseWheel,
        processes.Stylus,
        processes.Perforation,
        processes.VScore,
        processes.PenLine,
        processes.ThroughCut,
        processes.ScoreAndSnap,
        processes.PenOutline,
    ):
        name = getattr(made, "known_as", made.model_fields["kind"].default)
        yield f"Process {name}", made
    yield "Holes", materials.Holes
    yield "Machine", Machine
    for name, field in Machine.model_fields.items():
        part = field.annotation
        if isinstance(part, type) and issubclass(part, BaseModel):
            yield f"Machine: {name.replace('_', ' ')}", part


def _field_rows(model: type[BaseModel]) -> Iterator[str]:
    for name, field in model.model_fields.items():
        extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
        about = " ".join((field.description or "").split())
        kept = "*Information*. " if "x-information" in extra else ""
        yield f"| `{name}` | {presets.unit_of(field)} | {kept}{about} |"


def _doc(model: type[BaseModel]) -> str:
    return " ".join((model.__doc__ or "").split())
