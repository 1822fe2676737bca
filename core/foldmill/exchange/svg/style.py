"""What SVG elements are drawn in: attributes, style sheets and style attributes, in that order.

Of CSS the part that drawing programs write is understood: types, ids, classes and compounds of
them. Rules of other kinds are counted, so that a person can be told.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from math import isnan

from foldmill.errors import UnreadableFile
from foldmill.exchange.safe_xml import Element

PROPERTIES = (
    *("stroke", "stroke-opacity", "opacity", "display", "visibility", "color"),
    *("transform", "transform-origin"),
)
INHERITED = ("stroke", "stroke-opacity", "visibility", "color")
Rank = tuple[bool, int, int, int, int]
"""Of a declaration: important, ids, classes, types, order in the file."""
_SIMPLE = re.compile(r"(\*|[A-Za-z][\w-]*)?((?:[.#][\w-]+)*)")
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_STATEMENT = re.compile(r"@(?:import|charset|namespace)\b[^;{}@]*;", re.IGNORECASE)
_PRINTED = re.compile(r"@media\s+print\b[^{}@]*\{(?:[^{}]*\{[^{}]*\})*[^{}]*\}", re.IGNORECASE)
_MOST_COMPOUNDS = 1000
"""Selectors of several parts; drawing programs write none or few."""


@dataclass
class Sheet:
    """The rules of all style sheets of a file."""

    plain: dict[str, dict[str, tuple[Rank, str]]] = field(default_factory=dict)
    """Selectors of one part, such as ".st0", "#a", "path" or "*"."""
    compound: dict[tuple[str, ...], dict[str, tuple[Rank, str]]] = field(default_factory=dict)
    """Selectors of several parts that must all fit."""
    unknown: int = 0
    """Rules that are not understood."""
    known: dict[int, tuple[Element, dict[str, tuple[Rank, str]]]] = field(default_factory=dict)
    """What is declared of elements, since clones are asked for again and again."""

    def declared(self, element: Element) -> dict[str, tuple[Rank, str]]:
        """Return what the rules say of an element, and how much it weighs."""
        if id(element) not in self.known:
            self.known[id(element)] = element, self._declared(element)
        return self.known[id(element)][1]

    def _declared(self, element: Element) -> dict[str, tuple[Rank, str]]:
        own = _parts_of(element)
        found: dict[str, tuple[Rank, str]] = {}
        for declarations in self._fitting(own):
            for name, ranked in declarations.items():
                if name not in found or ranked[0] >= found[name][0]:
                    found[name] = ranked
        return found

    def _fitting(self, own: set[str]) -> Iterator[Mapping[str, tuple[Rank, str]]]:
        for part in sorted(own):
            if part in self.plain:
                yield self.plain[part]
        for parts, declarations in self.compound.items():
            if own.issuperset(parts):
                yield declarations


def sheet_of(root: Element) -> Sheet:
    """Return the rules of all style elements; raises UnreadableFile for an absurd number."""
    sheet, order = Sheet(), 0
    for element in root.walk():
        if element.name != "style":
            continue
        for block in _screened(element.text).split("}"):
            selectors, brace, body = block.rpartition("{")
            if not brace:
                continue
            for selector in selectors.split(","):
                order += 1
                _add(sheet, selector.strip(), body, order)
    return sheet


def _screened(text: str) -> str:
    """Return the rules without what is no rule, or none for the screen."""
    for pattern in (_COMMENT, _STATEMENT, _PRINTED):
        text = pattern.sub(" ", text)
    return text


def _add(sheet: Sheet, selector: str, body: str, order: int) -> None:
    found = _SIMPLE.fullmatch(selector)
    if not found or not selector:
        _refuse_strokes(selector, body)
        sheet.unknown += 1
        return
    parts = re.findall(r"[.#][\w-]+", found[2]) + ([found[1]] if found[1] else [])
    rank = (found[2].count("#"), found[2].count("."), int(found[1] not in {None, "*"}), order)
    if len(parts) == 1:
        known = sheet.plain.setdefault(parts[0], {})
    else:
        known = sheet.compound.setdefault(tuple(sorted(parts)), {})
    if len(sheet.compound) > _MOST_COMPOUNDS:
        raise UnreadableFile(f"The style sheet has over {_MOST_COMPOUNDS} selectors in parts.")
    for name, value, is_important in _declarations(body):
        ranked = ((is_important, *rank), value)
        if name not in known or ranked[0] >= known[name][0]:
            known[name] = ranked


def _refuse_strokes(selector: str, body: str) -> None:
    """Refuse a rule that is not understood and says of what lines look like.

    Rules for what a pointer does say nothing of the drawing as it is first seen.
    """
    if not selector or (":" in selector and "@" not in selector):
        return
    if any(name in {"stroke", "stroke-opacity", "opacity"} for name, _, _ in _declarations(body)):
        raise UnreadableFile(
            f"The style sheet says what {selector[:60]!r} looks like, a selector that is not "
            f"understood, and without it lines would be missed. Give those lines a class or a "
            f"stroke of their own."
        )


def _declarations(body: str) -> Iterable[tuple[str, str, bool]]:
    """Yield name, value and whether it is important."""
    for each in body.split(";"):
        name, colon, value = each.partition(":")
        if colon and name.strip().lower() in PROPERTIES:
            plain, mark, weight = value.partition("!")
            yield name.strip().lower(), plain.strip(), bool(mark) and _is_important(weight)


def _is_important(weight: str) -> bool:
    return weight.strip().lower() == "important"


def _parts_of(element: Element) -> set[str]:
    parts = {"*", element.name, *("." + name for name in classes(element))}
    return parts | ({"#" + element.attributes["id"]} if "id" in element.attributes else set())


def classes(element: Element) -> list[str]:
    """Return the names of an element's classes."""
    return element.attributes.get("class", "").split()


def style_of(element: Element, sheet: Sheet, outer: Mapping[str, str]) -> dict[str, str]:
    """Return what an element is drawn in: its own, or what it inherits.

    outer : the style of the element about it. Opacity and display are each element's own.
    """
    style = {name: outer[name] for name in INHERITED if name in outer}
    own = {name: element.attributes[name] for name in PROPERTIES if name in element.attributes}
    declared = sheet.declared(element)
    own |= {name: value for name, (_, value) in declared.items()}
    for name, value, is_important in _declarations(element.attributes.get("style", "")):
        if is_important or name not in declared or not declared[name][0][0]:
            own[name] = value
    return style | {name: value for name, value in own.items() if value != "inherit"}


def share(text: str) -> float:
    """Return an opacity, 0 to 1; 1 for what is no number, as browsers have it."""
    word = text.strip()
    try:
        value = float(word[:-1]) / 100 if word.endswith("%") else float(word)
    except ValueError:
        return 1.0
    return 1.0 if isnan(value) else min(max(value, 0.0), 1.0)
