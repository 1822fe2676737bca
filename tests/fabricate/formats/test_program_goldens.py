"""Programs in every language are the bytes they were, on whatever Python is installed."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import hand_made
import pytest

from foldmill_fabricate.formats import gcode, gpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Plan

if TYPE_CHECKING:
    from conftest import Golden


def on(slug: str) -> Plan:
    """Return the small job on a machine; a knife's lead-ins are another test's."""
    machine: Machine = hand_made.machine(slug)
    tools = machine.tools.model_copy(update={"firmware_offset": True})
    axes = machine.axes
    if axes.top is not None:
        axes = axes.model_copy(update={"top": 120.0})
    return hand_made.plan(machine.model_copy(update={"tools": tools, "axes": axes}))


def every() -> dict[str, bytes]:
    files = dict(gpgl.write(on("silhouette-like"), hand_made.fold()))
    for slug in ("grbl-drag-knife", "grbl-laser"):
        files |= gcode.write(on(slug), hand_made.fold())
    return files


PROGRAMS = every()


@pytest.mark.parametrize("name", PROGRAMS)
def test_programs_are_as_they_were(name: str, golden: Golden) -> None:
    golden.check(f"hand-made/{name}", PROGRAMS[name])


NEEDS = "import numpy, pydantic, pluggy, shapely, ezdxf, scipy, pytest"


def pythons() -> list[str]:
    """Return this Python, and the newest other one that has the packages foldmill needs."""
    here = f"python3.{sys.version_info.minor}"
    for name in (f"python3.{minor}" for minor in range(20, 10, -1)):
        found = None if name == here else shutil.which(name)
        if found and not subprocess.run([found, "-c", NEEDS], capture_output=True).returncode:
            return [sys.executable, found]
    return [sys.executable]


@pytest.mark.parametrize("python", pythons())
def test_bytes_are_the_same_in_another_process(python: str) -> None:
    code = (
        "import hashlib\n"
        "from fabricate.formats.test_program_goldens import every\n"
        "files = every()\n"
        "print(hashlib.sha256(b''.join(files[name] for name in sorted(files))).hexdigest())"
    )
    tests = str(Path(hand_made.__file__).parent)
    folders = [
        tests,
        *(str(Path(tests).parent / name) for name in ("core", "plugins", "fabricate")),
    ]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(folders), "PYTHONHASHSEED": "3"}
    said = subprocess.run(
        [python, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    joined = b"".join(PROGRAMS[name] for name in sorted(PROGRAMS))
    assert said.stdout.strip() == hashlib.sha256(joined).hexdigest()
