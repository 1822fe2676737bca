"""What the lines of a drawing are: said by the person, else by their layers, else by their colours.

A layer's name is believed before a colour, because programs differ in colours: red is a mountain to
most of them and a valley to some.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from foldmill.errors import UnreadableFile
from foldmill.exchange import colours
from foldmill.exchange.drawing import Look
from foldmill.exchange.options import LETTERS, OTHER, SKIP, Options
from foldmill.finding import Finding, Severity

_WORDS = {
    "M": ("mountain", "mountains", "mtn", "ridge", "ridges"),
    "V": ("valley", "valleys"),
    "B": ("boundary", "boundaries", "border", "borders", "outline", "contour"),
    "C": ("cut", "cuts", "cutting", "slit", "slits", "hole", "holes"),
    "F": (
        "flat",
        "facet",
        "facets",
        "aux",
        "auxiliary",
        "triangulation",
        "guide",
        "guides",
        "noname",
    ),
    # noname: what ORIPA calls the layer of its auxiliary lines
    "U": ("unassigned", "hinge", "hinges", "undriven", "universal"),
    SKIP: ("note", "notes", "text", "label", "labels", "annotation", "annotations", "dimensions"),
}
_WEAK = {"edge": "B", "edges": "B"}
"""Believed after colours: an edge is the outline to some, and any line of the graph to others."""
_MEANING = {word: letter for letter, words in _WORDS.items() for word in words}
_PARTS = re.compile(r"[A-Z]+(?![a-z])|[A-Z][a-z]*|[a-z]+")
_NAMELESS = "no colour"
"""What lines without colour and layer are called, in questions and in answers."""
_SHOWN = 6
"""How many unknown colours and layers a sentence lists."""


@dataclass(frozen=True)
class Named:
    """A letter for every line, empty for those left out, and what there is to tell about it."""

    letters: tuple[str, ...]
    findings: tuple[Finding, ...]


def named(looks: Sequence[Look], options: Options) -> Named:
    """Return what the lines are.

    Raises UnreadableFile where the looks of some lines say nothing, naming them and ``--as``.
    """
    count = Counter(looks)
    meant = {look: _meaning(look, options) for look in count}
    _refuse_unknown({look: n for look, n in count.items() if meant[look] is None}, len(count))
    letters = {look: letter or "" for look, letter in meant.items()}
    left_out = sum(n for look, n in count.items() if letters[look] in {"", SKIP})
    findings = [*_left_out(left_out), *_disputed(count, letters, options)]
    taken = tuple("" if letters[look] == SKIP else letters[look] for look in looks)
    if not any(taken):
        raise UnreadableFile("All lines of this drawing are left out; none remains to be made.")
    return Named(taken, tuple(findings))


def _meaning(look: Look, options: Options) -> str | None:
    if look.letter:
        return look.letter
    said = _said(look, options)
    if said is not None:
        return said
    by_layer = None if options.by == "colour" else layer_letter(look.layers)
    if by_layer is not None:
        return by_layer
    by_colour = None if options.by == "layer" else _colour_letter(look)
    if by_colour is None and options.by != "colour":
        by_colour = layer_letter(look.layers, _WEAK)
    return options.named.get(OTHER) if by_colour is None else by_colour


def _colour_letter(look: Look) -> str | None:
    return None if look.colour is None else colours.letter_of(look.colour)


def _said(look: Look, options: Options) -> str | None:
    """Return what the person says of a layer, the innermost first, or of a colour."""
    said = {name.lower(): letter for name, letter in options.named.items()}
    for layer in reversed(look.layers):
        if layer.lower() in said:
            return said[layer.lower()]
    for name, letter in said.items():
        colour = colours.parse(name)
        if colour is not None and colour[0] == look.colour:
            return letter
    return said.get(_NAMELESS) if _name(look) == _NAMELESS else None


def layer_letter(layers: Sequence[str], meaning: Mapping[str, str] = _MEANING) -> str | None:
    """Return what names of layers say, the innermost that says anything; None where none does.

    Single letters count as capitals only: programs that shorten files call classes a, b, c.
    """
    for layer in reversed(layers):
        if layer in LETTERS and len(layer) == 1:
            return layer
        meant = {meaning[word] for word in _words(layer) if word in meaning}
        if len(meant) == 1:
            return meant.pop()
    return None


def _words(layer: str) -> list[str]:
    """Return the words of "MountainLine", "mountain-line" or "MOUNTAIN_LINE", in small letters."""
    return [part.lower() for part in _PARTS.findall(layer)]


def _refuse_unknown(unknown: dict[Look, int], looks: int) -> None:
    if not unknown:
        return
    names: Counter[str] = Counter()
    for look, count in unknown.items():
        names[_name(look)] += count
    listed = [f"{count} in {name}" for name, count in names.most_common(_SHOWN)]
    more = f" and {len(names) - _SHOWN} others" if len(names) > _SHOWN else ""
    first = names.most_common(1)[0][0]
    alike = (
        "All lines are alike, so the file does not tell creases from the outline: save it in a "
        "format and version that keeps colours or layers. If they are all the same, s"
        if looks == 1
        else "S"
    )
    raise UnreadableFile(
        f"Nothing says what these lines are: {', '.join(listed)}{more}. {alike}ay it with --as "
        f"'{first}=M', or another of {' '.join(LETTERS)}, or skip; --as {OTHER}={SKIP} leaves them "
        f"all out."
    )


def _name(look: Look) -> str:
    return look.hex or (look.layers[-1] if look.layers else _NAMELESS)


def _left_out(count: int) -> list[Finding]:
    if not count:
        return []
    message = f"{count} lines were left out, by their layer, their colour, or as was asked for."
    return [Finding("import-left-out", Severity.INFO, "", message)]


def _disputed(count: Counter[Look], letters: dict[Look, str], options: Options) -> list[Finding]:
    """Say where a layer was believed against a colour that means the other fold."""
    if options.by != "auto":
        return []
    disputed = 0
    for look, number in count.items():
        colour = _colour_letter(look)
        if {letters[look], colour} == {"M", "V"} and layer_letter(look.layers) == letters[look]:
            disputed += number
    if not disputed:
        return []
    message = (
        f"{disputed} creases lie on a layer that says mountain or valley, in the colour of the "
        f"other; the layer was believed."
    )
    remedy = "If it should be the colour, say --by colour."
    return [Finding("import-layer-or-colour", Severity.WARNING, "", message, remedy)]
