"""What was read becomes presets of the user's, or is refused with the line and the reason."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from coupons import coupon, declared

from foldmill.errors import InvalidInput, UnreadableFile
from foldmill_fabricate import presets, shelf
from foldmill_fabricate.coupon import record
from foldmill_fabricate.coupon.answers import NAME, Answers, template
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import HalfCut, Material, Perforation

WHO = {"read_by": "A. Reader", "read_on": "2026-05-04"}


@pytest.fixture(autouse=True)
def config(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    return tmp_path / "foldmill"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A coupon's folder with nothing but its plan."""
    _, plan = coupon()
    path = tmp_path / "coupon"
    path.mkdir()
    (path / "plan.json").write_text(plan.model_dump_json(), encoding="utf-8")
    return path


def recorded(**read: Any) -> record.Recorded:
    _, plan = coupon()
    answers = Answers.model_validate(WHO | read)
    return record.record(
        plan,
        declared(plan),
        answers,
        shelf.material("pp-0.75"),
        shelf.machine(plan.machine.slug),
        "mine",
    )


def test_the_best_rungs_become_a_tested_preset_that_says_where_it_comes_from() -> None:
    best = {"depth": 0.5, "force": 190, "repeats": 3, "spacing": 1.1, "relief": 2.5}
    found = recorded(best=best, temperature=21)
    made = found.material
    assert made is not None
    score = made.score
    assert isinstance(score, HalfCut)
    assert (score.exposure, score.force, score.repeats, score.min_spacing) == (0.5, 190, 3, 1.1)
    assert score.depth_ratio == pytest.approx(0.55 * 0.5 / 0.4)
    assert score.depth_ratio_min <= score.depth_ratio <= score.depth_ratio_max
    assert (made.slug, made.relief_diameter, made.tested) == ("pp-0.75-mine", 2.5, True)
    assert made.sources["half-cut.exposure"] == "coupon read by A. Reader on 2026-05-04, 21 °C"
    assert made.sources["half-cut.speed"] == "estimate"
    assert "make one more coupon" in found.advice[0]
    assert found.machine is None


def test_springback_is_what_the_hinges_opened() -> None:
    made = recorded(hinge={"at_90": 24, "at_180": 33}).material
    assert made is not None
    assert (made.springback_min, made.springback_max, made.tested) == (24, 33, True)


def test_spacing_alone_is_no_test_of_how_it_is_scored() -> None:
    made = recorded(best={"spacing": 1.5}).material
    assert made is not None
    assert not made.tested


def test_bars_alone_scale_the_machine_and_leave_its_sides() -> None:
    made = recorded(bars={"ab": 471.4, "ad": 401.2}).machine
    assert made is not None
    assert made.axes.scale_x == pytest.approx(470 / 471.4, abs=1e-6)
    assert not made.two_sides.is_known
    assert not made.two_sides.measured
    assert "axes.scale_x" in made.sources
    assert "axes.skew" not in made.sources


def test_presets_are_written_once_and_never_over_each_other_unasked(config: Path) -> None:
    found = recorded(best={"depth": 0.3}, bars={"ab": 471.0})
    files = record.save(found, force=False)
    assert [file.relative_to(config).as_posix() for file in files] == [
        "materials/pp-0.75-mine.toml",
        "machines/generic-hpgl-600-mine.toml",
    ]
    assert shelf.material("pp-0.75-mine") == found.material
    assert shelf.machine("generic-hpgl-600-mine") == found.machine
    before = files[0].read_bytes()
    other = recorded(best={"depth": 0.4})
    with pytest.raises(InvalidInput, match=r"would be written over. Say --force"):
        record.save(other, force=False)
    assert files[0].read_bytes() == before
    record.save(other, force=True)
    assert files[0].read_bytes() != before


@pytest.mark.parametrize(
    ("read", "sentence"),
    [
        ({"best": {"depth": 0.35}}, r"best.depth is 0.35, which is no rung.*0.2, 0.3, 0.4, 0.5"),
        ({"best": {"relief": 4}}, "no rung of the ladder"),
        ({}, "Nothing was answered"),
    ],
)
def test_what_stands_on_no_rung_is_refused(read: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InvalidInput, match=sentence):
        recorded(**read)


def test_another_material_is_refused() -> None:
    _, plan = coupon()
    answers = Answers.model_validate(WHO | {"best": {"depth": 0.5}})
    with pytest.raises(InvalidInput, match=r"material pp-0.75, not card-250"):
        record.record(
            plan, declared(plan), answers, shelf.material("card-250"), plan.machine, "mine"
        )


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ('read_on = "4 May"', r"line 2: .*read_on"),
        ('read_on = "2026-13-45"', r"line 2: read_on: write the day as YYYY-MM-DD"),
        ('read_on = "2026-W01-1"', r"line 2: read_on: write the day as YYYY-MM-DD"),
        ('[bars]\nab = "47 cows"', r"line 4: .*ab"),
        ("[hinge]\nat_90 = 95", r"line 4: .*at most 90"),
        ("temperature = 200", r"line 3: .*at most 60"),
        ("[best]\ndeep = 1", r"line 4: .*deep"),
        ("[vernier", "is no TOML file"),
    ],
)
def test_a_wrong_answer_is_refused_with_its_line(folder: Path, line: str, sentence: str) -> None:
    lines = ['read_by = "A"', 'read_on = "2026-05-04"', line]
    if line.startswith("read_on"):
        lines = [lines[0], line]
    (folder / NAME).write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(UnreadableFile, match=sentence):
        record.read(folder)


def test_answers_are_read_beside_the_plan_of_a_coupon(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(UnreadableFile, match=NAME):
        record.read(folder)
    with pytest.raises(UnreadableFile, match=r"Answers are read beside the plan\.json"):
        record.read(tmp_path / "elsewhere" / NAME)
    _, plan = coupon()
    bare = plan.model_copy(update={"coupon": None})
    (folder / "plan.json").write_text(bare.model_dump_json(), encoding="utf-8")
    with pytest.raises(UnreadableFile, match="not a coupon's"):
        record.read(folder)


def test_the_file_to_fill_in_asks_for_what_is_on_the_coupon_and_reads_once_it_is_answered() -> None:
    _, plan = coupon()
    text = template(plan, declared(plan))
    answered = text.replace('read_by = ""', 'read_by = "A"').replace('on = ""', 'on = "2026-05-04"')
    answered = "\n".join(
        line.removeprefix("#") if line.startswith("#") and "=" in line else line
        for line in answered.splitlines()
    )
    answers = presets.read(Answers, answered, NAME)
    assert answers.best.depth == 0.2
    assert answers.vernier.x == 0
    assert answers.bars.ab == declared(plan).bars.width
    with pytest.raises(UnreadableFile, match="read_by"):
        presets.read(Answers, text, NAME)


def test_a_preset_of_the_users_own_keeps_its_name() -> None:
    found = recorded(best={"depth": 0.5}, bars={"ab": 471.0})
    record.save(found, force=False)
    material, machine = shelf.material("pp-0.75-mine"), shelf.machine("generic-hpgl-600-mine")
    assert isinstance(material, Material)
    assert isinstance(machine, Machine)
    _, plan = coupon()
    again = plan.model_copy(update={"material": material, "machine": machine})
    answers = Answers.model_validate(WHO | {"best": {"depth": 0.3}, "bars": {"ad": 401.0}})
    second = record.record(again, declared(plan), answers, material, machine, "mine")
    assert second.material is not None
    assert second.material.slug == "pp-0.75-mine"
    assert second.machine is not None
    assert second.machine.axes.scale_x == machine.axes.scale_x


@pytest.mark.parametrize("suffix", ["../other", "", "a/b", "-x", "a b"])
def test_presets_are_named_by_words_that_a_file_can_bear(suffix: str) -> None:
    _, plan = coupon()
    answers = Answers.model_validate(WHO | {"best": {"depth": 0.5}})
    with pytest.raises(InvalidInput, match="part of a file's name"):
        record.record(plan, declared(plan), answers, plan.material, plan.machine, suffix)


def test_an_unsigned_coupon_is_refused_in_plain_words() -> None:
    with pytest.raises(UnreadableFile, match=r"line 1: read_by must not be left empty\.$"):
        presets.read(Answers, 'read_by = ""\nread_on = "2026-05-04"', NAME)


def test_only_what_a_coupon_changed_is_said_to_come_from_it() -> None:
    strong, weak = recorded(best={"force": 290}).material, recorded(best={"force": 145}).material
    assert strong is not None
    assert weak is not None
    assert (strong.score.force, strong.score.force_needed) == (290, 200)
    assert strong.sources["half-cut.force_needed"] == "estimate"
    assert (weak.score.force, weak.score.force_needed) == (145, 145)
    assert weak.sources["half-cut.force_needed"].startswith("coupon read by")


def test_a_hole_smaller_than_the_rule_is_recorded_and_the_rule_is_told() -> None:
    small, large = recorded(best={"relief": 1.5}), recorded(best={"relief": 2.5})
    assert any("stay 1.875 mm wide" in note for note in small.advice)
    assert not large.advice


def test_the_best_land_of_a_perforation_becomes_its_gap() -> None:
    case = {"material": "paper-80-120", "machine": "generic-hpgl-pens", "score": "perforation"}
    _, plan = coupon(**case)
    answers = Answers.model_validate(WHO | {"best": {"gap": 1.5}})
    material, machine = shelf.material("paper-80-120"), shelf.machine("generic-hpgl-pens")
    found = record.record(plan, declared(plan), answers, material, machine, "mine").material
    assert found is not None
    made = next(score for score in found.scores if score.kind == "perforation")
    assert isinstance(made, Perforation)
    assert (made.gap, found.tested, found.score) == (1.5, True, material.score)
    assert found.sources["perforation.gap"].startswith("coupon read by")
    with pytest.raises(InvalidInput, match="this coupon has no gap ladder"):
        recorded(best={"gap": 1.5})
