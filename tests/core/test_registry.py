"""One broken plugin never hides the others, and everybody learns whose it is."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib.metadata import EntryPoint
from types import ModuleType, SimpleNamespace
from typing import Any, cast

import pytest
from pluggy import PluginValidationError

from foldmill import Design, Fold, Params, PluginFault, UnknownName, hookimpl
from foldmill.hooks import hookspec
from foldmill.registry import Registry, installed, load


class NoParams(Params):
    """Nothing to state."""


def never(params: NoParams) -> Fold:
    raise AssertionError("a registry runs no design")


def design(slug: str) -> Design[NoParams]:
    return Design(slug, slug.title(), NoParams, never)


def plugin(hook: Any = None, **members: Any) -> ModuleType:
    """Make a module that offers what ``hook`` returns, and has other members."""
    module = ModuleType("a_plugin")
    if hook is not None:
        hook.__name__ = "foldmill_designs"
        members["foldmill_designs"] = hookimpl(hook)
    for name, value in members.items():
        setattr(module, name, value)
    return module


@dataclass
class Point:
    """What the registry needs of an entry point, over a module that is already there."""

    name: str
    target: Any
    dist: Any = field(default_factory=lambda: SimpleNamespace(name="acme-folds"))

    def load(self) -> Any:
        return self.target() if not isinstance(self.target, ModuleType) else self.target


def loaded(*points: Point) -> Registry:
    return load(cast("list[EntryPoint]", list(points)))


GOOD = Point("good", plugin(lambda: [design("good"), design("better")]))


def unimportable() -> ModuleType:
    raise ImportError("no module named 'numpyy'")


def empty_handed() -> list[Design[NoParams]]:
    return []


def interrupted() -> ModuleType:
    raise ZeroDivisionError("at import")


def test_designs_are_offered_by_slug_in_order() -> None:
    registry = loaded(GOOD)
    assert list(registry.designs) == ["better", "good"]
    assert registry.design("good").title == "Good"
    assert registry.offers["foldmill_designs"]["good"].owner == "acme-folds"
    assert registry.broken == []


@pytest.mark.parametrize(
    ("target", "error", "sentence"),
    [
        (unimportable, ImportError, "numpyy"),
        (interrupted, ZeroDivisionError, "at import"),
        (plugin(), PluginFault, "offers nothing"),
        (plugin(empty_handed), PluginFault, "offers nothing"),
        (plugin(lambda: None), PluginFault, "offers nothing"),
        (plugin(lambda: 3), PluginFault, "foldmill_designs returned int, not a list"),
        (plugin(lambda: [3]), PluginFault, "returned int, which has no slug"),
        (plugin(lambda: design("alone")), PluginFault, "returned Design, not a list"),
        (plugin(lambda: 1 / 0), ZeroDivisionError, "division"),
        (plugin(lambda: [design("good")]), PluginFault, r"'good' is taken by acme-folds \(good\)"),
        (plugin(lambda: [design("a"), design("a")]), PluginFault, "'a' is offered twice"),
        (
            plugin(foldmill_desings=hookimpl(lambda: [design("a")])),
            PluginValidationError,
            "foldmill_desings",
        ),
        (plugin(lambda colour: [design("a")]), PluginValidationError, "colour"),
    ],
)
def test_a_broken_plugin_is_named_with_its_owner_and_hides_nobody(
    target: Any, error: type[Exception], sentence: str
) -> None:
    bad = Point("bad", target, SimpleNamespace(name="shaky-folds"))
    last = Point("last", plugin(lambda: [design("last")]))
    registry = loaded(GOOD, bad, last)
    assert list(registry.designs) == ["better", "good", "last"]
    (broken,) = registry.broken
    assert (broken.name, broken.distribution) == ("bad", "shaky-folds")
    assert isinstance(broken.error, error)
    with pytest.raises(Exception, match=sentence):
        raise broken.error
    assert str(broken).startswith("The plugin 'bad' of shaky-folds is broken: ")


def test_a_plugin_with_one_bad_value_offers_none_of_its_others() -> None:
    registry = loaded(Point("half", plugin(lambda: [design("fine"), 3])))
    assert registry.designs == {}


def test_a_plugin_without_a_distribution_is_still_named() -> None:
    registry = loaded(Point("lost", interrupted, None))
    assert registry.broken[0].distribution == "an unknown distribution"


def test_who_asks_for_a_missing_family_hears_of_the_broken_plugin() -> None:
    registry = loaded(GOOD, Point("bad", interrupted))
    with pytest.raises(UnknownName, match=r"There are: better, good\. The plugin 'bad' of acme-"):
        registry.design("tuck")


def test_a_plugin_may_specify_hooks_that_another_one_implements() -> None:
    specs = ModuleType("specs")

    def foldmill_colours() -> list[Any]:
        return []

    specs.foldmill_colours = hookspec(foldmill_colours)  # type: ignore[attr-defined]
    host = plugin(
        lambda: [design("host")], foldmill_hookspecs=hookimpl(named(lambda: [specs], "hookspecs"))
    )
    red = SimpleNamespace(slug="red")
    guest = plugin(foldmill_colours=hookimpl(named(lambda: [red], "colours")))
    registry = loaded(Point("guest", guest), Point("host", host))
    assert registry.broken == []
    assert registry.of("foldmill_colours") == {"red": red}


def named(function: Any, name: str) -> Any:
    function.__name__ = f"foldmill_{name}"
    return function


def test_the_built_in_families_register_like_anybody_else() -> None:
    registry = installed()
    assert {"rotational", "tuck"} <= set(registry.designs)
    assert registry.offers["foldmill_designs"]["tuck"].owner == "foldmill"
