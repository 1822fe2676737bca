"""Programs by other people that read our files; a test skips where one is not installed."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest


def hp2xx_extent(program: bytes, folder: Path) -> list[int]:
    """Return the extent in steps that hp2xx reads from a program."""
    hp2xx = shutil.which("hp2xx")
    if hp2xx is None:
        pytest.skip("hp2xx is not installed")
    (folder / "p.hpgl").write_bytes(program)
    command = [hp2xx, "-N", "-t", "-m", "svg", "-f", "p.svg", "p.hpgl"]
    said = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    found = re.search(r"range: \((\d+), (\d+)\) ... \((\d+), (\d+)\)", said.stderr)
    assert found is not None
    return [int(n) for n in found.groups()]


def librecad_pdf(drawing: bytes, folder: Path) -> bytes:
    """Return what LibreCAD prints of a DXF drawing."""
    librecad, xvfb = shutil.which("librecad"), shutil.which("xvfb-run")
    if librecad is None or xvfb is None:
        pytest.skip("librecad or xvfb-run is not installed")
    (folder / "x.dxf").write_bytes(drawing)
    command = [xvfb, "-a", librecad, "dxf2pdf", "-a", "x.dxf"]
    subprocess.run(command, cwd=folder, capture_output=True, check=True, timeout=60)
    return (folder / "x.pdf").read_bytes()
