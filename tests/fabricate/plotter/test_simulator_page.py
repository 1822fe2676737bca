"""The page about the simulator tells everything there is, and its examples work."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from foldmill_fabricate.cli.app import app
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.faults import Trouble, parse
from foldmill_fabricate.plotter.simulator.quirks import Quirk
from foldmill_fabricate.plotter.simulator.run import COMMANDS

PAGE = (Path(__file__).parents[3] / "docs" / "simulator.md").read_text("utf-8")


@pytest.mark.parametrize("name", [*Trouble, *Quirk])
def test_every_fault_and_quirk_has_its_line(name: str) -> None:
    assert f"| `{name}` |" in PAGE


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_told(name: str) -> None:
    assert f"`{name}" in PAGE


def test_every_option_of_the_command_is_told() -> None:
    (command,) = [each for each in app.registered_commands if each.callback.__name__ == "simulate"]  # type: ignore[union-attr]
    names = [
        each.replace("_", "-") for each in command.callback.__annotations__ if each != "return"
    ]
    assert len(names) > 9
    assert [name for name in names if f"--{name}" not in PAGE] == []


def test_every_fault_that_is_written_out_is_one() -> None:
    written = re.findall(r"[a-z]+@[0-9.a-z]+(?::[0-9.]+s?)?", PAGE)
    assert len(written) > 4
    for each in written:
        assert len(parse(each)) == 1


def test_the_example_in_python_prints_what_the_page_says(
    capsys: pytest.CaptureFixture[str],
) -> None:
    (example,) = re.findall(r"^    import serial\n(?:    .*\n|\n)+", PAGE, re.MULTILINE)
    devices.unplug("sim://generic-hpgl-600?buffer=255")
    exec(re.sub(r"^    ", "", example, flags=re.MULTILINE), {})
    said = capsys.readouterr().out
    assert said.startswith(r"b'20000,0,0\r' 5")
