"""What <use> sets in: which element of the same file, and where."""

from __future__ import annotations

from foldmill.errors import UnreadableFile
from foldmill.exchange.safe_xml import Element
from foldmill.exchange.svg import lengths
from foldmill.exchange.svg.transforms import Affine

_PAGES = {"symbol", "svg"}
"""Elements that are set in with a page of their own."""
_REMEDY = "Unlink its clones (Inkscape: Edit, Clone, Unlink Clones Recursively), and save it again."


def named(root: Element) -> dict[str, Element]:
    """Return the elements of a file by their ids; of equal ids the first, as browsers have it."""
    found: dict[str, Element] = {}
    for element in root.walk():
        if "id" in element.attributes:
            found.setdefault(element.attributes["id"], element)
    return found


def target(use: Element, known: dict[str, Element], open_: tuple[str, ...]) -> tuple[str, Element]:
    """Return the id and the element that a <use> sets in.

    open_ : ids of what is being set in. Raises UnreadableFile for another file, for what is not
    there, and for what is set into itself.
    """
    said = use.attributes
    link = (
        said.get("href") or next((v for k, v in said.items() if k.endswith(":href")), "")
    ).strip()
    name = link.removeprefix("#")
    if not link.startswith("#") and link:
        raise UnreadableFile(
            f"This drawing sets in {link[:60]!r}, from another file (<use>), and no other is "
            f"opened. {_REMEDY}"
        )
    if name not in known:
        raise UnreadableFile(
            f"This drawing sets in {name[:60]!r} (<use>), which is not in it. {_REMEDY}"
        )
    if name in open_:
        raise UnreadableFile(
            f"The part {name[:60]!r} of this drawing is set into itself (<use>). {_REMEDY}"
        )
    return name, known[name]


def place(use: Element) -> Affine:
    """Return how far a <use> moves what it sets in."""
    return 1.0, 0.0, 0.0, 1.0, lengths.px(use.attributes, "x"), lengths.px(use.attributes, "y")


def as_drawn(use: Element, element: Element) -> Element:
    """Return what is drawn: a symbol as a drawing in the drawing, as wide and high as used."""
    if element.name not in _PAGES:
        return element
    sizes = {k: use.attributes[k] for k in ("width", "height") if k in use.attributes}
    own = {
        k: v for k, v in element.attributes.items() if element.name == "svg" or k not in {"x", "y"}
    }
    return Element("svg", own | sizes, element.children)


def chosen(switch: Element) -> list[Element]:
    """Return the child of a <switch> that is drawn: the first that needs no extension, no language.

    Where all name a language it is the first; programs write them for texts.
    """
    able = [child for child in switch.children if not child.attributes.get("requiredExtensions")]
    plain = [child for child in able if "systemLanguage" not in child.attributes]
    return (plain or able)[:1]
