"""A process that computes for somebody ends at its limits, and who waits for it can say why."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from foldmill_fabricate.confining import PLANNING, Limits

LIMITS = Limits(seconds=1, memory_mb=200, file_mb=1)
CONFINED = f"""
from pathlib import Path
from foldmill_fabricate.confining import Limits, TooMuch, confine, refusing
limits = Limits{LIMITS.seconds, LIMITS.memory_mb, LIMITS.file_mb}
confine(limits)
try:
    with refusing(limits, "It"):
        {{work}}
except TooMuch as error:
    print(error, end="")
"""


def confined(work: str, folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", CONFINED.format(work=work)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("work", "sentence"),
    [
        ("held = bytearray(400 << 20)", LIMITS.too_large("It")),
        ("held = [bytes(1 << 16) for _ in range(1 << 14)]", LIMITS.too_large("It")),
        ("Path('file').write_bytes(bytes(2 << 20))", LIMITS.too_long("It")),
        ("held = bytearray(50 << 20)", ""),
    ],
)
def test_memory_and_files_beyond_the_limit_are_refused_from_within(
    work: str, sentence: object, tmp_path: Path
) -> None:
    ended = confined(work, tmp_path)
    assert (ended.stdout, ended.stderr, ended.returncode) == (str(sentence), "", 0)


def test_processor_time_beyond_the_limit_ends_the_process_and_whoever_waits_knows_why(
    tmp_path: Path,
) -> None:
    ended = confined("\n        ".join(["while True:", "    pass"]), tmp_path)
    assert ended.returncode < 0
    assert str(LIMITS.after(-ended.returncode, "It")) == str(LIMITS.late("It"))


def test_a_process_that_ends_by_itself_met_no_limit() -> None:
    assert PLANNING.after(-1, "It") is None  # ended with the code 1
