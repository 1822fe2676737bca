"""Find plugins. One broken plugin never hides the others, and everybody learns whose it is.

Every hook but ``foldmill_hookspecs`` returns values with a ``slug``; a slug is unique per hook.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from types import ModuleType
from typing import Any

import pluggy

from foldmill import hooks
from foldmill.design import Design
from foldmill.errors import PluginFault, UnknownName

_DESIGNS = "foldmill_designs"
_HOOKSPECS = "foldmill_hookspecs"


@dataclass(frozen=True)
class BrokenPlugin:
    """A plugin that could not be loaded: its entry point, its owner and what it said."""

    name: str
    distribution: str
    error: Exception

    def __str__(self) -> str:
        said = f"{type(self.error).__name__}: {self.error}"
        return f"The plugin {self.name!r} of {self.distribution} is broken: {said}"


@dataclass(frozen=True)
class Offer:
    """One value of one hook, and who offers it."""

    value: Any
    plugin: str
    owner: str


@dataclass(frozen=True)
class Registry:
    """What the installed plugins offer, by hook and slug."""

    offers: dict[str, dict[str, Offer]] = field(default_factory=dict)
    broken: list[BrokenPlugin] = field(default_factory=list)

    def of(self, hook: str) -> dict[str, Any]:
        """Return slug → value of one hook, sorted by slug."""
        return {slug: offer.value for slug, offer in sorted(self.offers.get(hook, {}).items())}

    @property
    def designs(self) -> dict[str, Design[Any]]:
        """All families by slug."""
        return self.of(_DESIGNS)

    def get(self, hook: str, kind: str, slug: str) -> Any:
        """Return the value with that slug; raises UnknownName, naming broken plugins as well."""
        offers = self.of(hook)
        if slug in offers:
            return offers[slug]
        error = UnknownName.of(kind, slug, offers)
        hint = " ".join(str(broken) for broken in self.broken)
        raise UnknownName(f"{error} {hint}".strip())

    def design(self, slug: str) -> Design[Any]:
        """Return a family; raises UnknownName."""
        design: Design[Any] = self.get(_DESIGNS, "family", slug)
        return design


@cache
def installed() -> Registry:
    """Load what is installed, once per process."""
    return load(sorted(entry_points(group=hooks.PROJECT), key=lambda point: point.name))


def load(points: Iterable[EntryPoint]) -> Registry:
    """Load the given entry points, each alone."""
    registry = Registry()
    modules: list[tuple[EntryPoint, str, Any]] = []
    specs: list[ModuleType] = [hooks]
    for point in points:
        owner = point.dist.name if point.dist else "an unknown distribution"
        try:
            module = point.load()
            specs += getattr(module, _HOOKSPECS, tuple)()
        except Exception as error:  # a plugin may fail in any way it likes
            registry.broken.append(BrokenPlugin(point.name, owner, error))
        else:
            modules.append((point, owner, module))
    for point, owner, module in modules:
        try:
            _admit(registry, point.name, owner, _collect(module, point.name, specs))
        except Exception as error:
            registry.broken.append(BrokenPlugin(point.name, owner, error))
    return registry


def _collect(module: Any, name: str, specs: Iterable[ModuleType]) -> list[tuple[str, Any]]:
    manager = pluggy.PluginManager(hooks.PROJECT)
    for spec in specs:
        manager.add_hookspecs(spec)
    manager.register(module, name=name)
    manager.check_pending()  # a misspelt hook is an error, not silence
    found = []
    for caller in manager.get_hookcallers(module) or []:
        for group in caller():
            if not isinstance(group, Iterable):
                raise PluginFault(f"{caller.name} returned {type(group).__name__}, not a list")
            found += [(caller.name, value) for value in group]
    if not found:  # pluggy drops None, so a forgotten return would pass unseen
        raise PluginFault("it offers nothing; does each of its hooks return a list?")
    return found


def _admit(registry: Registry, plugin: str, owner: str, found: list[tuple[str, Any]]) -> None:
    admitted: dict[tuple[str, str], Offer] = {}
    for hook, value in found:
        if hook == _HOOKSPECS:
            continue
        slug = getattr(value, "slug", None)
        if not isinstance(slug, str):
            raise PluginFault(f"{hook} returned {type(value).__name__}, which has no slug")
        taken = registry.offers.get(hook, {}).get(slug)
        if taken:
            raise PluginFault(f"the slug {slug!r} is taken by {taken.owner} ({taken.plugin})")
        if (hook, slug) in admitted:
            raise PluginFault(f"the slug {slug!r} is offered twice")
        admitted[hook, slug] = Offer(value, plugin, owner)
    for (hook, slug), offer in admitted.items():  # all or nothing
        registry.offers.setdefault(hook, {})[slug] = offer
