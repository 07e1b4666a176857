"""Past the deadline there are no parts, wherever that is noticed."""

from __future__ import annotations

import pytest

from satcheck.core import Mesh, Surface
from satcheck.decompose import DecompositionError, computation, decompose, errors
from satcheck.decompose.error_bounds import missing_error
from satcheck.decompose.errors import NEVER, Deadline
from satcheck.decompose.inner_parts import free_region, inner_parts

OVER = Deadline(-1.0)


def test_it_is_over_or_it_is_not() -> None:
    NEVER.check()
    assert OVER.left == 0.0
    with pytest.raises(DecompositionError, match="no convex parts after -1 s") as raised:
        OVER.check()
    assert raised.value.code == errors.TIMEOUT


def test_every_long_step_looks_at_it(l_shape: Mesh) -> None:
    mesh = l_shape
    hull, surface = mesh.convex_hull(), Surface(mesh, True)
    steps = (
        lambda: missing_error(mesh, [hull], OVER),
        lambda: inner_parts([hull], surface, OVER),
        lambda: free_region(hull, surface, OVER),
    )
    for step in steps:
        with pytest.raises(DecompositionError):
            step()


def test_measuring_the_parts_counts_too(l_shape: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    class OverAfterCoacd(Deadline):
        left = 60.0

    monkeypatch.setattr(computation, "Deadline", lambda _: OverAfterCoacd(-1.0))
    with pytest.raises(DecompositionError) as raised:
        decompose(l_shape, cache=None)
    assert raised.value.code == errors.TIMEOUT
