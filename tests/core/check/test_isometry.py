"""Folding does not stretch a sheet."""

from __future__ import annotations

from dataclasses import replace

import pytest

from foldmill import Fold, FoldedForm
from foldmill.check import isometry
from foldmill_plugins.tuck import DESIGN


@pytest.mark.parametrize("moved", [1e-8, 0.5])
def test_a_vertex_moved_in_space_stretches_the_edges_about_it(moved: float) -> None:
    stool = DESIGN.run(DESIGN.preset("stool-n8"))
    assert stool.folded is not None
    vertices = stool.folded.vertices.copy()
    vertices[3] += [0, 0, moved]
    report = isometry(replace(stool, folded=FoldedForm(vertices)))
    (finding,) = report.findings
    edge = int(report.figures["isometry_edge"])
    assert finding.code == "isometry"
    assert 3 in stool.pattern.edges[edge]
    assert f"edge {edge} (" in finding.where
    assert float(report.figures["isometry"]) <= moved / stool.pattern.size


def test_turning_and_shifting_the_form_stretches_nothing() -> None:
    stool: Fold = DESIGN.run(DESIGN.preset("stool-n8"))
    assert stool.folded is not None
    turned = stool.folded.vertices[:, [1, 2, 0]] + [100, 200, 300]
    assert not isometry(replace(stool, folded=FoldedForm(turned))).findings
