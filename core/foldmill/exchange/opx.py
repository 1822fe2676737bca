"""The .opx format of ORIPA: a Java bean in XML, an ``OriLineProxy`` for each line.

A property that is left out is 0. Types: 0 auxiliary, 1 border or cut, 2 mountain, 3 valley. Seen on
a screen, so y points downward; no unit; every crease folds flat.
"""

from __future__ import annotations

from foldmill.design import Fold
from foldmill.errors import UnreadableFile
from foldmill.exchange import plain_lines, safe_xml
from foldmill.exchange.drawing import Drawing, Look, drawing_of
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.plain_lines import AUXILIARY, LOOKS
from foldmill.exchange.safe_xml import Element

_PROXY = "OriLineProxy"
_ENDS = ("x0", "y0", "x1", "y1")


def read(content: bytes, limits: Limits = DEFAULT) -> Drawing:
    """Return the lines of an .opx file; raises UnreadableFile with the number of the wrong line."""
    root = safe_xml.parse(content, limits)
    if root.name != "java":
        raise UnreadableFile(f"An .opx file begins with <java>, this one with <{root.name}>.")
    segments: list[list[float]] = []
    looks: list[Look] = []
    for element in root.walk():
        if element.name == "object" and element.attributes.get("class", "").endswith(_PROXY):
            said = _properties(element, len(segments) + 1)
            segments.append([said.get(name, 0.0) for name in _ENDS])
            looks.append(LOOKS.get(int(said.get("type", 0)), LOOKS[AUXILIARY]))
    return drawing_of(segments, looks, down=True, title=_title(root), limits=limits)


def _properties(proxy: Element, number: int) -> dict[str, float]:
    found: dict[str, float] = {}
    for child in proxy.children:
        name = child.attributes.get("property")
        if name not in {*_ENDS, "type"} or not child.children:
            continue
        text = child.children[0].text.strip()
        try:
            found[name] = float(int(text) if name == "type" else text)
        except (ValueError, OverflowError):
            raise UnreadableFile(
                f"The {name} of line {number} is {text[:40]!r}, no number."
            ) from None
    return found


def _title(root: Element) -> str:
    """Return the bean's title, a property or set as a field; empty where it says nothing."""
    for element in root.walk():
        parts = element.children
        if element.attributes.get("property") == "title":
            return _string(element)
        if len(parts) == 2 and parts[0].name == "string" and parts[0].text.strip() == "title":
            return _string(parts[1])
    return ""


def _string(element: Element) -> str:
    said = [child.text.strip() for child in element.children if child.name == "string"]
    return said[0] if said else ""


def write(fold: Fold, *, canvas: float | None = None) -> str:
    """Return a fold as the text of an .opx file; the same fold gives the same text.

    canvas : side of the square it is made to fill about (0, 0), in the file's units, such as
    ``plain_lines.CANVAS``; by default a unit is 1 mm and nothing is moved. What the format cannot
    hold is told by ``plain_lines.losses``; raises InvalidInput for unassigned creases.
    """
    lines = plain_lines.lines_of(fold, canvas)
    size = canvas or fold.pattern.size
    rows = [row for number, line in enumerate(lines) for row in _object(number, line)]
    return "\n".join([*_head(len(lines)), *rows, *_tail(size)]) + "\n"


def _head(count: int) -> list[str]:
    """Return the beginning: lines as a property of the bean, which every known reader looks for."""
    return [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<java version="1.8.0" class="java.beans.XMLDecoder">',
        ' <object class="oripa.DataSet">',
        *(row[4:] for row in _property("mainVersion", "int", "1")),
        *(row[4:] for row in _property("subVersion", "int", "1")),
        '  <void property="lines">',
        f'   <array class="oripa.{_PROXY}" length="{count}">',
    ]


def _object(number: int, line: plain_lines.Line) -> list[str]:
    """Return the rows of one line; all its properties, as not every reader knows the rule of 0."""
    ends = {"x0": line.x0, "x1": line.x1, "y0": line.y0, "y1": line.y1}
    return [
        f'    <void index="{number}">',
        f'     <object class="oripa.{_PROXY}">',
        *_property("type", "int", str(line.type)),
        *(row for name, value in ends.items() for row in _property(name, "double", repr(value))),
        "     </object>",
        "    </void>",
    ]


def _property(name: str, kind: str, value: str) -> list[str]:
    return [
        f'      <void property="{name}">',
        f"       <{kind}>{value}</{kind}>",
        "      </void>",
    ]


def _tail(size: float) -> list[str]:
    return [
        "   </array>",
        "  </void>",
        *(row[4:] for row in _property("paperSize", "double", repr(size))),
        " </object>",
        "</java>",
    ]
