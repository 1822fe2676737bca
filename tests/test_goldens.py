"""The comparison with golden files bites."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from conftest import Golden


def test_one_changed_number_in_a_golden_is_seen(golden: Golden) -> None:
    if golden.update:
        pytest.skip("golden files are being rewritten")
    name = "hand-made/3-reverse-score.hpgl"
    good = (golden.folder / name).read_bytes()
    golden.check(name, good)
    with pytest.raises(AssertionError, match="is another"):
        golden.check(name, good.replace(b"1", b"2", 1))
