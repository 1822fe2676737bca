"""Read a preset file: TOML into a frozen model, or one sentence that says what is wrong in it."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from importlib.resources import files
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from foldmill.errors import UnreadableFile
from foldmill.refusals import explain


class Preset(BaseModel):
    """Base of material and machine models: frozen, closed, documented by attribute docstrings."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False
    )


M = TypeVar("M", bound=Preset)


def read(model: type[M], text: str, name: str) -> M:
    """Read one preset; raises UnreadableFile naming the file and the field or line."""
    try:
        return model.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{name} is no TOML file: {error}.") from None
    except ValidationError as error:
        raise UnreadableFile(f"{name}: {explain(error)}") from None


def shipped(model: type[M], package: str) -> Iterable[M]:
    """Read every preset that lies beside a package, by name."""
    folder = files(package)
    names = sorted(entry.name for entry in folder.iterdir() if entry.name.endswith(".toml"))
    return [read(model, (folder / name).read_text(encoding="utf-8"), name) for name in names]
