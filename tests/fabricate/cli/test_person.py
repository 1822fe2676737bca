"""The operator at a terminal: what is asked, and that a wrong answer is asked again."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import typer
from fabricate.bench import small_plan

from foldmill import FoldmillError
from foldmill_fabricate.cli.person import Person, read_word
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.gates import Answer, Request
from foldmill_fabricate.instructions import instruction
from foldmill_fabricate.operators import Verdict
from foldmill_fabricate.passes import Face, Gate
from foldmill_fabricate.plotter.ledger import Entry, Program, Record, Said, State, Word
from foldmill_fabricate.plotter.resume import Start


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Return what is typed at the prompts, one after the other."""
    lines: list[str] = []
    monkeypatch.setattr("typer.prompt", lambda *_, **__: lines.pop(0))
    yield lines
    assert not lines


def request(gate: Gate, face: Face = Face.FRONT) -> Request:
    plan = small_plan()
    return Request(gate, face, plan.passes[face is Face.REVERSE].setups[0], plan, "K7QF")


def test_thickness_and_temperature_are_read(typed: list[str]) -> None:
    typed += ["0.76 21.5"]
    assert Person().ready(request(Gate.LOAD)) == Answer("K7QF", 0.76, 21.5)


def test_enter_means_that_nothing_was_measured(typed: list[str]) -> None:
    typed += ["", "", "K7QF"]
    assert Person().ready(request(Gate.LOAD)) == Answer("K7QF")
    assert Person().ready(request(Gate.TOOL)) == Answer("K7QF")
    assert Person().ready(request(Gate.FLIP, Face.REVERSE)) == Answer("K7QF")


@pytest.mark.parametrize(
    ("gate", "wrong", "right", "told"),
    [
        (Gate.LOAD, "3.0", "0.75", "from 0.60 to 0.89 mm thick, and this one has 3 mm"),
        (Gate.LOAD, "thick", "0.75", "Write thickness and temperature"),
        (Gate.TOOL, "2.0", "", "With the blade 2 mm out, reverse-score can be made in sheets"),
        (Gate.FLIP, "K7QG", "k7qf 22", "the id that was read off it is K7QG"),
        (Gate.FLIP, "", "k7qf", "is none"),
        (Gate.RE_REGISTER, "K7QF yes", "K7QF", "touched after it if the sheet was moved"),
    ],
)
def test_a_wrong_answer_is_refused_with_the_sentence_and_asked_again(
    typed: list[str],
    capsys: pytest.CaptureFixture[str],
    gate: Gate,
    wrong: str,
    right: str,
    told: str,
) -> None:
    typed += [wrong, right]
    assert Person().ready(request(gate, Face.REVERSE)) is not None
    assert told in capsys.readouterr().err


def test_q_stops_at_every_gate(typed: list[str]) -> None:
    typed += ["q"] * len(Gate)
    assert [Person().ready(request(gate)) for gate in Gate] == [None] * len(Gate)


def test_a_moved_sheet_is_measured(typed: list[str]) -> None:
    typed += ["K7QF touched", "20,30;220,31"]
    answer = Person().ready(request(Gate.RE_REGISTER, Face.REVERSE))
    assert answer is not None
    assert answer.marks == ((20.0, 30.0), (220.0, 31.0))


def test_the_flip_is_drawn_with_holes_where_they_come_to_lie_and_the_id() -> None:
    text = instruction(request(Gate.FLIP, Face.REVERSE))
    assert text.count("K7QF") == 3
    rows = [line for line in text.splitlines() if line.startswith("|")]
    fronts, reverses = (["|".join(row.split("|")[k : k + 1]) for row in rows] for k in (1, 3))
    assert [row.count("o") for row in fronts] == [row.count("o") for row in reverses]
    assert sum(row.count("o") for row in fronts) == 4
    (mark,) = (row.index("F") for row in fronts if "F" in row.replace("K7QF", ""))
    (under,) = (row.index("(F)") + 1 for row in reverses if "(F)" in row)
    assert abs(mark + under - (len(fronts[0]) - 1)) <= 1  # its mirror image


def test_the_flip_comes_as_a_picture_too(tmp_path: Path) -> None:
    asked = request(Gate.FLIP, Face.REVERSE)
    made = Request(**{**vars(asked), "picture": tmp_path / "flip-K7QF.png"})
    assert str(tmp_path / "flip-K7QF.png") in instruction(made)
    assert (tmp_path / "flip-K7QF.png").read_bytes().startswith(b"\x89PNG")


def in_doubt() -> Record:
    runs = (Entry(1, 0, 0, 7, 4),)
    program = Program("2-front-score.hpgl", "front", "", 7)
    return Record("K7QF", 1, program, State.INTERRUPTED, 0, 0, 0.0, "It stopped.", runs)


def test_a_program_in_doubt_goes_on_where_a_person_says(
    typed: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    typed += ["", "x", "6", "6.2", "f", "s", "q", ""]
    told = "The machine stands at (1.00, 2.00) mm."
    decide = [Person().decide(in_doubt(), None, told) for _ in range(5)]
    assert decide == [
        Said(Word.GO_ON, 5),
        Said(Word.GO_ON, 5, 2),
        Said(Word.FINISHED),
        Said(Word.SPOILED),
        None,
    ]
    said = capsys.readouterr().err
    assert told in said
    assert "a person must say it" in said
    assert Person().decide(in_doubt(), Start(4, 1), "") == Said(Word.GO_ON, 4, 1)


def test_a_word_given_beforehand_is_taken_with_all_that_is_known_told(
    capsys: pytest.CaptureFixture[str],
) -> None:
    word = Said(Word.GO_ON, 5)
    someone = Person(word)
    assert someone.decide(in_doubt(), None, "Half an instruction may lie in the machine.") == word
    said = capsys.readouterr().err
    assert "It stopped." in said
    assert "Half an instruction may lie in the machine." in said


def test_an_overlap_that_is_no_length_is_refused() -> None:
    with pytest.raises(FoldmillError, match="from 0 to 20"):
        read_word("12.3", finished=False, overlap=float("nan"))


def test_a_word_for_what_is_not_in_doubt_begins_nothing(typed: list[str]) -> None:
    someone, asked = Person(Said(Word.GO_ON, 5)), request(Gate.LOAD)
    with pytest.raises(CannotSend, match="Of sheet K7QF nothing is in doubt"):
        someone.ready(asked)
    someone.decide(in_doubt(), None, "")
    typed += [""]
    assert someone.ready(asked) == Answer("K7QF")


@pytest.mark.parametrize("word", ["SPQR", "F45T", "stop", "skip", "fine?"])
def test_an_id_or_a_word_neither_gives_a_sheet_up_nor_finishes_it(
    typed: list[str], word: str
) -> None:
    typed += [word, "q"]
    assert Person().decide(in_doubt(), Start(4, 1), "") is None


@pytest.mark.parametrize("stops", [["q"], ["what", "Q"], [None]])
def test_who_stops_at_the_offer_of_a_test_cut_does_not_begin_the_part(
    stops: list[str | None], monkeypatch: pytest.MonkeyPatch
) -> None:
    def typing(*_: object, **__: object) -> str:
        answer = stops.pop(0)
        if answer is None:  # Ctrl-C, or the end of what is typed
            raise typer.Abort
        return answer

    monkeypatch.setattr("typer.prompt", typing)
    with pytest.raises(CannotSend, match="as the operator said"):
        Person().wants_test_cut(request(Gate.TOOL))


def test_only_a_itself_cuts_another_test_cut(typed: list[str]) -> None:
    typed += ["abort"]
    assert Person().judge(request(Gate.TOOL)) is Verdict.STOP


def test_a_test_cut_is_judged(typed: list[str]) -> None:
    typed += ["y", "", "a", "", "q"]
    someone, asked = Person(), request(Gate.TOOL)
    assert someone.wants_test_cut(asked)
    assert not someone.wants_test_cut(asked)
    assert [someone.judge(asked) for _ in range(3)] == [
        Verdict.AGAIN,
        Verdict.GOOD,
        Verdict.STOP,
    ]
