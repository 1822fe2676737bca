"""The page on registration says what planning says."""

from __future__ import annotations

import re
from importlib import util
from pathlib import Path

from stools import machine, material, stool, stool_plan

from foldmill_fabricate import presets
from foldmill_fabricate.cli.choices import RegistrationChoice
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plan import make

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "registration.md").read_text(encoding="utf-8")
TOML = Path(presets.__file__).parent / "machines" / "generic-hpgl-600.toml"


def test_the_table_of_errors_is_the_one_that_is_reckoned() -> None:
    spec = util.spec_from_file_location("registration", ROOT / "examples" / "registration.py")
    assert spec is not None
    assert spec.loader is not None
    example = util.module_from_spec(spec)
    spec.loader.exec_module(example)
    edge = make(stool(), material(), machine(), register="edge")
    rows = example.table({"holes": stool_plan(), "edge": edge}).splitlines()
    assert len(rows) == 4
    for row in rows:
        assert row in PAGE


def test_its_pictures_and_every_kind_are_there() -> None:
    pictures = re.findall(r"\]\((pictures/.*?)\)", PAGE)
    assert len(pictures) == 5
    for name in pictures:
        assert (ROOT / "docs" / name).is_file()
    for kind in RegistrationChoice:
        assert f"`{kind.value}`" in PAGE


def test_the_offset_it_shows_is_one_a_machine_reads() -> None:
    shown = "\n".join(line.strip() for line in PAGE.split("    [two_sides]")[1].splitlines()[:6])
    text = TOML.read_text(encoding="utf-8") + "\n[two_sides]\n" + shown
    read = presets.read(Machine, text, "mine.toml").two_sides
    assert (read.dx, read.dy, read.angle, read.flip) == (0.35, -0.2, 0.05, "left-right")
