"""What answers, and what there is to choose from: families, materials, machines."""

from __future__ import annotations

from typing import Any, Literal

from foldmill_fabricate.service.models.wire import Wire


class About(Wire):
    """What answers."""

    name: Literal["foldmill"] = "foldmill"
    version: str
    tokens: bool
    """Whether requests need a token."""
    scope: str
    """What this request's token allows: view, submit or operate."""


class Health(Wire):
    """Whether the service can work."""

    ok: bool
    computing: int
    """Pieces of work under way in other processes."""
    waiting: int
    """Pieces of work that wait for a process."""


class FamilyRow(Wire):
    """A family of patterns."""

    slug: str
    title: str
    presets: tuple[str, ...]
    owner: str
    """The distribution that offers it."""


class Family(FamilyRow):
    """A family with its parameters."""

    references: tuple[str, ...]
    parameters: dict[str, Any]
    """JSON schema of the parameters; ``x-unit`` beside every quantity."""
    values: dict[str, dict[str, Any]]
    """The parameters of each preset; those of "" are the defaults."""


class PresetRow(Wire):
    """A material or a machine."""

    slug: str
    title: str
    provenance: str
    """Where its values come from, and who tested them."""
    owner: str
    """The distribution that offers it; a preset of the user's own says so."""


class FieldRow(Wire):
    """One field of a preset, for people."""

    name: str
    """Dotted, such as half-cut.force."""
    value: str
    unit: str
    about: str
    source: str


class PresetPage(PresetRow):
    """A material or a machine with all its fields."""

    fields: tuple[FieldRow, ...]
    preset: dict[str, Any]
    """As its TOML file states it."""
