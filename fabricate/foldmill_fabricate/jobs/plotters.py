"""The plotters of a workshop: a name for each port, in ``plotters.toml`` of the config folder.

::

    [bench]
    port = "/dev/ttyUSB0"
    machine = "generic-hpgl-600"
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from foldmill.errors import InvalidInput, UnreadableFile
from foldmill.refusals import explain
from foldmill_fabricate.config import config_folder
from foldmill_fabricate.jobs.errors import NoSuchJob
from foldmill_fabricate.plotter.lock import device_of

_NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,39}")


class Plotter(BaseModel):
    """A machine of the workshop."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    name: str
    port: str = Field(min_length=1)
    """/dev/ttyUSB0, COM3, socket://host:port, rfc2217://host:port or sim://machine"""
    machine: str
    """slug of its profile"""


def plotters_file() -> Path:
    """Return the file that names this user's plotters; it need not exist."""
    return config_folder() / "plotters.toml"


def read(file: Path | None = None, more: Iterable[str] = ()) -> dict[str, Plotter]:
    """Return the plotters by name.

    file : by default the user's own; more : others, each as NAME=PORT or NAME=PORT@MACHINE. Raises
    UnreadableFile, InvalidInput for two names of one device.
    """
    place = plotters_file() if file is None else file
    found = _listed(place) if file is not None or place.exists() else {}
    for text in more:
        one = _typed(text)
        found[one.name] = one
    _refuse_twins(found)
    return found


def find(plotters: Mapping[str, Plotter], name: str) -> Plotter:
    """Return a plotter; raises NoSuchJob with the names there are."""
    if name not in plotters:
        known = ", ".join(sorted(plotters)) or f"none: name them in {plotters_file()}"
        raise NoSuchJob(f"There is no plotter {name[:40]!r}. There are: {known}.")
    return plotters[name]


def _listed(place: Path) -> dict[str, Plotter]:
    try:
        tables = tomllib.loads(place.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise UnreadableFile(f"{place} cannot be read: {error}.") from None
    return {name: _made(name, values, str(place)) for name, values in tables.items()}


def _typed(text: str) -> Plotter:
    name, equals, rest = text.partition("=")
    port, _, machine = rest.partition("@")
    if not equals or not port:
        raise InvalidInput(f"{text!r} names no plotter: write NAME=PORT@MACHINE.")
    named = machine or (port.removeprefix("sim://").split("?")[0] if "sim://" in port else "")
    if not named:
        raise InvalidInput(f"{text!r} does not say what machine it is: write {text}@MACHINE.")
    return _made(name, {"port": port, "machine": named}, text)


def _made(name: str, values: object, where: str) -> Plotter:
    if not _NAME.fullmatch(name):
        raise InvalidInput(
            f"{where}: {name[:60]!r} is no name of a plotter: small letters, digits and hyphens."
        )
    if not isinstance(values, dict):
        raise InvalidInput(f"{where}: write [{name}], with its port and its machine below.")
    try:
        return Plotter.model_validate({**values, "name": name})
    except ValidationError as error:
        raise InvalidInput(f"{where}: plotter {name}: {explain(error)}") from None


def _refuse_twins(found: Mapping[str, Plotter]) -> None:
    """Refuse two names of one device: each would start jobs on it."""
    seen: dict[str, str] = {}
    for name, one in found.items():
        device = device_of(one.port)
        if device in seen:
            raise InvalidInput(
                f"{name} and {seen[device]} are the same device, {one.port}: keep one of them."
            )
        seen[device] = name
