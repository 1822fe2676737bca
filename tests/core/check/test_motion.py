"""A motion that passes through itself is found, with its first place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from foldmill.check.intersection import penetrations
from foldmill.check.motion import scan
from foldmill.motion import Motion
from foldmill_plugins import rotational, six_crease


@pytest.mark.parametrize("name", rotational.DESIGN.presets)
def test_the_presets_open_without_passing_through_themselves(name: str) -> None:
    fold = rotational.DESIGN.run(rotational.DESIGN.preset(name))
    seen = scan(fold, fold.motions["unfold"], 24)
    assert seen.is_free
    assert seen.free_until == 1


def test_a_vase_folds_along_the_arc_as_far_as_it_reaches() -> None:
    fold = six_crease.DESIGN.run(six_crease.DESIGN.preset("vase"))
    assert scan(fold, fold.motions["along-arc"], 12).is_free


def test_the_first_penetration_is_where_the_whole_mesh_first_penetrates() -> None:
    """Close the crown instead of opening it: somewhere its points meet."""
    fold = rotational.DESIGN.run(rotational.DESIGN.preset("crown-n6"))
    params = rotational.DESIGN.preset("crown-n6")

    def closing(t: float) -> np.ndarray:
        shut = rotational.DESIGN.run(params.model_copy(update={"phi": params.phi * (1 - t)}))
        assert shut.folded is not None
        return np.asarray(shut.folded.vertices)

    motion = Motion("close", "Close", closing, reach=0.9)
    seen = scan(replace(fold, symmetry=None), motion, 18)
    assert not seen.is_free
    edges, faces = fold.pattern.edges, fold.pattern.faces
    assert not len(penetrations(closing(seen.free_until), edges, faces))
    assert len(penetrations(closing(seen.free_until + 2e-4), edges, faces))
