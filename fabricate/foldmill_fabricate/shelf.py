"""Materials and machines by slug: those of plugins, and the user's own.

A user's presets lie as ``materials/SLUG.toml`` and ``machines/SLUG.toml`` in foldmill's config
folder: ``$XDG_CONFIG_HOME/foldmill``, on Windows ``%APPDATA%\\foldmill``, by default
``~/.config/foldmill``. They look like the shipped ones. A file that cannot be read is told of when
it is asked for and when presets are listed; it hides no other.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple, TypeVar

from pydantic import BaseModel

from foldmill import FoldmillError, installed
from foldmill.errors import UnknownName, UnreadableFile
from foldmill_fabricate import presets
from foldmill_fabricate.config import config_folder
from foldmill_fabricate.hooks import MACHINES, MATERIALS
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material

P = TypeVar("P", Material, Machine)
_KINDS: dict[type, tuple[str, str]] = {
    Material: (MATERIALS, "material"),
    Machine: (MACHINES, "machine"),
}


class Shelf(NamedTuple):
    """What there is of one kind: by slug, with its owner; and sentences on unreadable files."""

    presets: Mapping[str, Material | Machine]
    owners: dict[str, str]
    broken: tuple[str, ...]


def material(slug: str) -> Material:
    """Return a material; raises UnknownName, or UnreadableFile for a broken file of the user's."""
    return _find(Material, slug)


def machine(slug: str) -> Machine:
    """Return a machine; raises UnknownName, or UnreadableFile for a broken file of the user's."""
    return _find(Machine, slug)


def everything(model: type[P]) -> Shelf:
    """Return all presets of a kind, plugins' first, and what could not be read."""
    hook, _ = _KINDS[model]
    offers = installed().offers.get(hook, {})
    found = {slug: offer.value for slug, offer in sorted(offers.items())}
    owners = {slug: offer.owner for slug, offer in sorted(offers.items())}
    broken: list[str] = []
    for path in sorted(_folder(model).glob("*.toml")):
        try:
            found[path.stem] = _find(model, path.stem)
            owners[path.stem] = str(path)
        except FoldmillError as error:
            broken.append(str(error))
    return Shelf(found, owners, tuple(broken))


def _find(model: type[P], slug: str) -> P:
    hook, kind = _KINDS[model]
    path = _folder(model) / f"{slug}.toml"
    if path.name == f"{slug}.toml" and path.is_file():
        return _own(model, path)
    registry = installed()
    offers: dict[str, P] = registry.of(hook)
    if slug in offers:
        return offers[slug]
    known = [*offers, *(each.stem for each in _folder(model).glob("*.toml"))]
    hint = " ".join(str(each) for each in registry.broken)
    raise UnknownName(f"{UnknownName.of(kind, slug, known)} {hint}".strip())


def _folder(model: type[BaseModel]) -> Path:
    return config_folder() / f"{_KINDS[model][1]}s"


def _own(model: type[P], path: Path) -> P:
    """Read a user's preset; its slug is its file's name, and no plugin's."""
    hook, kind = _KINDS[model]
    offers = installed().offers.get(hook, {})
    if path.stem in offers:
        raise UnreadableFile(
            f"{path}: the {kind} {path.stem!r} is offered by {offers[path.stem].owner}. Give the "
            f"file and its slug another name."
        )
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UnreadableFile(f"{path} cannot be read: {error}.") from None
    found = presets.read(model, text, str(path))
    if found.slug != path.stem:
        raise UnreadableFile(
            f"{path}: its slug is {found.slug!r}. Name the file {found.slug}.toml, so that it is "
            f"found by its slug."
        )
    return found
