"""Files are there whole or not at all, and what cannot be written is named."""

from __future__ import annotations

from pathlib import Path

import pytest

from foldmill_fabricate.files import require_place, write_whole


def test_a_file_that_cannot_be_written_is_named_and_not_its_draft(tmp_path: Path) -> None:
    taken = tmp_path / "taken.csv"
    taken.mkdir()
    with pytest.raises(OSError, match="directory") as told:
        write_whole(taken, b"rows")
    assert told.value.filename == str(taken)
    assert list(tmp_path.iterdir()) == [taken]


def test_asking_for_a_place_leaves_nothing_there(tmp_path: Path) -> None:
    require_place(tmp_path / "deep" / "down" / "a.csv")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").write_text("")
    with pytest.raises(NotADirectoryError) as told:
        require_place(tmp_path / "file" / "deep" / "a.csv")
    assert told.value.filename == str(tmp_path / "file" / "deep" / "a.csv")
