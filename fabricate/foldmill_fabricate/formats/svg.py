"""SVG cutting drawings: mm, named Inkscape layers, style attributes, flat coordinates.

Layer labels read ``ROLE Pen n Speed v Force f``: Inkscape's own HP-GL export then selects pen,
speed and force by layer, and vpype numbers its layers by pen. Layers without output have a pen of
their own and neither speed nor force.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from foldmill import Fold
from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.profiles import Profile, Style, find, legend

if TYPE_CHECKING:
    import svgwrite

STROKE = "fill:none;stroke:{};stroke-width:0.25"
"""Style of a line: thin, so that senders take it as a path and not as an area."""
DECIMALS = 4
"""Of a mm: a 250th of a plotter step."""


def write(plan: Plan, fold: Fold, style: Style | None = None) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return ``front.svg``, ``reverse.svg`` (as the machine sees it) and ``master.svg``.

    With them goes ``legend.svg``: what their layers are called, and what each is for.
    style : names and colours of layers.
    """
    profile = style.profile if style else find()
    views = list(d.drawings(plan, profile))
    drawn = {f"{view.name}.svg": one(plan, view) for view in views}
    return {**drawn, "legend.svg": _legend(plan, profile, views[-1])}


def number(value: float) -> str:
    """Return a coordinate without trailing zeros and without a negative zero."""
    return f"{round(value, DECIMALS) + 0.0:.{DECIMALS}f}".rstrip("0").rstrip(".")


def path(line: d.Floats, height: float) -> str:
    """Return the path data of a line (n, 2), turned to SVG's y downward."""
    closed = d.is_closed(line)
    points = line[:-1] if closed else line
    pairs = [f"{number(x)},{number(height - y)}" for x, y in points.tolist()]
    return "M " + " L ".join(pairs) + (" Z" if closed else "")


def canvas(width: float, height: float) -> svgwrite.Drawing:
    """Return an empty drawing of this size: mm outside, mm inside."""
    import svgwrite

    size = (f"{number(width)}mm", f"{number(height)}mm")
    box = f"0 0 {number(width)} {number(height)}"
    return svgwrite.Drawing(size=size, viewBox=box, debug=False)


def to_bytes(drawing: svgwrite.Drawing, paths: Mapping[str, list[str]] | None = None) -> bytes:
    """Return the file: indented, UTF-8, newline at its end.

    paths : data of many paths, each in a line like that of the path whose data is their key.
    """
    from io import StringIO

    out = StringIO()
    drawing.write(out, pretty=True, indent=1)
    text = out.getvalue()
    for key, data in (paths or {}).items():
        begin = text.rindex("\n", 0, text.index(key))
        row = text[begin : text.index("\n", begin + 1)]
        text = text.replace(row, "".join(row.replace(key, each) for each in data))
    return text.encode("utf-8")


def one(plan: Plan, view: d.Drawing) -> bytes:
    """Return one drawing as an SVG file; of the plan only what its machine is told."""
    from svgwrite.extensions import Inkscape

    svg = canvas(view.width, view.height)
    layers = Inkscape(svg)
    svg.set_desc(title=view.note)
    marks = d.Group(view.layers.anchor, None, tuple(d.anchors(view.width, view.height)))
    paths = {}
    for number, group in enumerate((*view.groups, marks)):
        layer = layers.layer(label=_label(plan, group))
        key = f"ANCHOR-{number}-"  # stands in for all paths of its layer: they are many
        layer.add(svg.path(d=key, style=STROKE.format(group.layer.colour)))
        paths[key] = [path(line, view.height) for line in group.lines]
        svg.add(layer)
    note = layers.layer(label=_label(plan, d.Group(view.layers.note, None, ())))
    note.add(_text(svg, view))
    svg.add(note)
    return to_bytes(svg, paths)


def _label(plan: Plan, group: d.Group) -> str:
    if group.setup is None:  # a pen all the same: vpype would give it that of another layer
        return f"{group.layer.name} Pen {group.layer.pen}"
    selects = plan.machine.tools.change == "select" and group.setup.tool
    pen = group.setup.tool if selects else group.layer.pen
    speed, force = hpgl.speed(group.setup), hpgl.force(group.setup)
    return f"{group.layer.name} Pen {pen} Speed {speed} Force {force}"


def _text(svg: svgwrite.Drawing, view: d.Drawing) -> svgwrite.text.Text:
    x, y = d.NOTE_AT
    style = f"font-family:sans-serif;font-size:{d.NOTE_HEIGHT}px;fill:{view.layers.note.colour}"
    return svg.text(view.note, insert=(number(x), number(view.height - y)), style=style)


ROW = 8.0
"""mm between the lines of a legend."""
_COLUMNS = (6.0, 40.0, 90.0, 112.0, 134.0)
"""mm. Left ends of its columns; the page is as wide as an A4 sheet that lies."""


def _legend(plan: Plan, profile: Profile, master: d.Drawing) -> bytes:
    """Return a page that says what each layer of the drawings is for."""
    silent = {id(master.layers.note), id(master.layers.anchor)}
    used = {id(group.layer) for group in master.groups} | silent
    rows = [row for row in legend(profile) if id(row.look) in used]
    svg = canvas(297.0, ROW * (len(rows) + 3))
    _row(svg, 1, [f"{plan.title}: what the layers of its drawings are (profile {profile.slug})"])
    _row(svg, 2, ["", "layer, pen", "in SVG", "in DXF", "for"])
    for place, (look, about) in enumerate(rows, 3):
        y = number(place * ROW - 1)
        data = f"M {number(_COLUMNS[0])},{y} L {number(_COLUMNS[1] - 4)},{y}"
        svg.add(svg.path(d=data, style=f"fill:none;stroke:{look.colour};stroke-width:1"))
        called = f"{look.name}, {look.pen}"
        _row(svg, place, ["", called, look.colour, f"colour {look.aci}", about])
    return to_bytes(svg)


def _row(svg: svgwrite.Drawing, row: int, cells: list[str]) -> None:
    style = "font-family:sans-serif;font-size:3.5px;fill:#000000"
    for x, cell in zip(_COLUMNS, cells, strict=False):
        if cell:
            svg.add(svg.text(cell, insert=(number(x), number(row * ROW)), style=style))
