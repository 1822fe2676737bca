"""Files by other people become sheets; what they do not say is asked for by the option's name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from foldmill import Assignment, CreasePattern, UnreadableFile
from foldmill.check import check
from foldmill.exchange.options import Options
from foldmill_fabricate.importing import Imported, read_pattern

SAMPLES = Path(__file__).parents[2] / "samples"


def sample(name: str, **said: object) -> Imported:
    return read_pattern(SAMPLES / name, Options(**said))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "counts"),
    [  # mountains, valleys, lines that are drawn flat
        ("ff_pinwheel.fold", (4, 8, 0)),
        ("ff_pinwheel.opx", (4, 8, 0)),
        ("ff_bad-twist-UNSAT.fold", (4, 8, 0)),
        ("fold_diagonal-cp.fold", (0, 1, 0)),
        ("os_simpleVertex.svg", (3, 1, 0)),
        ("os_waterbomb.svg", (246, 220, 0)),
    ],
)
def test_every_sample_is_read_with_all_its_creases(name: str, counts: tuple[int, int, int]) -> None:
    pattern = sample(name).fold.pattern
    is_flat = (pattern.assignments == Assignment.F) & ~np.asarray(pattern.added)
    flat = int(is_flat.sum())
    assert (pattern.count(Assignment.M), pattern.count(Assignment.V), flat) == counts


def test_the_size_is_asked_for_by_name_and_taken_when_said() -> None:
    (question,) = sample("os_waterbomb.svg").questions
    assert question.option == "--width"
    assert "--width MM" in question.sentence
    assert "--unit" in question.sentence
    assert "--scale" in question.sentence
    said = sample("os_waterbomb.svg", width=440.0)
    assert said.questions == ()
    assert np.allclose(np.ptp(said.fold.pattern.vertices, axis=0), [440, 200], atol=0.01)


def test_a_unit_or_a_scale_answers_as_well() -> None:
    side = np.ptp(sample("ff_pinwheel.opx", unit="mm").fold.pattern.vertices, axis=0)
    assert side.tolist() == [400, 400]
    half = np.ptp(sample("ff_pinwheel.opx", scale=0.5).fold.pattern.vertices, axis=0)
    assert half.tolist() == [200, 200]
    inch = np.ptp(sample("ff_pinwheel.fold", unit="in", scale=2.0).fold.pattern.vertices, axis=0)
    assert np.allclose(inch, 50.8)


def test_the_opacity_of_the_crane_is_its_fold_angle() -> None:
    fold = sample("os_crane-opacity-angles.svg", width=300.0).fold
    found = set(np.round(np.abs(fold.pattern.fold_angles[fold.pattern.fold_angles != 0])))
    assert found == {45, 90, 135, 180}
    assert "import-gap" in {finding.code for finding in fold.findings}  # it was drawn by hand
    assert not check(fold).has_errors


def test_the_pinwheel_of_one_program_is_turned_by_no_other() -> None:
    """Its FOLD file copies y downward as y upward; that it is a mirror image can be said."""
    opx = sample("ff_pinwheel.opx", width=1.0).fold.pattern
    fold = sample("ff_pinwheel.fold", width=1.0, mirror=True).fold.pattern

    def creases(pattern: CreasePattern) -> set[str]:
        edges = pattern.edges[pattern.assignments == Assignment.M]
        ends = np.round(pattern.vertices[edges], 9) + 0.0
        return {str(sorted(line)) for line in ends.tolist()}

    assert creases(opx) == creases(fold)
    assert creases(opx) != creases(sample("ff_pinwheel.fold", width=1.0).fold.pattern)


def test_keys_of_others_survive() -> None:
    from foldmill.exchange import write

    assert '"cpedit:page"' in write(sample("fold_diagonal-cp.fold", width=100.0).fold)


def test_a_file_is_known_by_its_content_where_its_name_says_nothing() -> None:
    for name in ("ff_pinwheel.fold", "ff_pinwheel.opx", "os_waterbomb.svg"):
        content = (SAMPLES / name).read_bytes()
        assert read_pattern(content).format == name.rpartition(".")[2]
    assert read_pattern(b"1 0 0 4 0\n1 4 0 0 3\n1 0 3 0 0\n").format == "cp"
    with pytest.raises(UnreadableFile, match=r"Those that can: .cp, .dxf, .fold, .opx, .svg"):
        read_pattern(b"\x00\x01....")


def test_a_drawing_without_a_title_is_called_by_its_file(tmp_path: Path) -> None:
    content = (SAMPLES / "os_simpleVertex.svg").read_bytes()
    file = tmp_path / "my tower.svg"
    file.write_bytes(content)
    assert read_pattern(file).fold.meta["title"] == "my tower"
    file.write_bytes(content.replace(b"</svg>", b"<title>Tower of paper</title></svg>"))
    assert read_pattern(file).fold.meta["title"] == "Tower of paper"
    assert "title" not in read_pattern(content, name="a file.svg").fold.meta
