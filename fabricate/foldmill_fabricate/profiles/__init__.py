"""How cutting drawings name and colour their layers, as TOML presets and their model.

There is no common standard: die-making software goes by AutoCAD's colour numbers, laser software
by colours, senders of plotters by pens or layers. A profile says all of them for each role, and
``legend`` tells a person what is what. A user's own lie as ``profiles/SLUG.toml`` beside the other
presets, or anywhere.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from foldmill.errors import UnknownName, UnreadableFile
from foldmill_fabricate import presets
from foldmill_fabricate.config import config_folder
from foldmill_fabricate.presets import Preset, Sourced

DEFAULT = "foldmill"
"""The profile that is taken where none is asked for."""

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z_ -]*$", max_length=31)]
"""Without digits: vpype takes the first number of a label for its layer's."""
Colour = Annotated[str, Field(pattern=r"^#[0-9a-f]{6}$")]


class Layer(Preset):
    """A layer's name, and how software that goes by colour or pen recognises it."""

    name: Name
    aci: int = Field(ge=1, le=255)
    """AutoCAD colour index, on the layer and on each of its lines."""
    colour: Colour
    """#rrggbb of its lines in SVG."""
    pen: int = Field(ge=1, le=99)
    """Pen number where the machine selects no tools; ascending in order of work."""
    cf2: int = Field(1, ge=0, le=99)
    """Type of its lines in CFF2: 1 cut, 2 crease, 3 perforation."""


def _layer(name: str, aci: int, colour: str, pen: int, cf2: int = 1) -> Layer:
    return Layer(name=name, aci=aci, colour=colour, pen=pen, cf2=cf2)


class Layers(Preset):
    """One layer for each role; what a profile leaves out is as in foldmill's own."""

    holes: Layer = _layer("REG", 10, "#00e000", 1)
    """Registration holes and marks, cut first."""
    score_front: Layer = _layer("SCORE_FRONT", 4, "#0000ff", 2, 2)
    """Half-cuts and grooves on the front."""
    score_back: Layer = _layer("SCORE_BACK", 9, "#ff8000", 2, 2)
    """Half-cuts and grooves on the reverse."""
    crease_front: Layer = _layer("CREASE_FRONT", 2, "#0000ff", 2, 2)
    """Lines pressed by a wheel or stylus, or drawn, on the front."""
    crease_back: Layer = _layer("CREASE_BACK", 8, "#ff8000", 2, 2)
    """Lines pressed by a wheel or stylus, or drawn, on the reverse."""
    perforation: Layer = _layer("PERF", 3, "#00e0e0", 3, 3)
    """Creases cut through in dashes, each dash a line of its own."""
    cut_inner: Layer = _layer("CUT_INNER", 1, "#d0d000", 4)
    """Relief holes, slots and slits; cut before the outline."""
    cut_outer: Layer = _layer("CUT_OUTER", 1, "#ff0000", 4)
    """The outline, cut last."""
    note: Layer = _layer("NOTE", 20, "#b4b4b4", 5)
    """Words for people; no output."""
    anchor: Layer = _layer("ANCHOR", 20, "#b4b4b4", 5)
    """Marks in the blank's corners; no output."""


class Profile(Sourced):
    """Which layer is called and coloured how, for one kind of software."""

    slug: str
    title: str
    provenance: str
    """Where the names and colours come from."""
    layers: Layers = Field(default_factory=lambda: Layers.model_validate({}))


@dataclass(frozen=True)
class Style:
    """What a person may choose of a drawing."""

    profile: Profile
    dxf: Literal["R2000", "R12"] = "R2000"


class LegendRow(NamedTuple):
    """One layer, for people."""

    look: Layer
    about: str


@cache
def shipped() -> dict[str, Profile]:
    """Return the profiles that lie beside the code, by slug."""
    found = presets.shipped(Profile, "foldmill_fabricate.profiles")
    return {profile.slug: profile for profile in found}


def names() -> list[str]:
    """Return the slugs of all profiles, the user's own last."""
    own = sorted(path.stem for path in (config_folder() / "profiles").glob("*.toml"))
    return [*shipped(), *(slug for slug in own if slug not in shipped())]


def find(wanted: str = DEFAULT) -> Profile:
    """Return a profile by name or file; raises UnknownName, or UnreadableFile for a broken file."""
    if wanted in shipped():
        return shipped()[wanted]
    path = Path(wanted)
    if path.suffix != ".toml":
        path = config_folder() / "profiles" / f"{wanted}.toml"
        if not path.is_file():
            raise UnknownName.of("profile", wanted, names())
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise UnreadableFile(f"{path} cannot be read as a profile: {reason}.") from None
    return presets.read(Profile, text, str(path))


def legend(profile: Profile) -> Iterator[LegendRow]:
    """Yield what each layer is for, in order of work."""
    for key, field in Layers.model_fields.items():
        yield LegendRow(getattr(profile.layers, key), " ".join((field.description or "").split()))
