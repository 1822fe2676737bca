"""Read an SVG drawing: every stroked shape, with its transforms, style, opacity and layers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange import colours, safe_xml
from foldmill.exchange.drawing import Drawing, Look, drawing_of
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.safe_xml import Element
from foldmill.exchange.svg import clones, lengths, transforms
from foldmill.exchange.svg.shapes import SHAPES, traced
from foldmill.exchange.svg.style import classes, share, sheet_of, style_of
from foldmill.exchange.svg.transforms import STILL, Affine

_GROUPS = {"svg", "g", "a", "switch"}
_UNDRAWN = {"defs", "symbol", "clipPath", "mask", "pattern", "marker", "style", "metadata"}
_PICTURES = {"text": "texts", "image": "images", "foreignObject": "foreign objects"}
_PAINTED = {"none", "transparent", ""}
_LABEL = "inkscape:label"


@dataclass(frozen=True)
class _Place:
    """What the groups about an element say of it."""

    affine: Affine = STILL
    style: dict[str, str] = field(default_factory=dict)
    layers: tuple[str, ...] = ()
    clones: tuple[str, ...] = ()
    """Ids of the parts that are being set in by <use>."""
    depth: int = 0


def read(content: bytes, limits: Limits = DEFAULT) -> Drawing:
    """Return the lines of an SVG file; raises UnreadableFile for what is none, or broken.

    Curves become chords; texts, images and what is hidden are left out. Both are told.
    """
    root = safe_xml.parse(content, limits)
    if root.name != "svg":
        raise UnreadableFile(f"An SVG file begins with <svg>, this one with <{root.name}>.")
    across, down, millimetres = lengths.page(root.attributes)
    reader = _Reader(root, limits)
    reader.group(root, _Place((across, 0.0, 0.0, down, 0.0, 0.0)))
    _refuse_fills(reader)
    return drawing_of(
        np.concatenate(reader.segments).reshape(-1, 4).tolist() if reader.segments else [],
        reader.looks,
        down=True,
        millimetres=millimetres,
        notes=reader.notes(),
        title=_title(root),
        limits=limits,
    )


def _refuse_fills(reader: _Reader) -> None:
    fills = reader.left["shapes without a line"]
    if fills and not reader.segments:
        raise UnreadableFile(
            f"There are no lines in this file: its shapes, {fills} of them, have no stroke. Give "
            f"them one in the colour of their kind; what a fill shows is not read."
        )


def _title(root: Element) -> str:
    said = [child.text.strip() for child in root.children if child.name == "title"]
    return said[0] if said else ""


class _Reader:
    def __init__(self, root: Element, limits: Limits) -> None:
        self.sheet = sheet_of(root)
        self.named = clones.named(root)
        self.drawn = 0
        self.symbols: dict[int, Element] = {}
        self.limits = limits
        self.segments: list[np.ndarray[tuple[int, ...], np.dtype[np.float64]]] = []
        self.looks: list[Look] = []
        self.bent = 0
        self.left: Counter[str] = Counter()

    def group(self, element: Element, outer: _Place) -> None:
        place = self._placed(element, outer)
        if place is None:
            return
        shown = clones.chosen(element) if element.name == "switch" else element.children
        for child in shown:
            self._child(child, place)

    def _child(self, child: Element, place: _Place) -> None:
        """Read what is in a group, or set in; counted, since clones of clones are without end."""
        self.drawn += 1
        self.limits.check_elements(self.drawn)
        if child.name in _GROUPS:
            self.group(child, self._inner(child, place))
        elif child.name in SHAPES:
            self._shape(child, place)
        elif child.name == "use":
            self._clone(child, place)
        elif child.name in _PICTURES:
            self.left[_PICTURES[child.name]] += 1

    def _clone(self, use: Element, outer: _Place) -> None:
        """Read what a <use> sets in, in its place and with its style to inherit."""
        place = self._placed(use, outer)
        if place is None:
            return
        name, element = clones.target(use, self.named, outer.clones)
        affine = transforms.after(place.affine, clones.place(use))
        drawn = self.symbols.setdefault(id(use), clones.as_drawn(use, element))
        self._child(drawn, replace(place, affine=affine, clones=(*outer.clones, name)))

    def _inner(self, child: Element, place: _Place) -> _Place:
        """Return the place within a drawing in a drawing, which has a page of its own."""
        if child.name != "svg":
            return place
        said = child.attributes
        across, down, _ = lengths.page(said)
        lengths.refuse_unplaced(said)
        corner = lengths.numbers(said.get("viewBox", ""), "viewBox")
        left, top = (corner[0], corner[1]) if len(corner) == 4 else (0.0, 0.0)
        x, y = lengths.px(said, "x"), lengths.px(said, "y")
        own = (across, 0.0, 0.0, down, x - across * left, y - down * top)
        return replace(place, affine=transforms.after(place.affine, own))

    def _placed(self, element: Element, outer: _Place) -> _Place | None:
        """Return what holds within an element; None where it is not drawn."""
        style = style_of(element, self.sheet, outer.style)
        if style.get("display") == "none":
            self.left["hidden parts"] += 1
            return None
        said = element.attributes
        _refuse_moved(said, style)
        affine = outer.affine
        if said.get("transform", "none").strip() not in {"", "none"}:
            affine = transforms.after(affine, transforms.parse(said["transform"]))
        names = [said.get("id", ""), *classes(element), said.get(_LABEL, "")]
        layers = (*outer.layers, *(name for name in names if name))
        return _Place(affine, style, layers, outer.clones, self._deeper(outer))

    def _deeper(self, outer: _Place) -> int:
        if outer.depth > self.limits.depth:
            raise UnreadableFile(
                f"The parts of this drawing, with its clones set in, lie more than "
                f"{self.limits.depth} deep in each other."
            )
        return outer.depth + 1

    def _shape(self, element: Element, outer: _Place) -> None:
        place = self._placed(element, outer)
        if place is None:
            return
        if place.style.get("visibility") in {"hidden", "collapse"}:
            self.left["hidden parts"] += 1
            return
        look = _look(place)
        if look is None:
            self.left["shapes without a line"] += 1
            return
        found = traced(element, self.limits.lines)
        self.bent += found.bent
        for line in found.lines:
            moved = transforms.applied(place.affine, line)
            self.segments.append(np.stack([moved[:-1], moved[1:]], axis=1))
            self.looks += [look] * (len(moved) - 1)
        self.limits.check_lines(len(self.looks))

    def notes(self) -> list[str]:
        """Return sentences on what was left out or drawn otherwise."""
        left = ", ".join(f"{count} {what}" for what, count in sorted(self.left.items()))
        said = [
            f"Left out, as they are no lines: {left}." if left else "",
            f"{self.bent} curves became chords that stray from them by no more than a "
            f"two-thousandth of their length."
            if self.bent
            else "",
            f"{self.sheet.unknown} rules of the style sheet are not understood."
            if self.sheet.unknown
            else "",
        ]
        return [sentence for sentence in said if sentence]


def _refuse_moved(said: dict[str, str], style: dict[str, str]) -> None:
    """Refuse what moves a part by a style, in which transforms are others than in an attribute."""
    moved = style.get("transform", "none")
    if moved not in {"", "none", said.get("transform")} or "transform-origin" in style:
        raise UnreadableFile(
            "This drawing moves parts of itself by transforms in styles, which are not followed, "
            "so its lines would lie elsewhere than they are seen. Write them as the attribute "
            "transform, without transform-origin (Inkscape does when it saves)."
        )


def _look(place: _Place) -> Look | None:
    """Return what a shape is drawn in; None where it has no line.

    The fold angle goes by the shape's own opacity and that of its stroke, as in Origami Simulator;
    the opacity of groups about it is none of it.
    """
    style = place.style
    paint = style.get("stroke", "none").strip()
    if paint.lower() == "currentcolor":
        paint = style.get("color", "black")
    if paint.lower() in _PAINTED:
        return None
    found = colours.parse(paint)
    colour, alpha = found or (None, 1.0)
    opacity = share(style.get("opacity", "1")) * share(style.get("stroke-opacity", "1")) * alpha
    return Look("", place.layers, colour, round(opacity, 9))
