"""Materials and machines as tables that people write: what is wrong is told by line and reason."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path

import pytest
from typer.testing import CliRunner

from foldmill.errors import UnknownName, UnreadableFile
from foldmill_fabricate import presets, shelf
from foldmill_fabricate.cli.app import app
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.presets import Preset, rows, unit_of
from foldmill_fabricate.toml_lines import line_of

MATERIALS = {m.slug: m for m in presets.shipped(Material, "foldmill_fabricate.materials")}
MACHINES = {m.slug: m for m in presets.shipped(Machine, "foldmill_fabricate.machines")}
EVERY: dict[str, Preset] = {**MATERIALS, **MACHINES}
EXAMPLES = sorted((Path(__file__).parents[2] / "examples" / "machines").glob("*.toml"))


def text(slug: str) -> str:
    kind = "materials" if slug in MATERIALS else "machines"
    return (files(f"foldmill_fabricate.{kind}") / f"{slug}.toml").read_text(encoding="utf-8")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's config folder."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setenv("APPDATA", str(tmp_path))
    for kind in ("materials", "machines"):
        (tmp_path / "foldmill" / kind).mkdir(parents=True)
    return tmp_path / "foldmill"


def test_there_are_six_materials_and_twelve_machines_and_none_is_said_to_be_tried() -> None:
    assert len(MATERIALS) == 6
    assert len(MACHINES) == 12
    assert not any(material.tested for material in MATERIALS.values())
    assert not any(machine.verified for machine in MACHINES.values())


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_that_is_copied_is_a_machine_like_any_other(example: Path, home: Path) -> None:
    (home / "machines" / example.name).write_bytes(example.read_bytes())
    result = CliRunner().invoke(app, ["machines", "--show", example.stem])
    assert result.exit_code == 0, result.output
    assert example.stem in result.output


@pytest.mark.parametrize("slug", MATERIALS)
def test_every_quantity_of_a_material_says_where_it_comes_from(slug: str) -> None:
    material = MATERIALS[slug]
    given = {row.name for row in rows(material) if row.unit and row.value not in (None, 0, 0.0)}
    told = set(material.sources) | {"stock_width", "stock_height"}
    assert not given - told


@pytest.mark.parametrize("slug", EVERY)
def test_the_fields_of_a_preset_have_names_of_their_own(slug: str) -> None:
    names = [row.name for row in rows(EVERY[slug])]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("slug", MATERIALS)
def test_grooves_leave_their_web_and_cuts_go_through(slug: str) -> None:
    material = MATERIALS[slug]
    for score in material.scores:
        assert material.thickness * score.remains >= score.web_min
        assert score.kind == "perforation" or score.exposure <= material.thickness - score.web_min
    for process in (*material.scores, *material.cuts):
        if process.kind in {"perforation", "through-cut"}:
            assert process.exposure > material.thickness


@pytest.mark.parametrize(
    ("slug", "old", "new", "line", "reason"),
    [
        ("pp-0.75", 'force = "240 gf"', 'force = "240 lb"', "force", "write a number and a unit"),
        ("pp-0.75", 'force = "240 gf"', 'force = "much gf"', "force", "'much' is no number"),
        ("pp-0.75", "depth_ratio = 0.55", "depth_ratio = 1.5", "depth_ratio", "less than 1"),
        ("pp-0.75", "depth_ratio = 0.55", "dept_ratio = 0.55", "dept_ratio", "There is no"),
        ("pp-0.75", 'kind = "half-cut"', 'kind = "half-gut"', "kind", "half-gut"),
        (
            "pp-0.75",
            'provenance = "Untested',
            'provenance = "" # "',
            "prov",
            "must not be left empty",
        ),
        (
            "roland-like-600",
            'min_force = "30 gf"',
            'min_force = "900 gf"',
            "[tools",
            "at most max_",
        ),
        ("pp-0.75", 'thickness = "0.75 mm"\n', "", "#", "thickness is missing"),
        ("generic-hpgl-600", "score-and-snap = 1", "score-and-snip = 1", "score", "score-and-snip"),
        ("hp-7475a", "force = false", 'force = "never"', "force", "yes or no"),
        ("hp-7475a", '"dialect.force" = ', '"dialect.farce" = ', "sources", "no field of this"),
    ],
)
def test_a_wrong_field_is_refused_with_its_line_and_the_reason(
    slug: str, old: str, new: str, line: str, reason: str
) -> None:
    wrong = text(slug).replace(old, new, 1)
    assert wrong != text(slug)
    with pytest.raises(UnreadableFile) as caught:
        presets.read(type(EVERY[slug]), wrong, "mine.toml")
    said = str(caught.value)
    assert reason in said
    assert said.startswith("mine.toml, line ")
    number = int(said.split("line ")[1].split(":")[0])
    if line != "sources":
        assert wrong.splitlines()[number - 1].startswith((line, "[score", "[tools"))


def test_lines_are_found_in_tables_lists_of_tables_and_under_quoted_names() -> None:
    toml = 'a = 1\n[b]\n# c = 0\nc = 1\n[[d]]\ne = 1\n[[d]]\ne = 2\n[f."g.h"]\ni = 1\n'
    places: list[tuple[str | int, ...]] = [("a",), ("b", "c"), ("d", 0, "tag", "e")]
    places += [("d", 1, "tag", "e"), ("d", 1, "nowhere"), ("f", "g.h", "i")]
    assert [line_of(toml, place) for place in places] == [1, 4, 6, 8, 7, 10]


def test_a_preset_of_the_users_own_is_found_by_its_slug(home: Path) -> None:
    mine = text("pp-0.5").replace('slug = "pp-0.5"', 'slug = "my-pp"')
    (home / "materials" / "my-pp.toml").write_text(mine, encoding="utf-8")
    assert shelf.material("my-pp").thickness == 0.5
    assert shelf.everything(Material).owners["my-pp"].endswith("my-pp.toml")
    with pytest.raises(UnknownName, match="my-pp"):
        shelf.material("my-pq")


def test_a_users_preset_does_not_take_anothers_place(home: Path) -> None:
    (home / "materials" / "pp-0.5.toml").write_text(text("pp-0.5"), encoding="utf-8")
    with pytest.raises(UnreadableFile, match="offered by foldmill"):
        shelf.material("pp-0.5")
    (home / "machines" / "mine.toml").write_text(text("hp-7475a"), encoding="utf-8")
    with pytest.raises(UnreadableFile, match=r"hp-7475a\.toml"):
        shelf.machine("mine")


def test_a_broken_file_is_told_of_and_hides_no_other(home: Path) -> None:
    (home / "materials" / "broken.toml").write_text("slug = ", encoding="utf-8")
    result = CliRunner().invoke(app, ["materials"])
    assert result.exit_code == 1
    assert "pet-0.25" in result.output
    assert "broken.toml is no TOML file" in result.output


def test_every_field_is_shown_with_its_unit_and_source() -> None:
    shown = CliRunner().invoke(app, ["materials", "--show", "pp-0.75"]).output
    assert "half-cut.exposure" in shown
    for row in rows(MATERIALS["pp-0.75"]):
        line = next(each for each in shown.splitlines() if each.startswith(row.name))
        assert row.value is None or row.unit in line
        assert MATERIALS["pp-0.75"].sources.get(row.name, "") in line
    data = json.loads(CliRunner().invoke(app, ["machines", "--show", "hp-7475a", "--json"]).output)
    assert data["axes"]["units_per_mm"] == pytest.approx(40.197, abs=1e-3)


def test_an_optional_quantity_has_its_unit_too() -> None:
    assert unit_of(Material.model_fields["min_fold_temperature"]) == "°C"
