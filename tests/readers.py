"""Programs by other people that read our files; a test skips where one is not installed.

``make tools`` installs them: some for the whole machine, and those of Python and of node into a
folder of their own, ``FOLDMILL_TOOLS`` or foldmill-tools in the user's cache.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import pytest

JUDGE = Path(__file__).parent / "third_party" / "readers" / "judge.js"
_MILLIMETRE = 96 / 25.4
"""Pixels of a drawing without units."""


class Layer(NamedTuple):
    """What a program read of one layer."""

    paths: int
    box: tuple[float, float, float, float]
    """mm: left, low, right, high; as the program has them, y up or down."""


def tools() -> Path:
    """Return the folder with readers that are not installed for the whole machine."""
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(os.environ.get("FOLDMILL_TOOLS") or Path(cache) / "foldmill-tools")


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


def judged(files: Sequence[Path], *options: str) -> dict[str, Any]:
    """Return what Rabbit Ear and FOLD's own library say of FOLD files, by name."""
    modules, node = tools() / "node" / "node_modules", shutil.which("node")
    if node is None or not (modules / "rabbit-ear").exists():
        pytest.skip("node with fold and rabbit-ear is not installed")
    command: list[str | Path] = [node, JUDGE, modules, *options, *files]
    said = subprocess.run(command, capture_output=True, text=True, check=True)
    found: dict[str, Any] = json.loads(said.stdout)
    return found


def inkscape(script: str, content: bytes, name: str, folder: Path, *options: str) -> str:
    """Return what one of Inkscape's own extensions makes of a file.

    They run without Inkscape's window, by the Python that its package depends on.
    """
    command, python = shutil.which("inkscape"), Path("/usr/bin/python3")
    if command is None or not python.exists():
        pytest.skip("inkscape is not installed")
    asked = subprocess.run(
        [command, "--system-data-directory"], capture_output=True, text=True, check=True
    )
    (folder / name).write_bytes(content)
    words: list[str | Path] = [python, script, *options, folder / name]
    said = subprocess.run(
        words,
        cwd=Path(asked.stdout.strip()) / "extensions",
        env={"PATH": "/usr/bin:/bin", "HOME": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )
    return said.stdout


def inkscape_layers(svg: str) -> dict[str, Layer]:
    """Return the layers with lines of a drawing that an importer made, by label."""
    root = ElementTree.fromstring(svg)
    scale = 1.0 if root.attrib["width"].endswith("mm") else _MILLIMETRE
    found = {}
    for group in root:
        label = next((v for k, v in group.attrib.items() if k.endswith("label")), None)
        paths = [path.attrib["d"] for path in group if path.tag.endswith("path")]
        if label and paths:
            numbers = [float(n) / scale for n in re.findall(r"-?[\d.]+", " ".join(paths))]
            xs, ys = numbers[::2], numbers[1::2]
            found[label] = Layer(len(paths), (min(xs), min(ys), max(xs), max(ys)))
    return found


_VPYPE = """
import json, sys, vpype_cli
document = vpype_cli.execute("read " + sys.argv[1])
mm = 25.4 / 96
print(json.dumps({
    number: [layer.property("vp_name"), len(layer), [each * mm for each in layer.bounds()]]
    for number, layer in document.layers.items()
}))
"""


def vpype_layers(drawing: bytes, folder: Path) -> dict[int, tuple[str, Layer]]:
    """Return the layers that vpype reads from an SVG drawing: label and lines, by number."""
    python = _python("vpype")
    (folder / "v.svg").write_bytes(drawing)
    said = subprocess.run(
        [python, "-c", _VPYPE, folder / "v.svg"], capture_output=True, text=True, check=True
    )
    return {
        int(number): (name, Layer(paths, tuple(box)))
        for number, (name, paths, box) in json.loads(said.stdout.splitlines()[-1]).items()
    }


def hpgl_buddy(program: bytes, folder: Path) -> tuple[int, list[str]]:
    """Return the exit code of hpgl-buddy's check of a program, and its warnings."""
    python = _python("hpgl-buddy")
    (folder / "b.hpgl").write_bytes(program)
    command: list[str | Path] = [python.parent / "hpgl-buddy", "check", folder / "b.hpgl"]
    said = subprocess.run(command, capture_output=True, text=True, check=False)
    told = said.stderr + said.stdout
    return said.returncode, [line for line in told.splitlines() if "WARNING: " in line]


def _python(package: str) -> Path:
    python = tools() / "python" / "bin" / "python"
    if not (python.parent / package).exists():
        pytest.skip(f"{package} is not installed")
    return python
