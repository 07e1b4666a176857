"""An overlap is proven of bodies that are far thinner than they are long."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from satcheck.report.certificate import SurfacesProof
from satcheck.verify.exact import lattice
from satcheck.verify.pairs import Pair
from satcheck.verify.relations import prove
from satcheck.verify.world import Exact, World, stick_out
from tests.audit.shapes import Mesh, bracket, unit_box, write
from tests.verify.honest import document
from tests.verify.reports import verified


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


def spiked(mesh: Mesh, tip: tuple[float, float, float]) -> Mesh:
    """With two triangles of no area from its first point."""
    points, faces = mesh
    n = len(points)
    middle = tuple((x + y) / 2 for x, y in zip(points[0], tip, strict=True))
    return [*points, middle, tip], [*faces, (0, n, n + 1), (n, 0, n + 1)]


def test_a_line_does_not_stick_out(tmp_path: Path) -> None:
    """A bracket lies in a box, but for triangles without an area, which bound no material."""
    a, b = spiked(bracket(), (1.0, 1.0, 100.0)), unit_box(-1.0, -1.0, -1.0, edge=10.0)
    made = document(write(tmp_path, a=a, b=b))
    assert verified(made).accepted
    finding = made["findings"][0]
    assert finding["exact_relation"] == "inside"
    assert finding["ball"] is not None
    finding.update(relation="penetrating", exact_relation="penetrating")
    assert verified(made).findings[0].outcome == "rejected"


def test_what_has_an_area_sticks_out() -> None:
    a, b = (Exact(sheared(mesh, 1), 0) for mesh in (bracket(), unit_box(0.0, 0.0, -1.0)))
    assert stick_out(a, b, Fraction(0), None)
    assert not stick_out(a, a, Fraction(0), None)
    assert not stick_out(a, b, Fraction(100), None)
