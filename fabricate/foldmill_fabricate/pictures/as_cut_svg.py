"""A face as it is cut, drawn as SVG in mm of the blank: for a browser, and to be measured."""

from __future__ import annotations

from xml.sax.saxutils import escape

from foldmill_fabricate.as_cut import FaceAsCut, Kind, Line

_LINE = "fill:none;stroke-linecap:round"
STYLES = {
    Kind.LEFT: "stroke:#c9ccd1;stroke-width:0.4",
    Kind.CERTAIN: "stroke:#111111;stroke-width:0.8",
    Kind.DOUBTFUL: "stroke:#d62728;stroke-width:1.6",
}


def as_cut_svg(face: FaceAsCut, title: str) -> bytes:
    """Draw a face as one looks at it; the same input gives the same bytes.

    Strokes lie in the groups left, certain and doubtful; of those in doubt each has its number.
    """
    width, height = face.width, face.height
    size = f'width="{width:g}mm" height="{height:g}mm" viewBox="0 0 {width:g} {height:g}"'
    groups = [
        f'<g id="{kind}" style="{_LINE};{style}">{_paths(face.of(kind), height)}</g>'
        for kind, style in STYLES.items()
    ]
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}>',
        f"<title>{escape(title)}</title>",
        f'<rect width="{width:g}" height="{height:g}" style="fill:#ffffff"/>',
        *groups,
        "</svg>",
    ]
    return ("\n".join(lines) + "\n").encode()


def _paths(lines: list[Line], height: float) -> str:
    return "".join(f'<path d="M{_points(line, height)}">{_named(line)}</path>' for line in lines)


def _named(line: Line) -> str:
    doubtful = line.kind is Kind.DOUBTFUL
    return f"<title>{escape(line.program)}: {line.number}</title>" if doubtful else ""


def _points(line: Line, height: float) -> str:
    return " ".join(f"{x:.2f},{height - y:.2f}" for x, y in line.points.tolist())
