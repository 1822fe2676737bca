from __future__ import annotations

from pathlib import Path

import pytest
from command import Run


@pytest.fixture
def foldmill(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Run:
    """Return the command, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return Run(capsys, monkeypatch)
