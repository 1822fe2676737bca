"""Tokens are told once, and kept as digests."""

from __future__ import annotations

import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from foldmill.errors import InvalidInput, UnknownName, UnreadableFile
from foldmill_fabricate.service.tokens import Scope, Tokens


def test_a_token_is_found_by_its_secret_and_the_secret_is_kept_nowhere(tmp_path: Path) -> None:
    secret = Tokens(tmp_path).new("anna", Scope.SUBMIT)
    found = Tokens(tmp_path).find(secret)
    assert found is not None
    assert (found.name, found.scope) == ("anna", Scope.SUBMIT)
    for file in tmp_path.iterdir():
        assert secret not in file.read_text()
        assert secret.removeprefix("foldmill_") not in file.read_text()


def test_only_its_owner_reads_the_file(tmp_path: Path) -> None:
    Tokens(tmp_path).new("anna", Scope.VIEW)
    assert {stat.S_IMODE(file.stat().st_mode) for file in tmp_path.iterdir()} == {0o600}


def test_no_two_tokens_are_alike_and_none_is_short(tmp_path: Path) -> None:
    tokens = Tokens(tmp_path)
    secrets = {tokens.new(f"t{k}", Scope.VIEW) for k in range(50)}
    assert len(secrets) == 50
    assert min(map(len, secrets)) >= 43 + len("foldmill_")


@pytest.mark.parametrize("wrong", ["", "foldmill_", "x", "ä", "foldmill_" + "a" * 43])
def test_another_secret_finds_nothing(tmp_path: Path, wrong: str) -> None:
    tokens = Tokens(tmp_path)
    tokens.new("anna", Scope.VIEW)
    assert tokens.find(wrong) is None


def test_a_scope_allows_itself_and_what_stands_before_it() -> None:
    allowed = [[one.allows(other) for other in Scope] for one in Scope]
    assert allowed == [[True, False, False], [True, True, False], [True, True, True]]


def test_names_are_plain_and_taken_once(tmp_path: Path) -> None:
    tokens = Tokens(tmp_path)
    tokens.new("anna", Scope.VIEW)
    with pytest.raises(InvalidInput, match="revoke it first"):
        tokens.new("anna", Scope.OPERATE)
    for name in ("", "../x", "a b", "\n", "x" * 41):
        with pytest.raises(InvalidInput, match="is no name for a token"):
            tokens.new(name, Scope.VIEW)
    with pytest.raises(UnknownName, match="There are: anna"):
        tokens.revoke("berta")


@pytest.mark.parametrize("content", ["", "{}", "[1]", '[{"name": "x"}]', "\x00"])
def test_a_broken_file_lets_nobody_in(tmp_path: Path, content: str) -> None:
    (tmp_path / "tokens.json").write_text(content)
    if content != "{}":
        with pytest.raises(UnreadableFile, match="nobody is let in"):
            Tokens(tmp_path).find("anything")
    else:
        assert Tokens(tmp_path).find("anything") is None


def test_tokens_that_are_made_and_revoked_at_once_are_all_as_was_wanted(tmp_path: Path) -> None:
    """Each by a command of its own: none writes back what another has revoked."""
    old = [f"old{k}" for k in range(12)]
    for name in old:
        Tokens(tmp_path).new(name, Scope.VIEW)
    with ThreadPoolExecutor(8) as pool:
        made = pool.map(lambda k: Tokens(tmp_path).new(f"new{k}", Scope.VIEW), range(12))
        gone = pool.map(lambda name: Tokens(tmp_path).revoke(name), old)
        assert len({*made}) == len([*gone]) == 12
    assert [token.name for token in Tokens(tmp_path).every] == sorted(f"new{k}" for k in range(12))
