"""The hooks a plugin may implement. One entry-point group, ``foldmill``, for all of them.

A plugin is a module::

    from foldmill import Design, hookimpl

    @hookimpl
    def foldmill_designs():
        return [Design(...)]

named in its distribution's ``pyproject.toml``::

    [project.entry-points.foldmill]
    my-family = "my_package"
"""

from __future__ import annotations

from collections.abc import Iterable
from types import ModuleType
from typing import Any

import pluggy

from foldmill.design import Design

PROJECT = "foldmill"
hookspec = pluggy.HookspecMarker(PROJECT)
hookimpl = pluggy.HookimplMarker(PROJECT)

HOOK_TYPES: dict[str, type] = {"foldmill_designs": Design}
"""What the values of each hook must be. A module of hookspecs states it for hooks of its own."""


@hookspec
def foldmill_designs() -> Iterable[Design[Any]]:
    """Return the designs this plugin offers. Called once per registry."""
    return ()


@hookspec
def foldmill_hookspecs() -> Iterable[ModuleType]:
    """Return modules that specify further hooks. Called before any other hook.

    Such a module may state in ``HOOK_TYPES`` what the values of each of its hooks must be.
    """
    return ()
