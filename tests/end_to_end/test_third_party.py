"""A family by a third party, installed in an environment of its own, from list to plotter."""

from __future__ import annotations

import json
import os
import site
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

PACKAGES = Path(__file__).parents[1] / "third_party"
SOURCES = Path(__file__).parents[2]


class Environment:
    """A fresh virtual environment that sees foldmill and its dependencies."""

    def __init__(self, folder: Path) -> None:
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
        self.python = folder / "bin" / "python"
        ours = sysconfig.get_path("purelib")
        theirs = subprocess.check_output(
            [self.python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], text=True
        ).strip()
        # addsitedir also follows the .pth of an editable install, which a plain path would not.
        (Path(theirs) / "outer.pth").write_text(f"import site; site.addsitedir({ours!r})\n")

    def install(self, package: Path) -> None:
        subprocess.run(
            [
                *(sys.executable, "-m", "pip", "--python", self.python, "install", "--quiet"),
                *("--no-index", "--no-deps", "--no-build-isolation", package),
            ],
            check=True,
            capture_output=True,
        )

    def run(self, *words: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
        clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "COV"))}
        return subprocess.run(
            [self.python, "-m", *words], cwd=cwd, env=clean, capture_output=True, text=True
        )

    def foldmill(self, *words: str | Path, cwd: Path) -> str:
        done = self.run("foldmill_fabricate", *words, cwd=cwd)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Environment:
    assert site.ENABLE_USER_SITE is not None
    made = Environment(tmp_path_factory.mktemp("third party") / "env")
    for name in ("accordion", "broken"):
        copied = tmp_path_factory.mktemp(name)
        for file in (PACKAGES / name).iterdir():
            if file.is_file():
                (copied / file.name).write_bytes(file.read_bytes())
        made.install(copied)
    return made


def test_the_family_appears_with_its_owner(environment: Environment, tmp_path: Path) -> None:
    listed = json.loads(environment.foldmill("families", "--json", cwd=tmp_path))
    owners = {row["slug"]: row["owner"] for row in listed}
    assert owners["accordion"] == "foldmill-accordion"
    assert owners["tuck"] == "foldmill"


def test_a_broken_plugin_is_named_with_its_owner_and_hides_nothing(
    environment: Environment, tmp_path: Path
) -> None:
    done = environment.run("foldmill_fabricate", "plugins", "--json", cwd=tmp_path)
    told = json.loads(done.stdout)
    assert done.returncode == 1
    assert len(told["broken"]) == 1
    assert "'broken' of foldmill-broken" in told["broken"][0]
    assert "a_module_that_nobody_has" in told["broken"][0]
    offers = " ".join(row["offers"] for row in told["plugins"])
    assert "designs:accordion" in offers
    assert "designs:tuck" in offers


def test_the_family_passes_the_contract_suite_in_three_lines(
    environment: Environment, tmp_path: Path
) -> None:
    test = (PACKAGES / "accordion" / "test_contract.py").read_text()
    (tmp_path / "test_contract.py").write_text(test)
    done = environment.run("pytest", "-q", "-p", "no:cacheprovider", cwd=tmp_path)
    assert done.returncode == 0, done.stdout
    assert "passed" in done.stdout


def test_the_family_goes_through_plan_verify_and_send_unchanged(
    environment: Environment, tmp_path: Path
) -> None:
    run = environment.foldmill
    run("design", "accordion", "--pleats", "5", "-o", "fan.fold", cwd=tmp_path)
    run("plan", "fan.fold", "-o", "job", cwd=tmp_path)
    run("verify", "job", cwd=tmp_path)
    said = run("send", "job", "--port", "sim://generic-hpgl-600", "--yes", cwd=tmp_path)
    assert said.count("executed") >= 4
