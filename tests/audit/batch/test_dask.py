"""The Dask engine gives the answers of the local one, whatever happens to its workers."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import dask
import pytest
from distributed import Client, LocalCluster, Worker, WorkerPlugin

from satcheck._version import __version__
from satcheck.audit.batch import dask_worker
from satcheck.audit.batch.dask_engine import check_with_dask
from satcheck.audit.batch.local import check_locally
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.slot import Slot
from satcheck.audit.batch.slot_server import Answer
from satcheck.core.errors import SatcheckError
from tests.audit.batch.worlds import make_worlds
from tests.cli.process import SECONDS, satcheck

OPTIONS, LIMITS = CheckOptions(), Limits()
DEATHS_OF_WORKERS = 1  # that one task may survive


@pytest.fixture(scope="module")
def cluster() -> Iterator[LocalCluster]:
    """Workers are processes of one thread. One that dies is replaced."""
    settings = {
        "distributed.scheduler.allowed-failures": DEATHS_OF_WORKERS,
        "distributed.comm.timeouts.connect": "60s",
    }
    with (
        dask.config.set(settings),
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as made,
    ):
        yield made


@pytest.fixture
def client(cluster: LocalCluster) -> Iterator[Client]:
    with Client(cluster, set_as_default=False) as made:
        made.wait_for_workers(2, timeout=SECONDS)
        yield made


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[World]:
    return make_worlds(tmp_path_factory.mktemp("worlds"), 40)


@pytest.fixture(scope="module")
def expected(worlds: list[World]) -> dict[World, bytes]:
    return by_world(check_locally(worlds, OPTIONS, LIMITS, slots=1))


def by_world(answers: Iterator[list[Answer]]) -> dict[World, bytes]:
    """Each world has one answer."""
    every = [answer for some in answers for answer in some]
    found = {answer.world: answer.line for answer in every}
    assert len(found) == len(every)
    return found


def through(cluster: LocalCluster, worlds: Sequence[World]) -> Iterator[list[Answer]]:
    return check_with_dask(worlds, OPTIONS, LIMITS, cluster.scheduler_address)


@pytest.mark.usefixtures("client")
def test_answers_are_those_of_the_local_engine(
    cluster: LocalCluster, worlds: list[World], expected: dict[World, bytes]
) -> None:
    assert by_world(through(cluster, worlds)) == expected


def test_the_file_has_the_bytes_of_the_local_engine(cluster: LocalCluster, tmp_path: Path) -> None:
    """Names of files are relative to the folder of the call, not to that of a worker."""
    make_worlds(tmp_path, 5)
    far = ["--engine", "dask", "--scheduler", cluster.scheduler_address]
    for name, options in (("near", []), ("far", far)):
        ran = satcheck("batch", "*.toml", "-o", f"{name}.jsonl", *options, cwd=tmp_path)
        assert "5 assets" in ran.err
    assert (tmp_path / "far.jsonl").read_bytes() == (tmp_path / "near.jsonl").read_bytes()


def test_a_killed_worker_loses_nothing(
    cluster: LocalCluster, client: Client, worlds: list[World], expected: dict[World, bytes]
) -> None:
    workers = client.run(os.getpid)
    answers = through(cluster, worlds)
    first = next(answers)
    os.kill(next(iter(workers.values())), signal.SIGKILL)
    assert by_world(iter([first, *answers])) == expected


def test_a_worker_that_is_closed_loses_nothing(
    cluster: LocalCluster, client: Client, worlds: list[World], expected: dict[World, bytes]
) -> None:
    """As by a cluster that becomes smaller: the end of its slots gives no wrong answers."""
    cluster.scale(3)
    client.wait_for_workers(3, timeout=SECONDS)
    answers = through(cluster, worlds)
    first = next(answers)
    client.retire_workers([next(iter(client.nthreads()))])
    assert by_world(iter([first, *answers])) == expected


class Poisoned(Slot):
    """Some worlds end the process of the Dask worker itself."""

    def check(self, worlds: Iterable[World]) -> Iterator[Answer]:
        worlds = tuple(worlds)
        if any(name.endswith("poison.toml") for (name,) in worlds):
            os.kill(os.getpid(), signal.SIGKILL)
        return super().check(worlds)


class Poisoning(WorkerPlugin):
    def setup(self, worker: Worker) -> None:  # noqa: ARG002
        vars(dask_worker)["Slot"] = Poisoned

    def teardown(self, worker: Worker) -> None:  # noqa: ARG002
        vars(dask_worker)["Slot"] = Slot


def test_a_world_that_ends_every_worker_is_named(
    cluster: LocalCluster, client: Client, worlds: list[World], expected: dict[World, bytes]
) -> None:
    client.register_plugin(Poisoning(), "poison")
    poison = ("poison.toml",)
    try:
        found = by_world(through(cluster, [*worlds[:20], poison, *worlds[20:]]))
    finally:
        client.unregister_worker_plugin("poison")
    line = found.pop(poison)
    assert b'"worker-crashed"' in line
    assert f"{DEATHS_OF_WORKERS + 1} times".encode() in line
    assert b'"verdict":"incomplete"' in line
    assert found == expected


def _be_version(name: str) -> None:
    vars(dask_worker)["__version__"] = name


def test_workers_have_the_version_of_the_client(
    cluster: LocalCluster, client: Client, worlds: list[World]
) -> None:
    client.run(_be_version, "0.0.1")
    try:
        with pytest.raises(SatcheckError) as caught:
            list(through(cluster, worlds))
    finally:
        client.run(_be_version, __version__)
    assert caught.value.code == "other-version"
    assert "has satcheck 0.0.1" in str(caught.value)


def test_what_is_left_early_leaves_no_process(
    cluster: LocalCluster, client: Client, worlds: list[World]
) -> None:
    answers = through(cluster, worlds)
    next(answers)
    answers.close()  # type: ignore[attr-defined]
    plugins = client.run(lambda dask_worker: list(dask_worker.plugins))
    assert not any(name.startswith("satcheck-") for names in plugins.values() for name in names)


def test_no_scheduler_is_there() -> None:
    ran = satcheck("batch", "a.toml", "-o", "r.jsonl", "--engine", "dask", "--scheduler", "no.json")
    assert ran.code == 2
    assert "no-scheduler" in ran.err


@pytest.mark.parametrize("options", [["--engine", "dask"], ["--scheduler", "tcp://a:1"]])
def test_an_engine_needs_its_scheduler(options: list[str]) -> None:
    ran = satcheck("batch", "a.toml", "-o", "r", *options)
    assert ran.code == 2
    assert "need each other" in ran.err
