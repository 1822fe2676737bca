"""Sweeps on a real Dask cluster: a scheduler and two workers, each a process, on loopback."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

pytest.importorskip("distributed")

import clusters

from foldmill import Design, Fold
from foldmill_fabricate.errors import CannotExplore, EngineFailed
from foldmill_fabricate.explore import Cluster, Local, Range, Sweep, csv, explore
from foldmill_fabricate.explore.cluster import compare, fingerprint
from foldmill_plugins import rotational
from foldmill_plugins.rotational import RotationalParams
from foldmill_plugins.six_crease import DESIGN as TUBE

BOWL = replace(rotational.DESIGN, batch=None)
"""A family whose rows are generated and checked one by one."""
PHI = [Range.read("phi=60:100:0.8")]


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    at, env = tmp_path_factory.mktemp("cluster"), clusters.whole()
    with (
        clusters.scheduler(at, env) as address,
        clusters.starting(address, "one", at, env),
        clusters.worker(address, "two", at, env),
    ):
        yield Cluster(address)


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a scheduler that has no worker of its own."""
    with clusters.scheduler(tmp_path_factory.mktemp("empty"), clusters.whole()) as address:
        yield address


@pytest.fixture(scope="module")
def near() -> Sweep[RotationalParams]:
    """The bowls as one process of this machine makes them."""
    return swept(Local(1))


@pytest.fixture(scope="module")
def here(near: Sweep[RotationalParams]) -> bytes:
    """Their table."""
    return csv(near)


@pytest.fixture(scope="module")
def there(cluster: Cluster) -> Sweep[RotationalParams]:
    """The bowls as the cluster makes them."""
    return swept(cluster)


def swept(engine: Cluster | Local) -> Sweep[RotationalParams]:
    return explore(BOWL, BOWL.preset("bowl-n8"), PHI, engine)


def test_a_cluster_gives_the_bytes_that_this_machine_gives(
    cluster: Cluster, there: Sweep[RotationalParams], here: bytes
) -> None:
    assert len(there) == 51
    assert csv(there) == here
    tube = (TUBE, TUBE.preset("vase"), [Range.read("beta=40:80:2")])
    assert csv(explore(*tube, cluster)) == csv(explore(*tube, Local(1)))


def test_parquet_from_a_cluster_is_byte_by_byte_the_same(
    near: Sweep[RotationalParams], there: Sweep[RotationalParams]
) -> None:
    pytest.importorskip("pyarrow")
    from foldmill_fabricate.explore import parquet

    assert parquet(there) == parquet(near)


def resting() -> Design[RotationalParams]:
    """The bowls, made more slowly, so that a worker can be lost in the middle of them."""

    def generate(params: RotationalParams) -> Fold:
        import time

        time.sleep(0.01)
        return BOWL.generate(params)

    return replace(BOWL, generate=generate)


def lethal() -> Design[RotationalParams]:
    """The bowls, of which one ends the process that makes it, as a want of memory does."""

    mine = os.getpid()

    def generate(params: RotationalParams) -> Fold:
        assert os.getpid() != mine, "a cluster's work was done here"
        if params.phi > 90:
            os.kill(os.getpid(), 9)
        return BOWL.generate(params)

    return replace(BOWL, generate=generate)


def test_a_worker_that_is_lost_on_the_way_takes_no_row_with_it(
    cluster: Cluster, here: bytes, tmp_path: Path
) -> None:
    with clusters.worker(cluster.address, "three", tmp_path, clusters.whole()) as third:
        told = []

        def lose(done: int, rows: int) -> None:
            told.append((done, rows))
            if done:
                third.kill()

        sweep = explore(resting(), BOWL.preset("bowl-n8"), PHI, cluster, progress=lose)
    assert csv(sweep) == here
    assert told[1][0] < told[1][1] == 51


def test_a_cluster_that_loses_its_last_worker_ends_the_sweep_and_keeps_what_is_done(
    empty: str, here: bytes, tmp_path: Path
) -> None:
    kept, bowl = tmp_path / "kept", BOWL.preset("bowl-n8")
    with (
        clusters.worker(empty, "only", tmp_path, clusters.whole()),
        pytest.raises(EngineFailed, match=r"has had no worker for 1 s\."),
    ):
        explore(lethal(), bowl, PHI, Cluster(empty, patience_s=1), resume=kept)
    assert csv(explore(BOWL, bowl, PHI, Local(1), resume=kept)) == here


def test_a_worker_without_the_package_is_named_before_any_work_is_sent(
    cluster: Cluster, tmp_path: Path
) -> None:
    env = clusters.bare(tmp_path / "packages")
    with (
        clusters.worker(cluster.address, "bare", tmp_path, env),
        pytest.raises(EngineFailed, match=r"no foldmill on the worker tcp://.*No module named"),
    ):
        swept(cluster)


def test_a_worker_with_another_version_is_named_with_both_versions(
    cluster: Cluster, tmp_path: Path
) -> None:
    env = clusters.older(tmp_path / "packages", "0.0.7")
    with (
        clusters.worker(cluster.address, "older", tmp_path, env),
        pytest.raises(EngineFailed, match=r"On the worker tcp://.* foldmill is 0\.0\.7, here it"),
    ):
        swept(cluster)


def test_a_scheduler_without_workers_is_told_from_one_that_does_not_answer(empty: str) -> None:
    with pytest.raises(EngineFailed, match=r"has no workers, not even after 0\.5 s"):
        swept(Cluster(empty, patience_s=0.5))


def test_a_scheduler_without_the_package_is_named(tmp_path: Path) -> None:
    with (
        clusters.scheduler(tmp_path, clusters.bare(tmp_path / "packages")) as address,
        clusters.starting(address, "sound", tmp_path, clusters.whole()),
        pytest.raises(EngineFailed, match="no foldmill on the scheduler"),
    ):
        swept(Cluster(address, patience_s=30))


def test_where_no_scheduler_answers_a_sentence_says_so() -> None:
    with pytest.raises(EngineFailed, match=r"No Dask scheduler answers at tcp://127.0.0.1:9 "):
        swept(Cluster("tcp://127.0.0.1:9", patience_s=0.5))


@pytest.mark.parametrize("address", ["", "127.0.0.1:8786", "http://[", "nowhere://x:1", "tcp://x"])
def test_an_address_that_is_none_is_refused(address: str) -> None:
    with pytest.raises(CannotExplore, match="is no address of a Dask scheduler; write tcp://HOST"):
        Cluster(address)


def test_places_that_are_alike_pass_and_the_first_unlike_one_is_named() -> None:
    here = fingerprint(("foldmill",))()
    assert {"python", "foldmill", "numpy"} == set(here)
    compare(here, {"the scheduler": dict(here)})
    with pytest.raises(EngineFailed, match=r"On b numpy is 1\.0, .* 1 more places"):
        compare(here, {"a": here, "b": here | {"numpy": "1.0"}, "c": here | {"numpy": "1.1"}})
