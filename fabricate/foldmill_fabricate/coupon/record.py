"""Turn what was read from a coupon into a tested material and a measured machine of the user's."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from pydantic import ValidationError

from foldmill.errors import InvalidInput, UnreadableFile
from foldmill.refusals import explain
from foldmill_fabricate import presets
from foldmill_fabricate.config import config_folder
from foldmill_fabricate.coupon.answers import NAME, Answers, plain
from foldmill_fabricate.coupon.readings import Found, measure
from foldmill_fabricate.files import write_whole
from foldmill_fabricate.ladders import Coupon, LadderKind
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, Perforation
from foldmill_fabricate.names import PLAN
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import relief
from foldmill_fabricate.presets_text import written

P = TypeVar("P", Material, Machine)
NAMEABLE = re.compile(r"\w[\w.-]*")
SCORES: tuple[LadderKind, ...] = ("depth", "force", "repeats", "gap")
"""Ladders that say how a score is made."""


@dataclass(frozen=True)
class Recorded:
    """What was made of the answers."""

    material: Material | None
    """None where nothing was read of the material."""
    machine: Machine | None
    """None where nothing was read of the machine."""
    advice: tuple[str, ...]
    """Sentences on what to do next."""


def read(path: Path) -> tuple[Plan, Coupon, Answers]:
    """Read a coupon's folder, or the answers in it; raises UnreadableFile with line and reason."""
    file = path / NAME if path.is_dir() else path
    plan = _plan(file.parent / PLAN)
    if plan.coupon is None:
        raise UnreadableFile(f"{file.parent} holds the job of a fold, not a coupon's.")
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UnreadableFile(f"{file} cannot be read: {error}.") from None
    return plan, plan.coupon, presets.read(Answers, text, str(file))


def _plan(path: Path) -> Plan:
    try:
        return Plan.model_validate_json(path.read_bytes())
    except OSError as error:
        raise UnreadableFile(
            f"{path}: {error.strerror}. Answers are read beside the plan.json of their coupon."
        ) from None
    except ValidationError as error:
        raise UnreadableFile(f"{path} is no plan: {explain(error)}") from None


def record(
    plan: Plan, coupon: Coupon, answers: Answers, material: Material, machine: Machine, suffix: str
) -> Recorded:
    """Return the presets that follow from a coupon; nothing is written.

    material, machine : what the coupon was made of and on; suffix : what their slugs get, unless
    they end so. Raises InvalidInput for another material or machine, for a value that is no rung
    of its ladder, for readings that cannot be right, and for a suffix that no file can be named by.
    """
    if not NAMEABLE.fullmatch(suffix):
        raise InvalidInput(
            f"--suffix becomes a part of a file's name: take letters, digits and hyphens, such as "
            f"mine, not {suffix!r}."
        )
    for what, given, made in (
        ("material", material.slug, plan.material.slug),
        ("machine", machine.slug, plan.machine.slug),
    ):
        if given != made:
            raise InvalidInput(
                f"This coupon was made with the {what} {made}, not {given}: record it with "
                f"--{what} {made}."
            )
    chosen = _chosen(coupon, answers)
    off = measure(plan, coupon, answers)
    tested = _material(plan, answers, chosen, material, suffix)
    measured = _machine(plan, answers, off, machine, suffix)
    if tested is None and measured is None:
        raise InvalidInput("Nothing was answered: take away the # in front of what you have read.")
    return Recorded(tested, measured, tuple(_advice(plan, chosen, tested, measured)))


def save(recorded: Recorded, force: bool) -> list[Path]:
    """Write the presets into the user's config folder; return their files.

    Raises InvalidInput, and writes nothing, where one is there already and force is not given.
    """
    texts = {}
    for kind, preset in (("materials", recorded.material), ("machines", recorded.machine)):
        if preset is not None:
            path = config_folder() / kind / f"{preset.slug}.toml"
            texts[path] = written(preset, f"{preset.provenance}")
    there = [str(path) for path in texts if path.exists()]
    if there and not force:
        raise InvalidInput(
            f"{' and '.join(there)} would be written over. Say --force to do so, or --suffix for "
            f"another name."
        )
    for path, text in texts.items():
        write_whole(path, text.encode())
    return list(texts)


def _chosen(coupon: Coupon, answers: Answers) -> dict[LadderKind, float]:
    """Return the rungs that were read as best, each of which stands on the coupon."""
    ladders = {ladder.kind: [rung.value for rung in ladder.rungs] for ladder in coupon.ladders}
    found: dict[LadderKind, float] = {}
    best: dict[LadderKind, float | None] = {
        "depth": answers.best.depth,
        "force": answers.best.force,
        "repeats": answers.best.repeats,
        "gap": answers.best.gap,
        "spacing": answers.best.spacing,
        "relief": answers.best.relief,
    }
    for kind, value in best.items():
        if value is None:
            continue
        if kind not in ladders:
            raise InvalidInput(f"best.{kind} was answered, and this coupon has no {kind} ladder.")
        if all(abs(value - rung) > 1e-6 for rung in ladders[kind]):
            rungs = ", ".join(f"{rung:g}" for rung in ladders[kind])
            raise InvalidInput(
                f"best.{kind} is {value:g}, which is no rung of the ladder: {rungs}."
            )
        found[kind] = value
    return found


def _named(slug: str, suffix: str) -> str:
    return slug if slug.endswith(f"-{suffix}") else f"{slug}-{suffix}"


def _material(
    plan: Plan,
    answers: Answers,
    chosen: dict[LadderKind, float],
    material: Material,
    suffix: str,
) -> Material | None:
    hinge = answers.hinge
    if not chosen and hinge.at_90 is None and hinge.at_180 is None:
        return None
    kind, source = plan.material.score.kind, plain(answers)
    made = next(score for score in material.scores if score.kind == kind)
    changed, fields = _score_changes(plan, chosen)
    score = made.model_copy(update=changed)
    update: dict[str, object] = {"score" if made is material.score else "other_scores": score}
    if made is not material.score:
        others = tuple(score if each is made else each for each in material.other_scores)
        update["other_scores"] = others
    if "relief" in chosen:
        update["relief_diameter"] = chosen["relief"]
    opened = [each for each in (hinge.at_90, hinge.at_180) if each is not None]
    if opened:
        update |= {"springback_min": min(opened), "springback_max": max(opened)}
    named = [f"{made.kind}.{field}" for field in fields]
    named += ["relief_diameter"] * ("relief" in chosen)
    named += ["springback_min", "springback_max"] * bool(opened)
    is_tested = any(ladder in chosen for ladder in SCORES) or bool(opened)
    update |= {
        "slug": _named(material.slug, suffix),
        "title": material.title,
        "sources": material.sources | dict.fromkeys(named, source),
        "provenance": f"{source[:1].upper()}{source[1:]}, made on {plan.machine.slug} by "
        f"{made.title}. What the coupon does not show is as before: {material.provenance}",
        "tested": is_tested or material.tested,
        "tested_by": answers.read_by,
        "tested_on": answers.read_on,
    }
    return _checked(material, update)


def _score_changes(
    plan: Plan, chosen: dict[LadderKind, float]
) -> tuple[dict[str, object], list[str]]:
    """Return the changed fields of a score, and the names of those that the coupon showed."""
    score = plan.material.score
    changed: dict[str, object] = {}
    if "depth" in chosen:
        changed["exposure"] = chosen["depth"]
        ratio = getattr(score, "depth_ratio", None)
        if ratio is not None:
            deep = round(ratio * chosen["depth"] / score.exposure, 4)
            changed["depth_ratio"] = deep
            changed["depth_ratio_min"] = min(deep, score.depth_ratio_min)  # type: ignore[union-attr]
            changed["depth_ratio_max"] = max(deep, score.depth_ratio_max)  # type: ignore[union-attr]
    if "force" in chosen:
        changed["force"] = chosen["force"]
        if chosen["force"] < score.force_needed:
            changed["force_needed"] = chosen["force"]
    if "repeats" in chosen:
        changed["repeats"] = int(chosen["repeats"])
    if "gap" in chosen:
        changed["gap"] = chosen["gap"]
    if "spacing" in chosen:
        changed["min_spacing"] = chosen["spacing"]
    return changed, [name for name in changed if not name.startswith("depth_ratio_m")]


def _machine(
    plan: Plan, answers: Answers, off: Found, machine: Machine, suffix: str
) -> Machine | None:
    source, bars = plain(answers), answers.bars
    scaled = {"scale_x": bars.ab, "scale_y": bars.ad, "skew": bars.ac and bars.bd}
    shown = [name for name, value in scaled.items() if value]
    if not shown and off.dx is None and off.dy is None:
        return None
    axes = machine.axes.model_copy(update={name: getattr(off, name) for name in scaled})
    update: dict[str, object] = {"axes": axes, "slug": _named(machine.slug, suffix)}
    named = [f"axes.{name}" for name in shown]
    if off.dx is not None or off.dy is not None:
        before = plan.machine.two_sides
        same = before.flip == plan.flip.kind
        changes = {
            "dx": off.dx if off.dx is not None else before.dx * same,
            "dy": off.dy if off.dy is not None else before.dy * same,
            "angle": before.angle * same,
            "flip": plan.flip.kind,
            "measured": source,
        }
        update["two_sides"] = machine.two_sides.model_copy(update=changes)
        named += ["two_sides.dx"] * (off.dx is not None) + ["two_sides.dy"] * (off.dy is not None)
    update["sources"] = machine.sources | dict.fromkeys(named, source)
    update["provenance"] = (
        f"Measured: {source}, of {plan.material.slug}. All else is as before: {machine.provenance}"
    )
    return _checked(machine, update)


def _checked(preset: P, update: dict[str, object]) -> P:
    """Return a changed preset, validated again; raises InvalidInput with the reason."""
    changed = preset.model_copy(update=update)
    try:
        return type(preset).model_validate(changed.model_dump())
    except ValidationError as error:
        raise InvalidInput(f"What was read cannot be: {explain(error)}") from None


def _advice(
    plan: Plan,
    chosen: dict[LadderKind, float],
    material: Material | None,
    machine: Machine | None,
) -> list[str]:
    made = plan.material.score
    force = plan.machine.tools.force(made.force)
    now = {"depth": made.exposure, "force": force, "repeats": made.repeats}
    now |= {"gap": made.gap} if isinstance(made, Perforation) else {}
    moved = [kind for kind, value in now.items() if chosen.get(kind, value) != value]  # type: ignore[call-overload]
    notes = []
    if len(moved) > 1:
        notes.append(
            f"{' and '.join(moved)} were each tried by themselves: make one more coupon of "
            f"{material.slug if material else plan.material.slug} to see them together."
        )
    if material is not None and "relief" in chosen:
        rule = relief.diameter(plan.coupon.degree if plan.coupon else 4, material)
        if rule > chosen["relief"]:
            notes.append(
                f"Holes that --relief asks for stay {rule:g} mm wide, the least for this thickness."
            )
    if machine is not None and machine.two_sides.is_known:
        notes.append(
            "The offset of the two sides holds as long as the sheet is turned and laid in the same "
            "way, on the same place of the mat."
        )
    return notes
