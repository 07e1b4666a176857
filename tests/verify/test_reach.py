"""How deep a surface reaches into a solid, decided from both surfaces alone."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from satcheck import core
from satcheck.verify import Rejected
from satcheck.verify import excuse as module
from satcheck.verify.excuse import reaches_no_deeper
from satcheck.verify.surfaces import meeting
from tests.audit.shapes import Mesh, box, bracket, unit_box
from tests.audit.stages.certificate.test_thickness import prism
from tests.verify.test_cover import pair_of
from tests.verify.test_passing import random_rods, ring

DEEP = "a thin part of a body reaches deep into the other one"
FIN = box((-1.5, -0.01, -0.5), (0.75, 0.01, 0.5))
BLOCK = box((0, -2, -2), (3, 2, 2))


def rejected(body: Mesh, solid: Mesh, length: float) -> str | None:
    pair = pair_of(body, solid)
    try:
        reaches_no_deeper(pair.a, pair.b, meeting(pair.a, pair.b), Fraction(length))
    except Rejected as why:
        return str(why)
    return None


@pytest.mark.parametrize(
    ("body", "solid", "depth"),
    [
        (FIN, BLOCK, 0.75),
        (unit_box(0.25, 0.25, 0.25, edge=0.5), unit_box(), 0.25),
        (unit_box(), unit_box(0.25, 0.25, 0.25, edge=0.5), 0.0),
        (unit_box(), unit_box(0.75), 0.25),
        (unit_box(1.0), unit_box(), 0.0),
        (box((1.9375, 1.9375, 1.0), (3.0, 3.0, 2.0)), bracket(), 0.0625 * 2**0.5),
        (box((2.25, 2.25, 1.0), (3.0, 3.0, 2.0)), bracket(), 0.0),
    ],
    ids=["a fin", "within", "around", "flush", "on a face", "a key", "a loose key"],
)
def test_the_length_is_that_of_the_deepest_point(body: Mesh, solid: Mesh, depth: float) -> None:
    assert rejected(body, solid, depth + 2.0**-6) is None
    if depth:
        assert rejected(body, solid, depth - 2.0**-6) == DEEP


def test_a_bolt_of_16_corners_fits_its_hole_of_24() -> None:
    bolt, plate = prism(16, 5.0, 0.25, -1.0, 3.0), ring(24, 5.0, 8.0, 0.0, 2.0)
    assert rejected(bolt, plate, 0.125) is None
    assert rejected(plate, bolt, 0.125) is None


def test_it_gives_up_with_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_PIECES", 3)
    why = rejected(box((1.9375, 1.9375, 1.0), (3.0, 3.0, 2.0)), bracket(), 0.09)
    assert why is not None
    assert "is open after" in why


@pytest.mark.parametrize("seed", range(12))
def test_the_core_sees_the_same(seed: int) -> None:
    rods = random_rods(seed)
    worlds = [exact.world for exact in (lambda p: (p.a, p.b))(pair_of(*rods))]
    meshes = [core.Mesh(w.vertices, w.triangles.astype(np.int32)) for w in worlds]
    solid = core.Surface(meshes[1], solid=True)
    for length in (0.05, 0.2, 0.4, 0.6):
        deeper = core.reaches_deeper(meshes[0], solid, length, 10**9)
        assert deeper is not None
        assert rejected(*rods, length) == (DEEP if deeper else None)
