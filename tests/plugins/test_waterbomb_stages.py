"""The shapes on the way to a form: where the form is, as large, as turned, the front in front."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from foldmill import InvalidPattern, Stage
from foldmill.folded import face_normals
from foldmill_fabricate.pictures import stages_picture
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.closeness import mesh_distances


@pytest.mark.parametrize(
    "name", ["sphere", "vase", "torus", "moebius", "hyperbolic-paraboloid", "elbow"]
)
def test_target_and_base_mesh_lie_where_the_form_lies(name: str) -> None:
    fold, stages = DESIGN.run(DESIGN.presets[name]), DESIGN.stages
    assert stages is not None
    assert fold.folded is not None
    target, base = stages(DESIGN.presets[name])
    form, faces = fold.folded.vertices, fold.pattern.faces
    diagonal = float(np.linalg.norm(np.ptp(form, axis=0)))
    for stage in (target, base):
        away = mesh_distances(form, stage.vertices[stage.faces])
        assert away.mean() < 0.03 * diagonal
        assert away.max() < 0.1 * diagonal
    fronts = face_normals(form, faces)
    middles = form[faces].mean(axis=1)
    normals = face_normals(target.vertices, target.faces)
    spots = target.vertices[target.faces].mean(axis=1)
    near = np.array([np.linalg.norm(spots - m, axis=1).argmin() for m in middles])
    along = (fronts * normals[near]).sum(axis=1)
    assert along.mean() > 0.3
    assert len(base.faces) == len(faces)


def test_a_picture_has_a_part_for_each_stage_and_shows_them_all() -> None:
    params = DESIGN.presets["catenoid-8x6"]
    fold, make = DESIGN.run(params), DESIGN.stages
    assert make is not None
    stages = make(params)
    image = np.asarray(Image.open(BytesIO(stages_picture(fold, stages))).convert("L"))
    parts = np.array_split(image[60:], 4, axis=1)
    assert all((part < 200).mean() > 0.05 for part in parts)
    one = np.asarray(Image.open(BytesIO(stages_picture(fold, stages[1:]))).convert("L"))
    assert one.shape[1] == pytest.approx(image.shape[1] * 3 / 4, abs=2)


def test_a_stage_that_is_no_mesh_is_refused() -> None:
    faces = np.array([[0, 1, 2]])
    with pytest.raises(InvalidPattern, match="'target' is no mesh"):
        Stage("target", np.full((3, 3), np.nan), faces, np.ones((1, 3), bool))
    with pytest.raises(InvalidPattern, match="'target' is no mesh"):
        Stage("target", np.zeros((3, 2)), faces, np.ones((1, 3), bool))
    with pytest.raises(InvalidPattern, match="'target' is no mesh"):
        Stage("target", np.zeros((3, 3)), faces, np.ones((2, 3), bool))
