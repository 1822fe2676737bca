"""What runs in the sandbox cannot take more than it may have, nor leave anything behind."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from unhurried import of_tests

from foldmill_fabricate.beside import LOWEST
from foldmill_fabricate.service.sandbox import (
    Limits,
    Refused,
    Sandbox,
    SandboxFailed,
    TooBusy,
    TooMuch,
)

LITTLE = Limits(seconds=0.5, memory_mb=200, file_mb=1)
LONG = Limits(seconds=60)


@pytest.fixture(scope="module")
def sandbox(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Sandbox]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", of_tests())
        box = Sandbox(tmp_path_factory.mktemp("scratch"), ["sandbox_probes"], at_once=2, waiting=3)
        assert box.wait_ready()
        yield box
        box.close()


def test_arguments_go_in_and_values_come_out_as_they_are(sandbox: Sandbox) -> None:
    given = {"text": "ä\n\u2028", "numbers": [1, 2.5, None], "nested": {"yes": True}}
    found = sandbox.run("sandbox_probes:echo", given)
    assert found.pop("here").startswith(str(sandbox.scratch))
    assert found == given


def test_what_reads_drawings_is_there_before_the_first_of_them_comes(tmp_path: Path) -> None:
    needed = ["ezdxf", "scipy.spatial", "shapely", "foldmill_plugins.tuck"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", of_tests())
        box = Sandbox(tmp_path, ["foldmill_fabricate.service.work", "sandbox_probes"])
        assert box.run("sandbox_probes:loaded", {"names": needed}, limits=LONG) == needed
        box.close()


def test_nothing_that_one_piece_of_work_leaves_behind_is_seen_by_the_next(sandbox: Sandbox) -> None:
    assert [sandbox.run("sandbox_probes:remember", {"number": k}) for k in (1, 2)] == [[1], [2]]


def test_it_computes_with_low_priority_in_a_folder_of_its_own_without_our_files(
    sandbox: Sandbox,
) -> None:
    found = sandbox.run("sandbox_probes:conditions", {})
    assert found["nice"] == LOWEST
    assert found["threads"] == 1
    assert found["pid"] not in {os.getpid(), sandbox.pid}
    assert Path(found["inside"]).parent == sandbox.scratch
    assert found["open"] == [0, 1, 2]


@pytest.mark.parametrize(
    ("probe", "arguments", "sentence"),
    [
        ("sleep", {"seconds": 60}, "The file took more than 0.5 s and was stopped."),
        ("spin", {}, "The file took more than 0.5 s and was stopped."),
        ("hoard", {"megabytes": 400}, "The file needs more than 200 MB of memory"),
        ("write", {"megabytes": 2}, "The file would write a file of more than 1 MB"),
        ("crash", {}, "The file needs more than 200 MB of memory"),
    ],
)
def test_work_beyond_its_limits_is_ended_with_a_sentence(
    sandbox: Sandbox, probe: str, arguments: dict[str, int], sentence: str
) -> None:
    with pytest.raises(TooMuch) as refused:
        sandbox.run(f"sandbox_probes:{probe}", arguments, limits=LITTLE, what="The file")
    assert str(refused.value).startswith(sentence)


def test_memory_that_grows_bit_by_bit_is_refused_before_the_machine_swaps(sandbox: Sandbox) -> None:
    limits = Limits(seconds=30, memory_mb=200)
    with pytest.raises(TooMuch, match="needs more than 200 MB"):
        sandbox.run("sandbox_probes:hoard_slowly", {}, limits=limits)


def test_a_refusal_keeps_its_sentence_and_the_name_of_its_error(sandbox: Sandbox) -> None:
    arguments: dict[str, object] = {"family": "umbrella", "preset": None, "params": {}}
    with pytest.raises(Refused, match="There is no family 'umbrella'") as refused:
        sandbox.run("foldmill_fabricate.service.work:design", arguments)
    assert refused.value.kind == "UnknownName"


@pytest.mark.parametrize("probe", ["fault", "leave"])
def test_a_fault_of_ours_is_told_as_one_and_its_trace_is_for_the_log_alone(
    sandbox: Sandbox, probe: str
) -> None:
    with pytest.raises(SandboxFailed, match="by a fault of foldmill's") as failed:
        sandbox.run(f"sandbox_probes:{probe}", {})
    assert "secret" not in str(failed.value)
    assert ("secret of the house" in failed.value.log) == (probe == "fault")


def test_more_work_than_may_wait_is_refused_at_once(sandbox: Sandbox) -> None:
    kept = [sandbox.folder() for _ in range(6)]
    begun = [
        sandbox.submit("sandbox_probes:sleep", {"seconds": 0.3}, folder=folder, limits=LONG)
        for folder in kept[:5]
    ]
    with pytest.raises(TooBusy, match="2 pieces of work are under way and 3 wait"):
        sandbox.submit("sandbox_probes:echo", {}, folder=kept[5])
    assert [future.result(30) for future in begun] == [None] * 5
    assert sandbox.load == (0, 0)


def test_a_nursery_that_is_killed_is_replaced_and_only_its_own_work_is_lost(
    sandbox: Sandbox,
) -> None:
    folders = [sandbox.folder() for _ in range(3)]
    first, second = (
        sandbox.submit("sandbox_probes:sleep", {"seconds": 60}, folder=folder, limits=LONG)
        for folder in folders[:2]
    )
    third = sandbox.submit("sandbox_probes:echo", {}, folder=folders[2], limits=LONG)
    while not all((folder / "begun").exists() for folder in folders[:2]):
        time.sleep(0.01)
    before = sandbox.pid
    assert before is not None
    os.kill(before, signal.SIGKILL)
    for lost in (first, second):
        with pytest.raises(SandboxFailed, match="was interrupted and nothing was kept"):
            lost.result(30)
    assert third.result(60)["here"] == str(folders[2])
    assert sandbox.pid not in {None, before}


def test_closing_ends_the_processes_and_refuses_what_waited(tmp_path: Path) -> None:
    box = Sandbox(tmp_path, at_once=1)
    assert box.wait_ready()
    nursery, folder = box.pid, box.folder()
    begun = box.submit("sandbox_probes:sleep", {"seconds": 60}, folder=folder)
    box.close()
    with pytest.raises(TooBusy, match="send it again when it is back"):
        begun.result(5)
    with pytest.raises(TooBusy, match="takes no more work"):
        box.submit("json:loads", {}, folder=folder)
    assert nursery is not None
    with pytest.raises(ProcessLookupError):
        os.kill(nursery, 0)
