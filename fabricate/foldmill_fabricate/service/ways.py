"""Which methods a path takes, by the routes that are described."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from re import Pattern

from fastapi import APIRouter
from fastapi.routing import APIRoute
from starlette.routing import compile_path


class Ways:
    """The paths of some routers, by the prefix that each is included with."""

    def __init__(self, routers: Mapping[str, Sequence[APIRouter]]) -> None:
        self._known: dict[Pattern[str], set[str]] = {}
        for prefix, several in routers.items():
            for route in (each for router in several for each in router.routes):
                if isinstance(route, APIRoute) and route.include_in_schema:
                    path = compile_path(f"{prefix}{route.path}")[0]
                    self._known.setdefault(path, set()).update(route.methods or ())

    def methods(self, path: str) -> list[str]:
        """Return the methods that a path takes, in order: those of the first form it has."""
        found = (methods for form, methods in self._known.items() if form.match(path))
        return sorted(next(found, ()))
