"""The same jobs give the same bytes: twice, with other hash seeds, and on the newest Python."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from soaking import Soak

ROOT = Path(__file__).parents[2]
JOBS = ROOT / "tests" / "job_digests.py"


def digests(
    python: str | Path, folder: Path, seed: str, paths: list[str], options: tuple[str, ...]
) -> dict[str, str]:
    """Return what an interpreter makes of the jobs, file by file."""
    folder.mkdir()
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(paths)}
    words: list[str | Path] = [python, JOBS, folder, *options]
    said = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    found: dict[str, str] = json.loads(said.stdout)
    return found


def newest() -> Path:
    """Return the newest Python that is installed, of those above this one."""
    folders = [Path(each) for each in os.environ.get("PATH", "").split(os.pathsep)]
    folders += sorted((Path.home() / ".pyenv" / "versions").glob("*/bin"))
    found: dict[tuple[int, ...], Path] = {}
    for folder in folders:
        for python in folder.glob("python3.*"):
            if not re.fullmatch(r"python3\.\d+", python.name):
                continue
            asked: list[str | Path] = [python, "-c", "import sys; print(*sys.version_info[:3])"]
            said = subprocess.run(asked, capture_output=True, text=True, check=False)
            if said.returncode == 0:
                found[tuple(map(int, said.stdout.split()))] = python
    best = max(found, default=sys.version_info[:3])
    if best <= sys.version_info[:3]:
        pytest.skip("no Python above this one is installed")
    return found[best]


def test_soak_the_same_bytes_in_another_process_and_on_the_newest_python(
    tmp_path: Path, soak: Soak
) -> None:
    whole = ("--whole",) if soak.whole else ()
    one, two = (digests(sys.executable, tmp_path / seed, seed, sys.path, whole) for seed in "12")
    assert len(one) > (60 if whole else 15)
    assert one == two
    if not soak.whole:
        return  # an environment of another Python takes minutes to install
    theirs = installed(newest(), tmp_path / "env")
    with soak.part("newest-python", 0, len(one), "files") as progress:
        assert digests(theirs, tmp_path / "3", "3", [], whole) == one
        progress.reached(len(one))


def installed(python: Path, folder: Path) -> Path:
    """Return an interpreter with foldmill and the same libraries as here, installed anew."""
    subprocess.run([python, "-m", "venv", folder], check=True)
    theirs = folder / "bin" / "python"
    wanted = [f"{ROOT}[fast]", "-c", str(ROOT / "constraints.txt")]
    subprocess.run([theirs, "-m", "pip", "install", "--quiet", *wanted], check=True)
    return theirs
