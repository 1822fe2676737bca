"""Other people's programs read the stool's files as we do."""

from __future__ import annotations

from pathlib import Path

import ezdxf.filemanagement
import numpy as np
import pytest
import readers
from ezdxf import bbox
from ezdxf.addons.hpgl2.api import MergeControl, record_plotter_output
from stools import ONE_TOOL, PENS, stool, stool_plan

from foldmill_fabricate.formats import dxf, hpgl
from foldmill_fabricate.verify import interpreter

PROGRAMS = {
    f"{slug}/{name}": data
    for slug in (ONE_TOOL, PENS)
    for name, data in hpgl.write(stool_plan(slug), stool()).items()
}
DRAWINGS = dxf.write(stool_plan(), stool())


def ours(name: str) -> list[int]:
    """Extent in steps of what our own interpreter draws."""
    points = np.vstack([run.points for run in interpreter.interpret(PROGRAMS[name]).runs])
    return [int(n) for n in (*points.min(axis=0), *points.max(axis=0))]


@pytest.mark.parametrize("name", PROGRAMS)
def test_ezdxf_reads_the_programs_extent_to_one_unit(name: str) -> None:
    box = record_plotter_output(PROGRAMS[name], MergeControl.NONE).bbox()
    assert (*box.extmin, *box.extmax) == pytest.approx(ours(name), abs=1)


@pytest.mark.parametrize("name", PROGRAMS)
def test_hp2xx_reads_the_programs_extent_to_one_unit(name: str, tmp_path: Path) -> None:
    assert readers.hp2xx_extent(PROGRAMS[name], tmp_path) == pytest.approx(ours(name), abs=1)


@pytest.mark.parametrize("name", DRAWINGS)
def test_the_drawings_are_sound_metric_and_true_to_size(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(DRAWINGS[name])
    drawing = ezdxf.filemanagement.readfile(tmp_path / name)
    assert drawing.dxfversion == "AC1015"
    assert drawing.header["$INSUNITS"] == 4
    assert not drawing.audit().has_errors
    scores = drawing.modelspace().query('*[layer ? "SCORE.*|CUT.*"]')
    size = bbox.extents(scores).size
    assert max(size.x, size.y) == pytest.approx(490.03, abs=0.1)


@pytest.mark.parametrize("name", DRAWINGS)
def test_librecad_opens_the_drawings(name: str, tmp_path: Path) -> None:
    assert readers.librecad_pdf(DRAWINGS[name], tmp_path).startswith(b"%PDF")
