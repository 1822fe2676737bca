"""What the page on surfaces of one's own tells people to type is what can be typed."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from foldmill_fabricate.cli.parameters import gather
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.taylor import FUNCTIONS

PAGE = (Path(__file__).parents[2] / "docs" / "waterbomb-surfaces.md").read_text("utf-8")
LINES = re.findall(r"^    foldmill design waterbomb (.*) -o \S+$", PAGE, re.MULTILINE)


@pytest.mark.parametrize("line", [line for line in LINES if "mask.stl" not in line])
def test_a_command_of_the_page_gives_a_form_without_fault(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    y, x = np.mgrid[-1:1:30j, -1:1:40j]
    monkeypatch.chdir(tmp_path)
    np.savetxt("hill.csv", np.exp(-2 * (x**2 + y**2)), delimiter=",")
    words = [word.replace("hill.png", "hill.csv") for word in shlex.split(line)]
    preset = words[1] if words[0] == "--preset" else None
    params: Any = gather(DESIGN, preset, None, words[2:] if preset else words)
    assert DESIGN.run(params).meta["status"]["verdicts"] == ["ok"]


def test_the_file_of_the_page_is_the_monkey_saddle(tmp_path: Path) -> None:
    (block,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "saddle.toml").write_text(block)
    assert gather(DESIGN, None, tmp_path / "saddle.toml", []) == DESIGN.presets["monkey-saddle"]


def test_the_page_names_every_function() -> None:
    listed = " ".join(PAGE.split("brackets and `")[1].split("`")[0].split())
    assert listed.split() == list(FUNCTIONS)
