"""The relation of sheets in one plane: quick where many overlap, undecided beyond its budget, and
ended by Ctrl-C."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from satcheck import core
from tests.audit.batch.test_slot import on_linux

Question = tuple[core.PlacedGeometry, core.PlacedGeometry, float, float, float, float, bool]

TOO_MANY = 3000


def soup(count: int, seed: int) -> core.Mesh:
    """Triangles in one plane; most of them overlap."""
    rng = np.random.default_rng(seed)
    points = np.zeros((3 * count, 3))
    points[:, :2] = rng.random((3 * count, 2))
    return core.Mesh(points, np.arange(3 * count, dtype=np.int32).reshape(count, 3))


def placed(mesh: core.Mesh) -> core.PlacedGeometry:
    return core.PlacedGeometry(core.Geometry(mesh, False, sheets=True), None, mesh.bounds, 1e-12)


def question(count: int) -> Question:
    return placed(soup(count, 1)), placed(soup(count, 2)), 0.0, 0.0, 0.0, 0.0, False


@contextmanager
def ctrl_c_after(seconds: float) -> Iterator[None]:
    timer = threading.Timer(seconds, signal.raise_signal, (signal.SIGINT,))
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()


def test_many_sheets_in_one_plane_are_decided() -> None:
    # A ray for each stretch and side of each triangle would cost some 10 ** 9 of them.
    found = core.mesh_relation(*(core.Surface(soup(120, seed), False) for seed in (1, 2)))
    assert (found.relation, found.proven, found.decided) == ("touching", True, True)


def test_a_relation_beyond_its_budget_is_undecided() -> None:
    climb = core.climb(question(TOO_MANY))
    assert (climb.relation, climb.decided, climb.proven) == ("indeterminate", False, False)
    assert climb.triangles is not None
    assert not climb.triangles.decided


@on_linux
@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c_ends_climbs(threads: int) -> None:
    climbing = core.Climbing([question(TOO_MANY) for _ in range(40)], threads=threads)
    with pytest.raises(KeyboardInterrupt), ctrl_c_after(0.5):
        climbing.results()


@on_linux
def test_ctrl_c_ends_a_relation() -> None:
    surfaces = [core.Surface(soup(TOO_MANY, seed), False) for seed in (1, 2)]
    with pytest.raises(KeyboardInterrupt), ctrl_c_after(0.5):
        core.mesh_relation(*surfaces)
