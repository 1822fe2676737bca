"""The plot of dihedral angles: one line for creases that mirror each other, the stop marked."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from foldmill import Fold
from foldmill.dihedral import DihedralTable, dihedral_angles
from foldmill.motion import Motion
from foldmill_fabricate.pictures import angles_picture
from foldmill_fabricate.pictures.angles import groups
from foldmill_plugins.rotational import DESIGN as ROTATIONAL
from foldmill_plugins.six_crease import DESIGN

SVG = "{http://www.w3.org/2000/svg}"


def measured(fold: Fold, vertex: int) -> tuple[DihedralTable, Motion]:
    motion = next(iter(fold.motions.values()))
    return dihedral_angles(fold, motion, vertex, np.linspace(0, motion.reach, 9)), motion


def words(svg: bytes) -> str:
    """Return what matplotlib says in comments of what it drew as letters."""
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root = ElementTree.fromstring(svg, parser)
    return "\n".join(node.text or "" for node in root.iter() if callable(node.tag))


def test_mirrored_creases_are_one_line() -> None:
    table, _ = measured(DESIGN.run(DESIGN.preset("candlestick")), 17)
    assert [[table.names[k] for k in group] for group in groups(table)] == [
        ["17-19 V"],
        ["17-18 V", "17-5 V"],
        ["17-16 V", "17-3 V"],
        ["17-15 M"],
    ]


def test_the_plot_says_where_the_motion_stops_and_why() -> None:
    said = words(
        angles_picture(*measured(DESIGN.run(DESIGN.preset("vase-interrupted")), 17), ".svg")
    )
    assert "folding rate FR (%)" in said
    assert "At a folding rate of 5.167 % point" in said
    assert "17-18 V, 17-5 V" in said
    whole = words(angles_picture(*measured(DESIGN.run(DESIGN.preset("vase")), 17), ".svg"))
    assert "At a folding rate" not in whole


def test_any_family_with_a_motion_has_a_plot_over_t() -> None:
    table, motion = measured(ROTATIONAL.run(ROTATIONAL.preset("bowl-n8")), 0)
    said = words(angles_picture(table, motion, ".svg"))
    assert "t" in said.split()
    assert "and 5 more" in said  # of the eight mountains in the centre three are named
    assert angles_picture(table, motion).startswith(b"\x89PNG")


def test_the_same_table_gives_the_same_bytes() -> None:
    table, motion = measured(DESIGN.run(DESIGN.preset("cup")), 17)
    for suffix in (".svg", ".png"):
        assert angles_picture(table, motion, suffix) == angles_picture(table, motion, suffix)
