"""Pictures of what the simulator drew: each face as the machine saw it, so the reverse is mirrored.

Millimetres of the carrier, x right, y up; one group and one colour for each kind of work where the
plan is known, else for each tool setting; the same on both faces, in order of first use.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

from foldmill_fabricate.files import write_all
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.plotter.simulator import legend
from foldmill_fabricate.plotter.simulator.drawing import Drawn, DrawnSheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PICTURE = 180.0
"""mm"""

_SHEET = "fill:#ffffff;stroke:#c9ccd1;stroke-width:0.5"

Groups = dict[str, list[Drawn]]


def groups(strokes: list[Drawn]) -> Groups:
    """Sort strokes by tool, speed and force: "tool 1, 100 mm/s, 80 gf" → its strokes."""
    found: Groups = {}
    for stroke in strokes:
        force = "" if stroke.force is None else f", {stroke.force:g} gf"
        setting = f", {stroke.setting}" if stroke.setting else ""
        name = f"tool {stroke.tool}, {stroke.speed:g} mm/s{force}{setting}"
        found.setdefault(name, []).append(stroke)
    return found


def by_plan(strokes: list[Drawn], face: Face, plan: Plan, machine: Machine) -> Groups:
    """Sort strokes by what the plan makes with them: "scores, half-cut" → its strokes."""
    found: Groups = {}
    for name, stroke in zip(legend.by_plan(strokes, face, plan, machine), strokes, strict=True):
        found.setdefault(name, []).append(stroke)
    return found


def svg(found: Groups, machine: Machine, title: str, colours: Mapping[str, str]) -> bytes:
    """Draw one face as SVG: mm, viewBox in mm, deterministic bytes."""
    width, height = machine.bed.carrier_width, machine.bed.carrier_height
    size = f'width="{width:g}mm" height="{height:g}mm" viewBox="0 0 {width:g} {height:g}"'
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}>',
        f"<title>{escape(title)}</title>",
        f'<path d="M0,0 {width:g},0 {width:g},{height:g} 0,{height:g} Z" style="{_SHEET}"/>',
    ]
    for number, (name, members) in enumerate(found.items()):
        style = "fill:none;stroke-width:0.5;stroke-linecap:round;stroke-linejoin:round"
        lines.append(f'<g id="set-up-{number + 1}" style="{style};stroke:{colours[name]}">')
        lines.append(f"<title>{escape(name)}</title>")
        lines += [f'<path d="{_way(each, machine, height)}"/>' for each in members]
        lines.append("</g>")
    return "\n".join([*lines, "</svg>", ""]).encode()


def png(found: Groups, machine: Machine, title: str, colours: Mapping[str, str]) -> bytes:
    """Draw one face as PNG, with a legend; deterministic bytes."""
    with canvas.own_style():
        return canvas.png(_figure(found, machine, title, colours))


def _figure(found: Groups, machine: Machine, title: str, colours: Mapping[str, str]) -> Figure:
    width, height = machine.bed.carrier_width, machine.bed.carrier_height
    figure = canvas.figure(_PICTURE, _PICTURE * height / width)
    figure.set_layout_engine("constrained")
    axes = figure.add_subplot(
        xlim=(0, width), ylim=(0, height), aspect="equal", title=title, xlabel="mm", ylabel="mm"
    )
    for name, members in found.items():
        ways = [each.millimetres(machine.axes) for each in members]
        canvas.add_lines(axes, ways, color=colours[name], linewidth=1.0)
        canvas.legend_entry(axes, f"{name}: {len(members)}", color=colours[name])
    if found:
        figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    return figure


def draw(sheet: DrawnSheet, machine: Machine, folder: Path, plan: Plan | None = None) -> list[Path]:
    """Write front and reverse as SVG and PNG into a folder, each whole; return their paths.

    plan : the one whose programs were sent; without it only the machine's settings are known.
    """
    found = {face: _sorted(sheet.seen(face), face, plan, machine) for face in Face}
    colours = legend.colours([name for own in found.values() for name in own], plan)
    contents = {}
    for face, own in found.items():
        title = f"{face.capitalize()}, as {machine.slug} saw it"
        contents[f"{face}.svg"] = svg(own, machine, title, colours)
        contents[f"{face}.png"] = png(own, machine, title, colours)
    write_all(folder, contents)
    return [folder / name for name in contents]


def _sorted(strokes: list[Drawn], face: Face, plan: Plan | None, machine: Machine) -> Groups:
    return groups(strokes) if plan is None else by_plan(strokes, face, plan, machine)


def _way(stroke: Drawn, machine: Machine, height: float) -> str:
    points = [
        f"{_short(x)},{_short(height - y)}" for x, y in stroke.millimetres(machine.axes).tolist()
    ]
    return "M" + " ".join(points if len(points) > 1 else points * 2)  # a dot needs a second end


def _short(value: float) -> str:
    """Return mm to a tenth of a micrometre, without trailing zeros."""
    return f"{value:.4f}".rstrip("0").rstrip(".")
