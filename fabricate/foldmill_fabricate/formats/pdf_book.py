"""A PDF with layers and spot colours, whose pages are drawn in mm.

Every layer is an optional-content group, and says in the words of ISO 19593-1 which step of the
work its lines are for: group Structural with a type, or group Legend for what is only read. Its
lines are stroked in a spot colour of its name (a Separation), because that is what the software of
print-and-cut machines goes by; on a screen the colour of the profile stands in for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from io import BytesIO
from typing import TYPE_CHECKING

from foldmill_fabricate.errors import CannotWrite
from foldmill_fabricate.formats.drawing import Floats, is_closed
from foldmill_fabricate.formats.pdf_letters import CAPITALS, Letters
from foldmill_fabricate.formats.svg import number
from foldmill_fabricate.profiles import Layer

if TYPE_CHECKING:
    from pikepdf import Dictionary, Object

POINTS = 72 / 25.4
"""Points in a mm."""
LONGEST = 14_400 / POINTS
"""mm. PDF readers know no longer side of a page: 200 inches."""
WIDTH = 0.25
"""mm. Thin, so that software takes a line as a path and not as an area."""
LEGEND = "Legend"
"""The group of what people read; it has no types."""


class Book:
    """A PDF that is being made: its layers and spot colours are shared by all its pages."""

    def __init__(self, title: str) -> None:
        import pikepdf

        self.pdf = pikepdf.new()
        self.pdf.docinfo["/Title"] = title
        self.pdf.docinfo["/Creator"] = "foldmill"
        self._letters = Letters()
        self._layers: dict[str, str] = {}
        self._spots: dict[str, str] = {}
        self._layers_made = pikepdf.Dictionary()
        self._spots_made = pikepdf.Dictionary()
        self._forms_made = pikepdf.Dictionary()
        self._resources = self.pdf.make_indirect(
            pikepdf.Dictionary(
                ExtGState=pikepdf.Dictionary(G=_overprint()),
                Properties=self._layers_made,
                ColorSpace=self._spots_made,
                XObject=self._forms_made,
            )
        )

    def layer(self, look: Layer, step: str, content: str) -> str:
        """Return operators that draw ``content`` in a layer and its spot colour.

        step : the type of ISO 19593-1's group Structural, or LEGEND. One layer per name.
        """
        if look.name not in self._layers:
            self._add_layer(look.name, step)
        spot = self._spots.get(look.name) or self._add_spot(look)
        return (
            f"/OC /{self._layers[look.name]} BDC\n"
            f"/{spot} CS 1 SCN\n/{spot} cs 1 scn\n{content}EMC\n"
        )

    def form(self, width: float, height: float, content: str) -> str:
        """Keep a drawing, in mm, that several pages show; return its name for ``Do``."""
        import pikepdf

        name = f"D{len(self._forms_made)}"
        stream = self.pdf.make_stream(content.encode("ascii"))
        stream.stream_dict.update(
            {"/Type": pikepdf.Name.XObject, "/Subtype": pikepdf.Name.Form}
            | {"/BBox": pikepdf.Array([0, 0, _real(width), _real(height)])}
            | {"/Resources": self._resources}
        )
        self._forms_made["/" + name] = stream
        return name

    def words(self, text: str, x: float, y: float, capitals: float) -> str:
        """Return operators that write a line of words, its baseline's left end at x, y mm.

        capitals : their height, mm.
        """
        size, shown = number(capitals / CAPITALS), self._letters.encoded(text)
        return f"BT /F {size} Tf {number(x)} {number(y)} Td {shown} Tj ET\n"

    def page(self, width: float, height: float, content: str) -> None:
        """Add a page of this size, mm, whose content is drawn in mm from its lower left corner.

        Raises CannotWrite where a side is longer than PDF readers know.
        """
        import pikepdf

        if max(width, height) > LONGEST:
            raise CannotWrite(
                f"The sheet is {width:g} × {height:g} mm, and a page of a PDF ends at "
                f"{LONGEST:.0f} mm. Write pdf-a3 or pdf-a4, or svg and dxf, which have no end."
            )
        scaled = f"q\n{POINTS:.12f} 0 0 {POINTS:.12f} 0 0 cm\n/G gs\n{WIDTH:g} w\n{content}Q\n"
        box = pikepdf.Array([0, 0, _real(width * POINTS), _real(height * POINTS)])
        page = pikepdf.Dictionary(
            Type=pikepdf.Name.Page,
            MediaBox=box,
            TrimBox=box,
            Resources=self._resources,
            Contents=self.pdf.make_stream(scaled.encode("ascii")),
        )
        self.pdf.pages.append(pikepdf.Page(self.pdf.make_indirect(page)))

    def to_bytes(self) -> bytes:
        """Return the file: the same bytes for the same pages, without date and serial number."""
        import pikepdf

        font = self.pdf.make_indirect(self._letters.font(self.pdf))
        self._resources["/Font"] = pikepdf.Dictionary(F=font)
        groups = pikepdf.Array(list(self._layers_made.values()))
        self.pdf.Root.OCProperties = pikepdf.Dictionary(
            OCGs=groups, D=pikepdf.Dictionary(Order=groups, ON=groups)
        )
        out = BytesIO()
        self.pdf.save(out, deterministic_id=True, min_version="1.6")
        return out.getvalue()

    def _add_layer(self, name: str, step: str) -> None:
        import pikepdf

        metadata = {"/GTS_ProcStepsGroup": pikepdf.Name.Structural}
        metadata["/GTS_ProcStepsType"] = pikepdf.Name("/" + step)
        if step == LEGEND:
            metadata = {"/GTS_ProcStepsGroup": pikepdf.Name.Legend}
        group = pikepdf.Dictionary(
            Type=pikepdf.Name.OCG, Name=name, GTS_Metadata=pikepdf.Dictionary(metadata)
        )
        self._layers[name] = key = f"L{len(self._layers)}"
        self._layers_made["/" + key] = self.pdf.make_indirect(group)

    def _add_spot(self, look: Layer) -> str:
        import pikepdf

        tint = pikepdf.Dictionary(
            FunctionType=2,
            Domain=[0, 1],
            C0=[0, 0, 0, 0],
            C1=[_real(part) for part in _cmyk(look.colour)],
            N=1,
        )
        space = [pikepdf.Name.Separation, pikepdf.Name("/" + look.name), pikepdf.Name.DeviceCMYK]
        self._spots[look.name] = key = f"S{len(self._spots)}"
        made = self.pdf.make_indirect(pikepdf.Array([*space, tint]))
        self._spots_made["/" + key] = made
        return key


def strokes(lines: Iterable[Floats]) -> str:
    """Return operators that stroke each line (n, 2) mm as a path of its own."""
    parts = []
    for line in lines:
        ends = is_closed(line)
        points = line[:-1].tolist() if ends else line.tolist()
        pairs = [f"{number(x)} {number(y)}" for x, y in points]
        parts.append(" m\n".join(pairs[:2]) + " l\n" + "".join(f"{p} l\n" for p in pairs[2:]))
        parts.append("s\n" if ends else "S\n")
    return "".join(parts)


def _overprint() -> Dictionary:
    """Lines of a step are printed over what is below them, which they leave as it is."""
    from pikepdf import Dictionary, Name

    return Dictionary(Type=Name.ExtGState, OP=True, op=True, OPM=1)


def _cmyk(colour: str) -> Sequence[float]:
    """Return what stands in for #rrggbb where four inks are printed, each 0 to 1."""
    red, green, blue = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    white = max(red, green, blue)
    if not white:
        return 0.0, 0.0, 0.0, 1.0
    return (*(1 - each / white for each in (red, green, blue)), 1 - white)


def _real(value: float) -> Object:
    from decimal import Decimal

    return Decimal(number(value))  # type: ignore[return-value]
