"""What a command says lies readably on a terminal of 80 columns, and whole in a file."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate.cli.layout import LEAST, hanging, table

ROWS = [
    ("FAMILY", "TITLE", "PRESETS"),
    ("tuck", "Axisymmetric form with tucks", ", ".join(f"stool-n{n}" for n in range(4, 24))),
    ("waterbomb", "Waterbomb tessellation on a target surface", "catenoid, cylinder, helicoid"),
]
words = st.lists(st.text("abcd", min_size=1, max_size=LEAST), min_size=1, max_size=20)


def test_a_table_in_a_file_has_one_line_for_each_row() -> None:
    assert len(table(ROWS).splitlines()) == len(ROWS)


def test_no_line_of_a_table_is_wider_than_the_terminal() -> None:
    lines = table(ROWS, 80).splitlines()

    assert max(map(len, lines)) <= 80
    assert len(lines) > len(ROWS)
    starts = {line.index(word) for word, line in zip(("TITLE", "Axis"), lines[:2], strict=True)}
    assert len(starts) == 1, "columns stand under their heads"


@given(rows=st.lists(st.tuples(words, words, words), min_size=1, max_size=5))
def test_a_narrow_table_loses_no_word(rows: list[tuple[list[str], ...]]) -> None:
    made = table([(" ".join(a), " ".join(b), " ".join(c)) for a, b, c in rows], 50)

    assert sorted(made.split()) == sorted(word for row in rows for cell in row for word in cell)
    assert max(map(len, made.splitlines())) <= 50


@pytest.mark.parametrize("width", [30, 80])
def test_a_long_sentence_goes_on_under_its_beginning(width: int) -> None:
    sentence = "warning  " + "Try depth and folding on a piece of waste first. " * 4
    first, *rest = hanging(sentence.strip(), " " * 9, width).splitlines()

    assert first.startswith("warning")
    assert rest
    assert all(line.startswith(" " * 9) and len(line) <= width for line in rest)
    assert " ".join(" ".join([first, *rest]).split()) == " ".join(sentence.split())


def test_a_column_of_names_is_as_wide_as_the_longest_of_them() -> None:
    lines = table([("half-cut.min_scored_angle", "0 deg", "an estimate " * 20)], 60).splitlines()

    assert lines[0].startswith("half-cut.min_scored_angle  0 deg  an")
    assert max(map(len, lines)) <= 60
