"""What foldmill itself offers through its own hooks: hook specifications, presets and formats."""

from __future__ import annotations

from collections.abc import Iterable
from types import ModuleType

from foldmill import hookimpl
from foldmill_fabricate import hooks, presets
from foldmill_fabricate.formats import cf2, dxf, gcode, gpgl, hpgl, pdf, places, programs, svg
from foldmill_fabricate.hooks import Format, Interpreter, Reader
from foldmill_fabricate.importing import builtin as importing
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.verify import languages


@hookimpl
def foldmill_hookspecs() -> list[ModuleType]:
    """Offer the hooks of formats, interpreters, machines, materials and readers."""
    return [hooks]


@hookimpl
def foldmill_materials() -> Iterable[Material]:
    """Offer the materials that lie beside the code."""
    return presets.shipped(Material, "foldmill_fabricate.materials")


@hookimpl
def foldmill_machines() -> Iterable[Machine]:
    """Offer the machines that lie beside the code."""
    return presets.shipped(Machine, "foldmill_fabricate.machines")


@hookimpl
def foldmill_formats() -> Iterable[Format]:
    """Offer the drawings and programs of ``foldmill_fabricate.formats``."""
    of_each = "programs of each set-up or face"
    return [
        Format("svg", "SVG drawing of each face and of both", svg.write, drawn=svg.write),
        Format("dxf", "DXF drawing of each face and of both", dxf.write, drawn=dxf.write),
        Format("hpgl", f"HP-GL {of_each}", hpgl.write, programs.layout, hpgl.program),
        Format("gp-gl", f"GP-GL {of_each}", gpgl.write, programs.layout, gpgl.program),
        Format("gcode", f"G-code {of_each}", gcode.write, programs.layout, gcode.program),
        Format("cf2", "CFF2 drawing of each face, for makers of dies", cf2.write, drawn=cf2.write),
        Format("pdf", "PDF drawing of each face and of both", pdf.write, drawn=pdf.write),
        *(
            Format(
                f"pdf-{paper}", f"PDF drawings over pages of {paper.upper()}", tiled, drawn=tiled
            )
            for paper, tiled in pdf.TILED.items()
        ),
        Format("places", "PNG with the places of what planning found", places.write),
    ]


@hookimpl
def foldmill_interpreters() -> Iterable[Interpreter]:
    """Offer the languages of programs that ``foldmill_fabricate.verify`` reads."""
    return [
        Interpreter("hpgl", "HP-GL", languages.hpgl),
        Interpreter("gp-gl", "GP-GL", languages.gpgl),
        Interpreter("gcode", "G-code of GRBL", languages.gcode),
    ]


@hookimpl
def foldmill_readers() -> Iterable[Reader]:
    """Offer the formats of crease patterns that ``foldmill_fabricate.importing`` reads."""
    return importing.readers()
