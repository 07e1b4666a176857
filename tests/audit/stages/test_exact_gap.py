"""Gaps of needles and of bodies that are very close for their size, to the last rounding."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from satcheck.audit import Settings, check
from satcheck.audit.stages.exact_gap import narrowed
from satcheck.core.shapes import Cone, Cylinder
from tests.audit.shapes import Mesh, moved, scene_of, unit_box
from tests.core.curved.bodies import ask, shape
from tests.core.curved.bodies import moved as placed
from tests.verify.reports import pieces

FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def needles(thin: float) -> tuple[Mesh, Mesh]:
    """Tetrahedra of length 20 across each other, 3 * thin apart: a corner of A and an edge of B."""
    a = [(-10.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.0, thin, -thin), (0.0, 0.0, thin)]
    b = [(0.0, -10.0, 4 * thin), (0.0, 10.0, 4 * thin)]
    b += [(thin, 0.0, 5 * thin), (-thin, 0.0, 5 * thin)]
    return (a, list(FACES)), (b, list(FACES))


def turned(mesh: Mesh) -> Mesh:
    """By angles whose cosines are 0.6 and 5/13, so that every coordinate is rounded."""
    points, faces = mesh
    points = [(0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z) for x, y, z in points]
    c, s = 5 / 13, 12 / 13
    return [(x, c * y - s * z, s * y + c * z) for x, y, z in points], faces


def corner_to_edge(a: Mesh, b: Mesh) -> float:
    """The distance of the last corner of A from the line of the first two of B."""
    p, (q, r) = a[0][3], b[0][:2]
    d = [Fraction(j) - Fraction(i) for i, j in zip(q, r, strict=True)]
    w = [Fraction(i) - Fraction(j) for i, j in zip(p, q, strict=True)]
    along = Fraction(sum(i * j for i, j in zip(d, w, strict=True)))
    squared = sum(i * i for i in w) - along * along / sum(i * i for i in d)
    shift = 400
    return math.isqrt(int(squared * (1 << shift))) / (1 << (shift // 2))


def only(tmp_path, a, b, **settings):
    asked = Settings(tolerance=0.0, certificate=True, cache=False, **settings)
    (finding,) = check(scene_of(tmp_path, a=a, b=b), asked).findings
    return finding


@pytest.mark.parametrize("convex", [True, False])
@pytest.mark.parametrize("thin", [2.0**-20, 2.0**-30, 2.0**-40, 2.0**-44])
def test_the_gap_of_needles(tmp_path, thin, convex):
    a, b = needles(thin)
    if not convex:
        a, b = pieces(a, unit_box(50.0)), pieces(b, unit_box(-60.0))
    finding = only(tmp_path, a, b, clearance=4 * thin)
    assert finding.relation == "near"
    assert finding.distance == pytest.approx(3 * thin, rel=1e-15, abs=0.0)
    assert (finding.quality, finding.distance_bounds) == ("exact", None)
    assert finding.normal == (0.0, 0.0, 1.0)
    assert finding.witness.b[2] - finding.witness.a[2] == pytest.approx(3 * thin, rel=1e-15)
    assert bool(finding.certificate.distance) is convex
    assert only(tmp_path, a, b, clearance=3 * thin).relation == "separated"


@pytest.mark.parametrize("convex", [True, False])
@pytest.mark.parametrize("thin", [1e-6, 1e-9, 1e-12])
def test_the_gap_of_turned_needles(tmp_path, thin, convex):
    a, b = map(turned, needles(thin))
    truth = corner_to_edge(a, b)
    if not convex:
        a, b = pieces(a, unit_box(50.0)), pieces(b, unit_box(-60.0))
    finding = only(tmp_path, a, b, clearance=4 * thin)
    assert finding.distance == pytest.approx(truth, rel=2e-9, abs=0.0)
    assert finding.quality == "exact"
    assert bool(finding.certificate.distance) is convex


def test_what_touches_is_0_apart(tmp_path):
    a, b = map(turned, (unit_box(), unit_box(1.0)))
    finding = only(tmp_path, a, b, clearance=0.5)
    if finding.exact_relation == "touching":
        assert finding.distance == 0
    below = only(tmp_path, unit_box(), moved(unit_box(), 1.0, 0.0, 0.0), clearance=0.5)
    assert (below.exact_relation, below.distance) == ("touching", 0.0)


def test_a_gap_that_rounding_leaves_open_has_bounds():
    """Shapes with curved sides have no exact comparison."""
    rod = shape("rod", Cylinder(1.0, 2.0))
    for gap in (0.5, 1e-6):
        cone = shape("cone", Cone(1.0, 2.0), placed(2.0 + gap, 0.0, 0.0))
        found = ask(rod, cone, clearance=1.0)
        low, high = found.distance_bounds or (found.distance, found.distance)
        assert low <= found.distance <= high
        wide = high - low > 1e-9 * high
        assert (found.quality == "bounded") is (found.distance_bounds is not None) is wide


def test_bounds_are_narrowed_by_comparisons():
    for true in (3e-12, 1e-300, 0.7, 2.0**-1074):
        low, high = narrowed(0.0, 1.0, lambda length, true=true: (true > length) - (true < length))
        assert low <= true <= high
        assert high - low <= 1e-9 * high or math.nextafter(low, 1.0) == high
    assert narrowed(0.0, 1.0, lambda _: None) == (0.0, 1.0)
