"""``import foldmill`` is curated and quick."""

from __future__ import annotations

import subprocess
import sys

import foldmill

HEAVY = ("scipy", "shapely", "trimesh", "matplotlib", "numba", "networkx", "ezdxf", "serial")


def test_the_public_names_are_sorted_and_there() -> None:
    names = foldmill.__all__
    assert names == sorted(names)
    assert len(set(names)) == len(names)
    assert [name for name in names if not hasattr(foldmill, name)] == []


def test_every_public_name_of_ours_is_exported() -> None:
    ours = {
        name
        for name, value in vars(foldmill).items()
        if not name.startswith("_") and getattr(value, "__module__", "").startswith("foldmill.")
    }
    assert sorted(ours - set(foldmill.__all__)) == []


def test_every_exported_class_and_function_is_documented() -> None:
    values = {name: getattr(foldmill, name) for name in foldmill.__all__}
    ours = {k: v for k, v in values.items() if getattr(v, "__module__", "").startswith("foldmill")}
    assert [name for name, value in ours.items() if not value.__doc__] == []


def test_importing_the_core_and_the_families_loads_nothing_heavy() -> None:
    code = (
        "import sys, foldmill, foldmill_plugins.rotational, foldmill_plugins.tuck;"
        f"print([m for m in {HEAVY!r} if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
