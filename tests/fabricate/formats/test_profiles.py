"""Names and colours of layers are a profile's; drawings are the same lines in all of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import hand_made
import pytest
import readers
from ezdxf.document import Drawing
from ezdxf.filemanagement import readfile
from typer.testing import CliRunner

from foldmill.errors import UnknownName, UnreadableFile
from foldmill_fabricate import profiles
from foldmill_fabricate.cli.app import app
from foldmill_fabricate.formats import dxf, svg
from foldmill_fabricate.formats.drawing import layer_of
from foldmill_fabricate.kinds import Kind
from foldmill_fabricate.passes import Face, Role
from foldmill_fabricate.profiles import Style

PLAN, FOLD = hand_made.plan(), hand_made.fold()
TABLE = {
    "REG": (10, "#00e000", 1),
    "SCORE_FRONT": (4, "#0000ff", 2),
    "CREASE_FRONT": (2, "#0000ff", 2),
    "SCORE_BACK": (9, "#ff8000", 2),
    "CREASE_BACK": (8, "#ff8000", 2),
    "PERF": (3, "#00e0e0", 3),
    "CUT_INNER": (1, "#d0d000", 4),
    "CUT_OUTER": (1, "#ff0000", 4),
    "NOTE": (20, "#b4b4b4", 5),
}
"""Die makers' colour numbers and laser software's colours, as the trade has them."""
OWN = """
slug = "mine"
title = "the shop next door"
provenance = "asked for it"
[layers.cut_outer]
name = "THRU"
aci = 30
colour = "#123456"
pen = 7
"""


def read(content: bytes, folder: Path) -> Drawing:
    (folder / "x.dxf").write_bytes(content)
    return readfile(folder / "x.dxf")


def lines(document: Drawing) -> Iterator[tuple[str, int, tuple[float, ...]]]:
    """Yield layer, colour and points of every line, whatever kind of entity it is."""
    for entity in document.modelspace():
        look = (entity.dxf.layer, entity.dxf.color)
        if entity.dxftype() == "LINE":
            ends = (entity.dxf.start, entity.dxf.end)
            yield (*look, tuple(round(value, 3) for end in ends for value in (end.x, end.y)))
        elif entity.dxftype() == "LWPOLYLINE":
            points = entity.get_points("xy")  # type: ignore[attr-defined]
            yield (*look, tuple(round(value, 3) for point in points for value in point))
        elif entity.dxftype() == "POLYLINE":
            spots = [vertex.dxf.location for vertex in entity.vertices]  # type: ignore[attr-defined]
            yield (*look, tuple(round(value, 3) for spot in spots for value in (spot.x, spot.y)))


def test_foldmills_own_profile_is_the_trades_table() -> None:
    rows = {
        look.name: (look.aci, look.colour, look.pen) for look, _ in profiles.legend(profiles.find())
    }
    assert {name: rows[name] for name in TABLE} == TABLE


@pytest.mark.parametrize("name", profiles.shipped())
def test_no_layers_name_has_a_digit_and_every_one_says_what_it_is_for(name: str) -> None:
    profile = profiles.find(name)
    for look, about in profiles.legend(profile):
        assert not re.search(r"\d", look.name)
        assert about
    assert profile.provenance


@pytest.mark.parametrize("name", profiles.shipped())
@pytest.mark.parametrize("version", ["R2000", "R12"])
def test_profiles_change_looks_and_never_lines(name: str, version: str, tmp_path: Path) -> None:
    plain = {points for _, _, points in lines(read(dxf.write(PLAN, FOLD)["master.dxf"], tmp_path))}
    profile = profiles.find(name)
    content = dxf.write(PLAN, FOLD, Style(profile, version))["master.dxf"]  # type: ignore[arg-type]
    document = read(content, tmp_path)
    assert not document.audit().has_errors
    assert {points for _, _, points in lines(document)} == plain
    known = {(look.name, look.aci) for look, _ in profiles.legend(profile)}
    assert {(layer, colour) for layer, colour, _ in lines(document)} <= known
    colours = set(
        re.findall(rb"stroke:(#\w+)", svg.write(PLAN, FOLD, Style(profile))["master.svg"])
    )
    assert colours <= {look.colour.encode() for look, _ in profiles.legend(profile)}


def test_artioscad_finds_its_lines_by_number(tmp_path: Path) -> None:
    content = dxf.write(PLAN, FOLD, Style(profiles.find("artioscad")))["master.dxf"]
    found = {(layer, colour) for layer, colour, _ in lines(read(content, tmp_path))}
    assert found == {
        ("PRINT_REGISTRATION", 10),
        ("PARTIAL_CUT", 4),
        ("REVERSE_PARTIAL_CUT", 9),
        ("CUT", 1),
        ("ANCHOR", 20),
    }


@pytest.mark.parametrize(
    ("kind", "front", "back"),
    [
        ("half-cut", "score_front", "score_back"),
        ("v-score", "score_front", "score_back"),
        ("crease-wheel", "crease_front", "crease_back"),
        ("stylus", "crease_front", "crease_back"),
        ("perforation", "perforation", "perforation"),
    ],
)
def test_what_is_pressed_is_no_cut_and_what_goes_through_has_no_side(
    kind: Kind, front: str, back: str
) -> None:
    assert layer_of(Role.SCORE, Face.FRONT, kind) == front
    assert layer_of(Role.SCORE, Face.REVERSE, kind) == back
    assert layer_of(Role.CUT_OUTER, Face.FRONT, kind) == "cut_outer"


def test_a_profile_of_ones_own_says_only_what_is_other(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(OWN, encoding="utf-8")
    profile = profiles.find(str(tmp_path / "mine.toml"))
    assert profile.layers.cut_outer.name == "THRU"
    assert profile.layers.cut_inner.name == "CUT_INNER"
    drawn = svg.write(PLAN, FOLD, Style(profile))["reverse.svg"]
    assert b'"THRU Pen 7 Speed 8 Force 300"' in drawn


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("aci = 30", "aci = 300", "line 7"),
        ('"THRU"', '"THRU 2"', "line 6"),
        ('"#123456"', '"blue"', "line 8"),
        ("cut_outer", "cut_outest", "cut_outest"),
        ("pen = 7", "pen = ", "no TOML"),
    ],
)
def test_a_broken_profile_is_refused_by_line(
    old: str, new: str, reason: str, tmp_path: Path
) -> None:
    (tmp_path / "mine.toml").write_text(OWN.replace(old, new), encoding="utf-8")
    with pytest.raises(UnreadableFile, match=reason):
        profiles.find(str(tmp_path / "mine.toml"))


def test_a_profile_nobody_has_is_refused_with_those_there_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    with pytest.raises(UnknownName, match="artioscad"):
        profiles.find("artiscad")
    with pytest.raises(UnreadableFile, match="cannot be read"):
        profiles.find(str(tmp_path / "gone.toml"))
    (tmp_path / "foldmill" / "profiles").mkdir(parents=True)
    (tmp_path / "foldmill" / "profiles" / "mine.toml").write_text(OWN, encoding="utf-8")
    assert profiles.find("mine").slug == "mine"
    assert profiles.names()[-1] == "mine"


def test_a_legend_names_every_layer_that_is_drawn_and_no_other() -> None:
    legend = svg.write(PLAN, FOLD)["legend.svg"].decode()
    for name in ("REG", "SCORE_FRONT", "SCORE_BACK", "CUT_INNER", "CUT_OUTER", "NOTE"):
        assert f">{name}, " in legend
    assert "CREASE_FRONT" not in legend
    assert "PERF" not in legend


def test_the_command_lists_profiles_and_prints_a_legend() -> None:
    listed = CliRunner().invoke(app, ["profiles"])
    assert all(name in listed.output for name in profiles.shipped())
    shown = CliRunner().invoke(app, ["profiles", "--show", "artioscad"])
    assert "REVERSE_PARTIAL_CUT" in shown.output
    assert shown.exit_code == listed.exit_code == 0


@pytest.mark.parametrize("name", ["artioscad", "lightburn"])
def test_librecad_opens_r12(name: str, tmp_path: Path) -> None:
    content = dxf.write(PLAN, FOLD, Style(profiles.find(name), "R12"))["front.dxf"]
    assert readers.librecad_pdf(content, tmp_path).startswith(b"%PDF")
