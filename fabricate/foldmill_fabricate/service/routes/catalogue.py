"""What there is: families, materials, machines."""

from __future__ import annotations

from importlib.metadata import version
from typing import Annotated, TypeVar

from fastapi import APIRouter, Path, Request

from foldmill import Design, installed
from foldmill.errors import UnknownName
from foldmill_fabricate import shelf
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.presets import Sourced, rows, shown
from foldmill_fabricate.service.callers import Viewer
from foldmill_fabricate.service.models import (
    About,
    Family,
    FamilyRow,
    FieldRow,
    PresetPage,
    PresetRow,
)
from foldmill_fabricate.service.problems import NoSuch
from foldmill_fabricate.service.routes.answers import READING

ROUTER = APIRouter(tags=["catalogue"], responses=READING)
Named = Annotated[str, Path(max_length=100, description="A slug.")]
P = TypeVar("P", Material, Machine)


@ROUTER.get("")
def about(request: Request, who: Viewer) -> About:
    """Tell what answers, and what this request's token allows."""
    tokens = request.app.state.policy.tokens is not None
    return About(version=version("foldmill"), tokens=tokens, scope=who.scope.value)


@ROUTER.get("/families")
def families(_: Viewer) -> list[FamilyRow]:
    """List the families of patterns."""
    return [
        FamilyRow(
            slug=slug,
            title=offer.value.title,
            presets=tuple(sorted(offer.value.presets)),
            owner=offer.owner,
        )
        for slug, offer in sorted(installed().offers.get("foldmill_designs", {}).items())
    ]


@ROUTER.get("/families/{slug}")
def family(slug: Named, _: Viewer) -> Family:
    """Tell a family's parameters: schema, defaults, presets."""
    try:
        design: Design[object] = installed().design(slug)  # type: ignore[type-var]
    except UnknownName as error:
        raise NoSuch(str(error)) from None
    presets = {"": design.params(), **design.presets}
    return Family(
        slug=slug,
        title=design.title,
        presets=tuple(sorted(design.presets)),
        owner=installed().offers["foldmill_designs"][slug].owner,
        references=design.references,
        parameters=design.schema(),
        values={name: preset.model_dump(mode="json") for name, preset in presets.items()},  # type: ignore[attr-defined]
    )


@ROUTER.get("/materials")
def materials(_: Viewer) -> list[PresetRow]:
    """List the sheet materials."""
    return _rows(Material)


@ROUTER.get("/materials/{slug}")
def material(slug: Named, _: Viewer) -> PresetPage:
    """Tell every field of a material."""
    return _page(Material, slug)


@ROUTER.get("/machines")
def machines(_: Viewer) -> list[PresetRow]:
    """List the machines."""
    return _rows(Machine)


@ROUTER.get("/machines/{slug}")
def machine(slug: Named, _: Viewer) -> PresetPage:
    """Tell every field of a machine."""
    return _page(Machine, slug)


def _rows(model: type[P]) -> list[PresetRow]:
    every = shelf.everything(model)
    return [_row(slug, preset, every.owners[slug]) for slug, preset in every.presets.items()]


def _row(slug: str, preset: Material | Machine, owner: str) -> PresetRow:
    owner = "a preset of the user's own" if owner.endswith(".toml") else owner  # no path leaves
    return PresetRow(slug=slug, title=preset.title, provenance=preset.provenance, owner=owner)


def _page(model: type[P], slug: str) -> PresetPage:
    every = shelf.everything(model)
    if slug not in every.presets:
        raise NoSuch(str(UnknownName.of(model.__name__.lower(), slug, every.presets)))
    preset = every.presets[slug]
    row = _row(slug, preset, every.owners[slug])
    stated = preset.model_dump(mode="json")
    return PresetPage(**row.model_dump(), fields=_fields(preset), preset=stated)


def _fields(preset: Sourced) -> tuple[FieldRow, ...]:
    return tuple(
        FieldRow(
            name=row.name,
            value=shown(row.value),
            unit=row.unit,
            about=row.about,
            source=preset.sources.get(row.name, ""),
        )
        for row in rows(preset)
    )
