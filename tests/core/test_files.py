"""A fence keeps files that parameters name within a folder, or keeps all of them out."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from foldmill import UnreadableFile
from foldmill.files import VARIABLE, content, fence_process, fenced


@pytest.fixture
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv(VARIABLE, raising=False)
    (tmp_path / "secret.txt").write_text("secret")
    folder = tmp_path / "inside"
    folder.mkdir()
    (folder / "hill.txt").write_text("hill")
    (folder / "link.txt").symlink_to(tmp_path / "secret.txt")
    (folder / "own.txt").symlink_to(folder / "hill.txt")
    return folder


def refused(name: str) -> str:
    with pytest.raises(UnreadableFile) as told:
        content(name, 100)
    return str(told.value)


def test_without_a_fence_any_file_is_read(inside: Path) -> None:
    assert content(str(inside / "hill.txt"), 100) == b"hill"
    assert content(str(inside / "link.txt"), 100) == b"secret"
    assert refused(str(inside / "no.txt")).startswith("There is no file")
    assert refused(str(inside)).startswith("There is no file")


def test_within_a_fence_names_are_taken_from_its_folder(inside: Path) -> None:
    with fenced(inside):
        for name in ("hill.txt", str(inside / "hill.txt"), "./hill.txt", "own.txt"):
            assert content(name, 100) == b"hill"
        assert refused("no.txt") == "There is no file no.txt."


@pytest.mark.parametrize(
    "name", ["../secret.txt", "link.txt", "/etc/passwd", "../no.txt", "x/../../secret.txt"]
)
def test_what_is_outside_is_refused_whether_it_is_there_or_not(name: str, inside: Path) -> None:
    with fenced(inside):
        assert "is outside the folder" in refused(name)
        assert "is outside the folder" in refused(str(inside.parent / "no.txt"))
    with fenced(None):
        assert "may not name files here" in refused(name)
        assert "may not name files here" in refused("hill.txt")


def test_a_fence_within_another_only_narrows_it(inside: Path) -> None:
    with fenced(inside):
        with fenced(inside.parent):
            assert "may not name files" in refused("hill.txt")
        with fenced(None):
            assert "may not name files" in refused("hill.txt")
        assert content("hill.txt", 100) == b"hill"
    with fenced(inside.parent), fenced(inside):
        assert content("hill.txt", 100) == b"hill"
    assert content(str(inside / "link.txt"), 100) == b"secret"


def test_a_fence_round_the_process_holds_in_threads_and_children(
    inside: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(VARIABLE, "")
    fence_process(inside)
    assert os.environ[VARIABLE] == str(inside)
    said: list[str] = []
    thread = threading.Thread(target=lambda: said.append(refused("../secret.txt")))
    thread.start()
    thread.join()
    assert "is outside the folder" in said[0]
    with fenced(inside.parent):  # both must allow it
        assert content("inside/hill.txt", 100) == b"hill"
        assert "is outside the folder" in refused("secret.txt")
    code = "from foldmill.files import content; print(content('../secret.txt', 100))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 1
    assert "is outside the folder" in run.stderr
    fence_process(None)
    assert "may not name files" in refused("hill.txt")


def test_a_file_too_large_or_none_at_all_is_refused(inside: Path) -> None:
    assert content(str(inside / "hill.txt"), 4) == b"hill"
    with pytest.raises(UnreadableFile, match="is larger than 3e-06 MB"):
        content(str(inside / "hill.txt"), 3)
    assert "cannot be read" in refused("a\0b") or "There is no file" in refused("a\0b")
    fifo = inside / "pipe"
    os.mkfifo(fifo)
    assert refused(str(fifo)).startswith("There is no file")
