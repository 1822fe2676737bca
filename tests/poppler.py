"""What poppler's programs read from a PDF; a test skips where they are not installed."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pikepdf
import pytest
from numpy.typing import NDArray

Floats = NDArray[np.float64]
MM = 72 / 25.4
_SVG = "{http://www.w3.org/2000/svg}"
_HIDDEN = {f"{_SVG}{name}" for name in ("defs", "clipPath", "mask")}


def run(command: Sequence[str], pdf: bytes, folder: Path) -> str:
    """Run a program of poppler's on a PDF; return what it says."""
    program = shutil.which(command[0])
    if program is None:
        pytest.skip(f"{command[0]} is not installed")
    (folder / "x.pdf").write_bytes(pdf)
    said = subprocess.run(
        [program, *command[1:]], cwd=folder, capture_output=True, text=True, check=True
    )
    assert not said.stderr, said.stderr
    return said.stdout


def page_sizes(pdf: bytes, folder: Path) -> list[tuple[float, float]]:
    """Return width and height of each page, mm."""
    said = run(["pdfinfo", "-l", "-1", "x.pdf"], pdf, folder)
    found = re.findall(r"Page +\d+ size: +([\d.]+) x ([\d.]+) pts", said)
    return [(float(width) / MM, float(height) / MM) for width, height in found]


def pages(pdf: bytes, folder: Path) -> list[str]:
    """Return the words of each page, spaces and line ends as one space."""
    said = run(["pdftotext", "-layout", "x.pdf", "-"], pdf, folder)
    return [re.sub(r"\s+", " ", page) for page in said.split("\f")[:-1]]


def text(pdf: bytes, folder: Path) -> str:
    """Return the words of all pages, spaces and line ends as one space."""
    return " ".join(pages(pdf, folder))


def lines(pdf: bytes, folder: Path, page: int = 1) -> list[tuple[str, Floats]]:
    """Return colour and points (n, 2), mm from the lower left corner, of each stroked path.

    pdftocairo turns the page into SVG; a path may go beyond what is seen of it. It moves lines
    thinner than a pixel onto the screen's pixels, so it is given thicker ones.
    """
    command = ["pdftocairo", "-svg", "-noshrink", "-nocenter", "-f", str(page), "-l", str(page)]
    run([*command, "x.pdf", "x.svg"], _thick(pdf), folder)
    root = ElementTree.parse(folder / "x.svg").getroot()
    height = float(root.attrib["viewBox"].split()[3])
    found: list[tuple[str, Floats]] = []
    _collect(root, height, found)
    return found


def _thick(pdf: bytes) -> bytes:
    out = BytesIO()
    with pikepdf.open(BytesIO(pdf)) as read:
        for page in read.pages:
            thin = page.Contents.read_bytes()
            page.Contents = read.make_stream(thin.replace(b"0.25 w", b"0.5 w"))
        read.save(out)
    return out.getvalue()


def _collect(node: ElementTree.Element, height: float, found: list[tuple[str, Floats]]) -> None:
    for child in node:
        if child.tag in _HIDDEN:
            continue
        colour = re.search(r"stroke:(rgb\([^)]*\))", child.get("style", ""))
        if child.tag == f"{_SVG}path" and colour:
            data, closed, _ = child.attrib["d"].partition("Z")  # cairo moves back after it
            a, b, c, d, e, f = _matrix(child.get("transform", ""))
            x, y = np.array(re.findall(r"-?[\d.]+", data), float).reshape(-1, 2).T
            points = np.column_stack([a * x + c * y + e, height - (b * x + d * y + f)]) / MM
            found.append((colour[1], np.vstack([points, points[:1]]) if closed else points))
        _collect(child, height, found)


def _matrix(text: str) -> list[float]:
    found = re.findall(r"-?[\d.]+(?:e-?\d+)?", text)
    return [float(n) for n in found] if found else [1, 0, 0, 1, 0, 0]
