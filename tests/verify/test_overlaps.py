"""An overlap is proven of bodies that are far thinner than they are long."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from satcheck.report.certificate import SurfacesProof
from satcheck.verify.exact import lattice
from satcheck.verify.pairs import Pair
from satcheck.verify.relations import prove
from satcheck.verify.world import Exact, World
from tests.audit.shapes import Mesh, bracket, unit_box


def sheared(mesh: Mesh, by: int) -> World:
    """A shear of determinant 1: layers that are about `by` times as long as they are thick."""
    points, faces = mesh
    fans = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    shear = np.array([[by, by - 1, 3], [1, 1, 0], [0, 5, 1]], dtype=float)
    return World(np.array(points) @ shear.T, np.array(fans, dtype=np.int64), True)


@pytest.mark.parametrize("by", [1, 2**10, 2**20, 2**30])
@pytest.mark.parametrize(
    "box",
    [
        unit_box(5.5, 0.5, 1.0),  # its faces cross those of the arm
        unit_box(1.0, 0.0, 0.0),  # its faces lie in those of the arm
        unit_box(5.0, 1.0, 3.0),  # it fills the corner of the arm
    ],
)
def test_an_overlap_of_thin_bodies_is_shown(box: Mesh, by: int) -> None:
    a, b = sheared(bracket(), by), sheared(box, by)
    k = max(lattice(a.vertices), lattice(b.vertices))
    pair = Pair(Exact(a, k), Exact(b, k))
    prove("penetrating", SurfacesProof(), pair, Fraction(0), Fraction(0))
