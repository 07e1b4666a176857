"""decompose/coacd_server.py: CoACD in its child, at any scale and place."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.core.worker import WorkerCrashed, run_isolated
from satcheck.decompose.coacd_server import decode_reply, encode_request
from satcheck.decompose.settings import DecompositionSettings

MODULE = "satcheck.decompose.coacd_server"


def parts_of(*meshes: Mesh) -> list[tuple[bytes, bytes]]:
    request = encode_request(DecompositionSettings(), meshes)
    return decode_reply(run_isolated(MODULE, request, seconds=60.0, megabytes=4096))


def vertices(part: tuple[bytes, bytes]) -> np.ndarray:
    return np.frombuffer(part[0], dtype="<f8").reshape(-1, 3)


def test_the_same_request_gives_the_same_bytes(torus: Mesh) -> None:
    assert parts_of(torus) == parts_of(torus)


@pytest.mark.parametrize("exponent", [-140, -30, 30, 140])
def test_a_power_of_two_scales_the_parts_exactly(l_shape: Mesh, exponent: int) -> None:
    scaled = Mesh(np.ldexp(np.asarray(l_shape.vertices), exponent), np.asarray(l_shape.triangles))
    expected = parts_of(l_shape)
    found = parts_of(scaled)
    assert [part[1] for part in found] == [part[1] for part in expected]
    for here, there in zip(expected, found, strict=True):
        np.testing.assert_array_equal(np.ldexp(vertices(here), exponent), vertices(there))


def test_a_translation_translates_the_parts(l_shape: Mesh) -> None:
    offset = (1024.0, -2048.0, 0.5)
    expected, found = parts_of(l_shape), parts_of(l_shape.translated(offset))
    for here, there in zip(expected, found, strict=True):
        np.testing.assert_allclose(vertices(here) + offset, vertices(there), atol=2048.0 * 2e-16)


def test_several_meshes_give_their_parts_in_order(l_shape: Mesh, u_shape: Mesh) -> None:
    first, second = parts_of(l_shape), parts_of(u_shape)
    assert parts_of(l_shape, u_shape) == first + second


def test_a_mesh_it_cannot_take_kills_only_the_child() -> None:
    no_triangles = Mesh(np.eye(3), np.zeros((0, 3), dtype=np.uint32))
    with pytest.raises(WorkerCrashed):
        parts_of(no_triangles)
