"""XML of strangers, read by the standard library's expat with everything dangerous refused.

No entity is ever defined or expanded and nothing outside the file is looked at: a DOCTYPE that only
names a DTD, as drawing programs write it, is passed over; one with declarations of its own is
refused. Depth and number of elements are bounded.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from foldmill.errors import UnreadableFile
from foldmill.exchange.limits import DEFAULT, Limits


@dataclass(slots=True)
class Element:
    """An element: its name without prefix, its attributes as they are written, what is in it."""

    name: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list[Element] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """All text directly within it."""
        return "".join(self.pieces)

    def walk(self) -> Iterator[Element]:
        """Yield this element and all within it, in the order of the file."""
        waiting = [self]
        while waiting:
            element = waiting.pop()
            yield element
            waiting += reversed(element.children)


def parse(content: bytes, limits: Limits = DEFAULT) -> Element:
    """Return the root element; raises UnreadableFile for what is no XML, or no safe XML."""
    limits.check_size(len(content))
    reader = _Reader(limits)
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.data
    parser.StartDoctypeDeclHandler = _doctype
    parser.EntityDeclHandler = _entity
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        said = expat.ErrorString(error.code) or "it is broken"
        place = f"line {error.lineno}, column {error.offset + 1}"
        raise UnreadableFile(f"This is no XML: {said} at {place}.") from None
    except (LookupError, ValueError) as error:
        if isinstance(error, UnreadableFile):
            raise
        raise UnreadableFile(f"This XML cannot be decoded: {error}.") from None
    return reader.top.children[0]


class _Reader:
    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.count = 0
        self.top = Element("")
        self.open = [self.top]

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        self.limits.check_elements(self.count)
        if len(self.open) > self.limits.depth:
            raise UnreadableFile(
                f"The elements of this file lie more than {self.limits.depth} deep in each other."
            )
        element = Element(name.rpartition(":")[2], attributes)
        self.open[-1].children.append(element)
        self.open.append(element)

    def end(self, _name: str) -> None:
        self.open.pop()

    def data(self, text: str) -> None:
        self.open[-1].pieces.append(text)


def _doctype(_name: str, _system: str | None, _public: str | None, has_own: bool) -> None:
    if has_own:
        raise UnreadableFile(
            "The DOCTYPE of this file makes declarations of its own, which can be bombs, so it is "
            "not read. Save the drawing as plain SVG, without entities."
        )


def _entity(*_declared: object) -> None:
    raise UnreadableFile(
        "This file declares entities, which can be bombs, so it is not read. Save it without."
    )
