"""Find plugins. One broken plugin never hides the others, and everybody learns whose it is.

Every hook but ``foldmill_hookspecs`` returns values with a ``slug``; a slug is unique per hook.
What foldmill brings itself is loaded first, so that of two claims to a name its own stands.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from types import ModuleType
from typing import Any

import pluggy

from foldmill import hooks
from foldmill.design import Design, require_sound
from foldmill.errors import PluginFault, UnknownName, one_line

_DESIGNS = "foldmill_designs"
_HOOKSPECS = "foldmill_hookspecs"
_FAILURES = (Exception, SystemExit)
"""How a plugin may fail: in any way it likes, but Ctrl-C is the user's."""


@dataclass(frozen=True)
class BrokenPlugin:
    """A plugin that could not be loaded: its entry point, its owner and what it said."""

    name: str
    distribution: str
    error: BaseException

    def __str__(self) -> str:
        return f"The plugin {self.name!r} of {self.distribution} is broken: {one_line(self.error)}"


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
    """Load the given entry points, each alone; those of foldmill's own distribution first."""
    registry = Registry()
    modules: list[tuple[EntryPoint, Any]] = []
    specs: list[ModuleType] = [hooks]
    for point in sorted(points, key=lambda point: _owner(point) != hooks.PROJECT):
        try:
            module = point.load()
            specs += _hookspecs(module, specs)
        except _FAILURES as error:
            registry.broken.append(BrokenPlugin(point.name, _owner(point), error))
        else:
            modules.append((point, module))
    kinds = {hook: kind for spec in specs for hook, kind in _kinds(spec).items()}
    for point, module in modules:
        try:
            found = _collect(module, point.name, specs)
            _admit(registry, point.name, _owner(point), found, kinds)
        except _FAILURES as error:
            registry.broken.append(BrokenPlugin(point.name, _owner(point), error))
    return registry


def _owner(point: EntryPoint) -> str:
    return (point.dist.name if point.dist else None) or "an unknown distribution"


def _hookspecs(module: Any, known: list[ModuleType]) -> list[ModuleType]:
    """Return the modules of hookspecs a plugin brings; raises PluginFault for what is none."""
    stated: Any = getattr(module, _HOOKSPECS, list)()
    if not isinstance(stated, Iterable):
        raise PluginFault(f"{_HOOKSPECS} returned {type(stated).__name__}, not a list")
    brought = list(stated)
    for spec in brought:
        if not isinstance(spec, ModuleType):
            raise PluginFault(f"{_HOOKSPECS} returned {type(spec).__name__}, not a module")
        _kinds(spec)
    try:
        _manager([*known, *brought])
    except Exception as error:
        raise PluginFault(f"its {_HOOKSPECS} cannot be used: {one_line(error)}") from error
    return brought


def _kinds(spec: ModuleType) -> Mapping[str, type]:
    """Return what the values of each hook must be, as far as the module says so."""
    kinds = getattr(spec, "HOOK_TYPES", {})
    if not isinstance(kinds, Mapping) or not all(isinstance(k, type) for k in kinds.values()):
        raise PluginFault(f"HOOK_TYPES of {spec.__name__} must map names of hooks to types")
    for hook in kinds:
        if not hasattr(spec, hook):  # else one plugin could spoil the hooks of another
            raise PluginFault(f"HOOK_TYPES of {spec.__name__} names {hook}, no hook of its own")
    return kinds


def _manager(specs: Iterable[ModuleType]) -> pluggy.PluginManager:
    manager = pluggy.PluginManager(hooks.PROJECT)
    for spec in specs:
        manager.add_hookspecs(spec)
    return manager


def _collect(module: Any, name: str, specs: Iterable[ModuleType]) -> list[tuple[str, Any]]:
    manager = _manager(specs)
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


def _admit(
    registry: Registry,
    plugin: str,
    owner: str,
    found: list[tuple[str, Any]],
    kinds: Mapping[str, type],
) -> None:
    admitted: dict[tuple[str, str], Offer] = {}
    for hook, value in found:
        if hook == _HOOKSPECS:
            continue
        slug = _sound_slug(hook, value, kinds.get(hook, object))
        taken = registry.offers.get(hook, {}).get(slug)
        if taken:
            raise PluginFault(f"the slug {slug!r} is taken by {taken.owner} ({taken.plugin})")
        if (hook, slug) in admitted:
            raise PluginFault(f"the slug {slug!r} is offered twice")
        admitted[hook, slug] = Offer(value, plugin, owner)
    for (hook, slug), offer in admitted.items():  # all or nothing
        registry.offers.setdefault(hook, {})[slug] = offer


def _sound_slug(hook: str, value: Any, kind: type) -> str:
    """Return the slug of an offered value; raises PluginFault where the value is not as it must be.

    kind : the type the hook's specification asks for.
    """
    if not isinstance(value, kind):
        raise PluginFault(f"{hook} returned {type(value).__name__}, not {kind.__name__}")
    slug = getattr(value, "slug", None)
    if not isinstance(slug, str):
        raise PluginFault(f"{hook} returned {type(value).__name__}, which has no slug")
    if not slug or not slug.isprintable():
        raise PluginFault(f"{hook} returned the slug {slug!r}; it must be a name on one line")
    title = getattr(value, "title", "")
    if not isinstance(title, str):
        raise PluginFault(f"the title of {slug!r} must be text, not {type(title).__name__}")
    if isinstance(value, Design):
        require_sound(value)
    return slug
