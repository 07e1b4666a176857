"""The relation of sheets in one plane: quick where many overlap, undecided beyond its budget, and
ended by Ctrl-C. So do contacts and components end."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
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


def bars(count: int, axis: int) -> core.Mesh:
    """Long boxes beside each other."""
    low, high = np.zeros((count, 3)), np.full((count, 3), 2.0 * count)
    low[:, axis], low[:, 2] = 2 * np.arange(count), 0.1 * axis
    high[:, axis], high[:, 2] = low[:, axis] + 1, low[:, 2] + 1
    low[:, 1 - axis] = -1.0
    picks = np.array(list(np.ndindex(2, 2, 2)), bool)[:, ::-1]
    points = np.where(picks[None], high[:, None], low[:, None]).reshape(-1, 3)
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    of_one = np.array([[f[0], f[k], f[k + 1]] for f in faces for k in (1, 2)], np.int32)
    return core.Mesh(points, (of_one[None] + 8 * np.arange(count)[:, None, None]).reshape(-1, 3))


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
def test_ctrl_c_ends_contacts() -> None:
    a, b = (core.Surface(soup(TOO_MANY, seed), False) for seed in (1, 2))
    with pytest.raises(KeyboardInterrupt), ctrl_c_after(0.5):
        core.surface_intersection(a, b, 10**9)


@on_linux
@pytest.mark.parametrize("ask", [core.overlap_components, core.passes_through])
def test_ctrl_c_ends_components(ask: Callable[[core.Surface, core.Surface, int], object]) -> None:
    """Prisms that cross each other in a lattice: some 10 ** 6 pairs of triangles meet."""
    a, b = (core.Surface(bars(200, axis), True) for axis in (0, 1))
    with pytest.raises(KeyboardInterrupt), ctrl_c_after(0.5):
        ask(a, b, 10**9)


@on_linux
def test_ctrl_c_ends_a_relation() -> None:
    surfaces = [core.Surface(soup(TOO_MANY, seed), False) for seed in (1, 2)]
    with pytest.raises(KeyboardInterrupt), ctrl_c_after(0.5):
        core.mesh_relation(*surfaces)
