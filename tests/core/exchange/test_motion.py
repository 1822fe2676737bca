"""A motion as frames of a FOLD file."""

from __future__ import annotations

import json

import numpy as np

from foldmill.exchange import fold as fold_file
from foldmill.exchange.motion import with_frames
from foldmill_plugins.rotational import DESIGN


def test_each_frame_holds_the_form_at_its_time_and_ends_flat() -> None:
    fold = DESIGN.run()
    motion = fold.motions["unfold"]
    data = json.loads(fold_file.write(with_frames(fold, motion, 5)))
    steps = [f for f in data["file_frames"] if f.get("frame_title", "").startswith("unfold")]
    assert len(steps) == 6
    for k, frame in enumerate(steps):
        assert frame["frame_parent"] == 0
        assert frame["frame_inherit"] is True
        assert np.allclose(frame["vertices_coords"], motion.at(k / 5), atol=1e-9)
    assert np.allclose(steps[0]["edges_foldAngle"], data["edges_foldAngle"], atol=1e-6)
    assert np.abs(steps[-1]["edges_foldAngle"]).max() < 1e-6


def test_the_frames_survive_reading_and_writing() -> None:
    fold = DESIGN.run()
    text = fold_file.write(with_frames(fold, fold.motions["unfold"], 3))
    assert fold_file.write(fold_file.read(text)) == text
