"""The command foldmill, called in this process as a shell would call it."""

from __future__ import annotations

import sys
from typing import NamedTuple

import pytest

from foldmill_fabricate.cli import main


class Told(NamedTuple):
    """What a run of the command said."""

    code: int
    out: str
    err: str


class Run:
    """Call the command with its words; every run ends with an exit code."""

    def __init__(self, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
        self.capsys, self.monkeypatch = capsys, monkeypatch

    def __call__(self, *words: str) -> Told:
        self.monkeypatch.setattr(sys, "argv", ["foldmill", *words])
        with pytest.raises(SystemExit) as stop:
            main()
        said = self.capsys.readouterr()
        return Told(int(stop.value.code or 0), said.out, said.err)
