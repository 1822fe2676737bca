"""What lines are: as a person says, else by layer, else by colour; where none says, it is asked."""

from __future__ import annotations

import pytest

from foldmill import UnreadableFile
from foldmill.exchange import colours
from foldmill.exchange.drawing import Look
from foldmill.exchange.naming import layer_letter, named
from foldmill.exchange.options import Options

RED, BLUE, BLACK, ORANGE = (255, 0, 0), (0, 0, 255), (0, 0, 0), (255, 165, 0)


@pytest.mark.parametrize(
    ("word", "letter"),
    [
        ("red", "M"),
        ("crimson", "M"),
        ("#ed1c24", "M"),  # red of printing inks
        ("blue", "V"),
        ("royalblue", "V"),
        ("#2e3192", "V"),
        ("black", "B"),
        ("#231f20", "B"),
        ("lime", "C"),
        ("limegreen", "C"),
        ("yellow", "F"),
        ("gold", "F"),
        ("gray", "F"),
        ("lightgray", "F"),
        ("magenta", "U"),
        ("orchid", "U"),
        ("white", ""),
        ("orange", None),
        ("cyan", None),
        ("brown", "M"),
        ("tan", None),
    ],
)
def test_colours_mean_what_crease_pattern_programs_mean(word: str, letter: str | None) -> None:
    found = colours.parse(word)
    assert found is not None
    assert colours.letter_of(found[0]) == letter


@pytest.mark.parametrize(
    ("layer", "letter"),
    [
        ("Mountain", "M"),
        ("MountainLine", "M"),
        ("MOUNTAIN", "M"),
        ("ORIGAMI_VALLEY", "V"),
        ("valley-folds", "V"),
        ("CutLine", "C"),
        ("Boundary", "B"),
        ("edges", None),  # the outline to some, all lines to others: colours say which
        ("AuxiliaryLine", "F"),
        ("M", "M"),
        ("V", "V"),
        ("v", None),  # a class or id that some program shortened
        ("Layer 1", None),
        ("g1234", None),
        ("mountains and valleys", None),
        ("countryside", None),
        ("Notes", "skip"),
        ("noname", "F"),  # auxiliary lines, as ORIPA writes them
    ],
)
def test_layers_mean_what_their_words_say(layer: str, letter: str | None) -> None:
    assert layer_letter([layer]) == letter


def test_the_innermost_layer_that_says_anything_is_believed() -> None:
    assert layer_letter(["Mountain", "Valley", "g12"]) == "V"


def test_a_layer_is_believed_before_a_colour_and_the_doubt_is_told() -> None:
    blue_mountain = Look("", ("Mountain",), BLUE)
    found = named([blue_mountain] * 3, Options())
    assert found.letters == ("M",) * 3
    (finding,) = found.findings
    assert finding.code == "import-layer-or-colour"
    assert "--by colour" in finding.remedy
    assert named([blue_mountain], Options(by="colour")).letters == ("V",)


def test_what_a_person_says_goes_before_both() -> None:
    look = Look("", ("Mountain", "inner"), BLUE)
    assert named([look], Options(named={"blue": "U"})).letters == ("U",)
    assert named([look], Options(named={"#0000ff": "U", "INNER": "F"})).letters == ("F",)


def test_unknown_lines_are_asked_for_by_name_with_their_count() -> None:
    looks = [Look("", (), RED), *[Look("", (), ORANGE)] * 3, Look("", ("odd",), None)]
    with pytest.raises(
        UnreadableFile, match=r"3 in #ffa500, 1 in odd\. Say it with --as '#ffa500=M'"
    ):
        named(looks, Options())
    said = Options(named={"orange": "V", "other": "skip"})
    found = named(looks, said)
    assert found.letters == ("M", "V", "V", "V", "")
    assert found.findings[0].message.startswith("1 lines were left out")


def test_by_layer_a_colour_says_nothing() -> None:
    with pytest.raises(UnreadableFile, match="--as"):
        named([Look("", ("Layer 1",), RED)], Options(by="layer"))


def test_a_drawing_of_which_nothing_is_left_is_refused() -> None:
    with pytest.raises(UnreadableFile, match="All lines of this drawing are left out"):
        named([Look("", (), BLACK)], Options(named={"black": "skip"}))


def test_short_names_that_programs_give_to_classes_mean_nothing() -> None:
    red, blue = (255, 0, 0), (0, 0, 255)
    looks = [Look("", ("b",), red), Look("", ("c",), blue), Look("", ("f",), red)]
    assert named(looks, Options()).letters == ("M", "V", "M")


def test_an_edge_is_the_outline_where_no_colour_says_otherwise() -> None:
    looks = [Look("", ("edges",), (255, 0, 0)), Look("", ("edges",), (0, 0, 0))]
    assert named(looks, Options()).letters == ("M", "B")
    assert named([Look("", ("Edge",), (255, 128, 0))], Options()).letters == ("B",)
    assert named(looks, Options(by="layer")).letters == ("B", "B")


def test_lines_of_no_colour_are_named_as_the_question_calls_them() -> None:
    with pytest.raises(UnreadableFile, match="--as 'no colour=M'"):
        named([Look()], Options())
    assert named([Look()], Options(named={"no colour": "M"})).letters == ("M",)


def test_where_all_lines_are_alike_it_is_said_that_the_file_tells_nothing() -> None:
    # As a DXF that drops colours.
    grey = Look("", ("Layer 1",))
    with pytest.raises(UnreadableFile, match=r"All lines are alike.*--as 'Layer 1=M'"):
        named([grey] * 3, Options())
    with pytest.raises(UnreadableFile) as refused:
        named([grey, Look("", ("Layer 2",))], Options())
    assert "alike" not in str(refused.value)
