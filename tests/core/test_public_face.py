"""``import foldmill`` is curated and quick."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import foldmill

HEAVY = ("scipy", "shapely", "trimesh", "matplotlib", "numba", "networkx", "ezdxf", "serial")


def test_the_public_names_are_sorted_and_there() -> None:
    names = foldmill.__all__
    assert names == sorted(names)
    assert len(set(names)) == len(names)
    assert [name for name in names if not hasattr(foldmill, name)] == []


def test_what_is_exported_is_what_readers_of_types_are_told() -> None:
    tree = ast.parse(Path(foldmill.__file__).read_text("utf-8"))
    told = [each for each in ast.walk(tree) if isinstance(each, ast.ImportFrom)]
    names = {alias.name: each.module for each in told for alias in each.names}
    del names["import_module"], names["TYPE_CHECKING"], names["Any"]
    assert sorted(names) == foldmill.__all__
    for name, module in names.items():
        assert getattr(foldmill, name) is getattr(sys.modules[str(module)], name)


def test_there_are_no_other_names() -> None:
    assert set(foldmill.__all__) <= set(dir(foldmill))
    with pytest.raises(AttributeError, match="module 'foldmill' has no attribute 'Paper'"):
        foldmill.Paper  # noqa: B018


def test_the_package_alone_loads_not_even_numpy() -> None:
    code = "import sys, foldmill; print([m for m in ('numpy', 'pydantic') if m in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


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
