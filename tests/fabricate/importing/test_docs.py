"""The page on importing says what is so: its options exist, and its example is a reader."""

from __future__ import annotations

import re
import sys
from importlib.metadata import EntryPoint
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import pytest
from command import Run

from foldmill import UnreadableFile, registry
from foldmill.exchange.options import Options
from foldmill_fabricate.hooks import READERS
from foldmill_fabricate.importing import read_pattern, reading

PAGE = (Path(__file__).parents[3] / "docs" / "importing.md").read_text("utf-8")
SHEET = b"B 0 0 90 0\nB 90 0 0 90\nB 0 90 0 0\nM 0 0 45 45\n"


def test_every_option_of_the_page_is_one_of_the_command(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    foldmill = Run(capsys, monkeypatch)
    told = foldmill("plan", "--help").out + foldmill("check", "--help").out
    named = set(re.findall(r"--[a-z][a-z-]*", PAGE))
    assert named
    assert {option for option in named if option not in told} == set()


def test_the_reader_of_the_page_is_a_plugin_that_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    example = dedent(PAGE[PAGE.index("    from foldmill import hookimpl") :])
    module = ModuleType("a_reader")
    exec(compile(example, "a_reader", "exec"), module.__dict__)
    monkeypatch.setitem(sys.modules, "a_reader", module)
    points = [
        EntryPoint("a-reader", "a_reader", "foldmill"),
        EntryPoint("fabricate", "foldmill_fabricate.builtin", "foldmill"),
    ]
    loaded = registry.load(points)
    assert not loaded.broken
    assert set(loaded.of(READERS)) == {"cp", "dxf", "fold", "opx", "plain", "svg"}
    monkeypatch.setattr(reading, "installed", lambda: loaded)
    found = read_pattern(SHEET, Options(scale=2.0), name="x.plain")
    assert found.format == "plain"
    assert found.fold.pattern.letters().count("M") == 1
    assert found.fold.pattern.vertices.max() == 180
    with pytest.raises(UnreadableFile):
        read_pattern(b"B 0 0 1 1", name="x.plain")
