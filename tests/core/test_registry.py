"""One broken plugin never hides the others, and everybody learns whose it is."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from importlib.metadata import EntryPoint, entry_points
from types import ModuleType, SimpleNamespace
from typing import Any, cast

import pytest
from pluggy import PluginValidationError

from foldmill import Design, Fold, Params, PluginFault, UnknownName, hookimpl, hooks
from foldmill.hooks import hookspec
from foldmill.registry import Registry, installed, load
from foldmill_fabricate.hooks import Format


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


def unlicensed() -> ModuleType:
    sys.exit("needs a licence")


def specifying(specs: Any) -> ModuleType:
    """Make a module that offers a family, and hookspecs."""
    stated = hookimpl(named(lambda: specs, "hookspecs"))
    return plugin(lambda: [design("a")], foldmill_hookspecs=stated)


def typed(hook: str, kind: Any) -> ModuleType:
    """Make a module of hookspecs that states what a hook's values must be."""
    specs = ModuleType("specs")
    specs.HOOK_TYPES = {hook: kind}  # type: ignore[attr-defined]
    return specs


def named(function: Any, name: str) -> Any:
    function.__name__ = f"foldmill_{name}"
    return function


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
        (plugin(lambda: [3]), PluginFault, "foldmill_designs returned int, not Design"),
        (plugin(lambda: [SimpleNamespace(slug="a")]), PluginFault, "SimpleNamespace, not Design"),
        (plugin(lambda: [design("a\nb")]), PluginFault, "must be a name on one line"),
        (plugin(lambda: [replace(design("a"), title=cast("str", None))]), PluginFault, "title"),
        (plugin(lambda: [replace(design("a"), params=cast("Any", dict))]), PluginFault, "'a' is.*"),
        (unlicensed, SystemExit, "needs a licence"),
        (specifying(3), PluginFault, "foldmill_hookspecs returned int, not a list"),
        (specifying([3]), PluginFault, "foldmill_hookspecs returned int, not a module"),
        (specifying([ModuleType("bare")]), PluginFault, "did not find any"),
        (specifying([hooks]), PluginFault, "its foldmill_hookspecs cannot be used"),
        (specifying([typed("x", "Colour")]), PluginFault, "HOOK_TYPES of specs must map"),
        (specifying([typed("foldmill_designs", int)]), PluginFault, "no hook of its own"),
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
    target: Any, error: type[BaseException], sentence: str
) -> None:
    bad = Point("bad", target, SimpleNamespace(name="shaky-folds"))
    last = Point("last", plugin(lambda: [design("last")]))
    registry = loaded(GOOD, bad, last)
    assert list(registry.designs) == ["better", "good", "last"]
    (broken,) = registry.broken
    assert (broken.name, broken.distribution) == ("bad", "shaky-folds")
    assert isinstance(broken.error, error)
    with pytest.raises(BaseException, match=sentence):
        raise broken.error
    assert str(broken).startswith("The plugin 'bad' of shaky-folds is broken: ")


def test_a_plugin_with_one_bad_value_offers_none_of_its_others() -> None:
    registry = loaded(Point("half", plugin(lambda: [design("fine"), 3])))
    assert registry.designs == {}


def test_who_comes_later_in_the_alphabet_is_not_hijacked_when_it_is_our_own() -> None:
    thief = Point("aaa", plugin(lambda: [design("tuck")]), SimpleNamespace(name="shaky-folds"))
    own = Point("tuck", plugin(lambda: [design("tuck")]), SimpleNamespace(name="foldmill"))
    registry = loaded(thief, own)
    assert registry.offers["foldmill_designs"]["tuck"].owner == "foldmill"
    (broken,) = registry.broken
    assert (broken.name, broken.distribution) == ("aaa", "shaky-folds")


def test_a_stranger_with_a_format_named_svg_does_not_drop_the_built_in_ones() -> None:
    svg = Format("svg", "Mine", lambda plan, fold: {})
    stranger = plugin(foldmill_formats=hookimpl(named(lambda: [svg], "formats")))
    before = [point for point in entry_points(group="foldmill") if point.name == "fabricate"]
    registry = load([cast("EntryPoint", Point("aaa", stranger)), *before])
    assert {"svg", "dxf", "hpgl"} <= set(registry.of("foldmill_formats"))
    assert [broken.name for broken in registry.broken] == ["aaa"]


def test_a_format_must_be_a_format() -> None:
    red = plugin(foldmill_formats=hookimpl(named(lambda: [SimpleNamespace(slug="red")], "formats")))
    before = [point for point in entry_points(group="foldmill") if point.name == "fabricate"]
    (broken,) = load([*before, cast("EntryPoint", Point("red", red))]).broken
    assert "foldmill_formats returned SimpleNamespace, not Format" in str(broken)


def test_ctrl_c_while_plugins_load_is_the_users() -> None:
    def stopped() -> ModuleType:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        loaded(Point("slow", stopped))


def test_what_a_plugin_says_stays_on_one_line() -> None:
    def verbose() -> ModuleType:
        raise ImportError("no such module\n\n  Traceback: and so on")

    (broken,) = loaded(Point("verbose", verbose)).broken
    assert str(broken).endswith("ImportError: no such module Traceback: and so on")


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


def test_the_built_in_families_register_like_anybody_else() -> None:
    registry = installed()
    assert {"rotational", "tuck"} <= set(registry.designs)
    assert registry.offers["foldmill_designs"]["tuck"].owner == "foldmill"
