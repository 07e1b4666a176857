"""Impacts without a general position: points, edges and faces that meet exactly.

The situations are those that Kenny Erleben, "Methodology for Assessing Mesh-Based Contact Point
Methods" (2018), describes, and that Bolun Wang, Zachary Ferguson, Teseo Schneider, Xin Jiang, Marco
Attene, Daniele Panozzo, "A Large-Scale Benchmark and an Inclusion-Based Algorithm for Continuous
Collision Detection" (2021), use for queries by hand: spikes, wedges, cracks, cliffs, internal
edges. The true times are closed forms; no answer may lie after them.
"""

from __future__ import annotations

import itertools

import pytest

from satcheck.scene.motion import Rotation, Translation
from tests.audit.motion.pairs import first_impact, hull_of, moving
from tests.audit.shapes import box

DOWN = Translation((0.0, 0.0, -4.0))
BAND = 1e-6


def spike(tip: float, base: float):
    """A pyramid with its tip on the z axis."""
    ends = [(x, y, base) for x in (-1.0, 1.0) for y in (-1.0, 1.0)]
    return hull_of([(0.0, 0.0, tip), *ends])


def wedge(edge: float, base: float, *, along_x: bool):
    """A roof with its edge across the z axis."""
    ends = [(s, 0.0, edge) if along_x else (0.0, s, edge) for s in (-1.0, 1.0)]
    return hull_of([*ends, *((x, y, base) for x in (-1.0, 1.0) for y in (-1.0, 1.0))])


def grid(cells: int):
    """A plate below z = 0, its top divided into cells: edges inside a face."""
    steps = [-4.0 + 8.0 * k / cells for k in range(cells + 1)]
    top = [(x, y, 0.0) for x in steps for y in steps]
    at = lambda i, j: i * (cells + 1) + j  # noqa: E731
    rim = [at(i, 0) for i in range(cells + 1)] + [at(cells, j) for j in range(1, cells + 1)]
    rim += [at(i, cells) for i in range(cells - 1, -1, -1)] + [
        at(0, j) for j in range(cells - 1, 0, -1)
    ]
    low = {k: len(top) + n for n, k in enumerate(rim)}
    points = top + [(top[k][0], top[k][1], -1.0) for k in rim]
    cell = [
        (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
        for i, j in itertools.product(range(cells), repeat=2)
    ]
    walls = [(k, low[k], low[n], n) for k, n in zip(rim, [*rim[1:], rim[0]], strict=True)]
    return points, [*cell, *walls, tuple(low[k] for k in reversed(rim))]


ABOVE = {
    "a spike": spike(1.0, 3.0),
    "a wedge along x": wedge(1.0, 3.0, along_x=True),
    "a wedge along y": wedge(1.0, 3.0, along_x=False),
    "a box": box((-1, -1, 1), (1, 1, 3)),
}
BELOW = {
    "a spike": spike(0.0, -2.0),
    "a wedge along x": wedge(0.0, -2.0, along_x=True),
    "a wedge along y": wedge(0.0, -2.0, along_x=False),
    "a box": box((-1, -1, -2), (1, 1, 0)),
    "a plate with edges inside its face": grid(4),
    "a plate with an edge under the tip": grid(2),
}


@pytest.mark.parametrize("below", BELOW)
@pytest.mark.parametrize("above", ABOVE)
def test_falling_onto_each_other(above, below):
    """They meet on the z axis after a quarter of the fall, tip to tip, tip to edge, edge to edge
    that cross or agree, or flat. The overlap exceeds the band when they have moved by more than it,
    and at the latest when their shadows have: a spike of this slope gives way sideways."""
    impact = first_impact(moving(ABOVE[above], DOWN, BELOW[below], tolerance=BAND))
    assert impact.upper is not None
    assert impact.lower <= 0.25 + BAND
    assert impact.upper >= 0.25
    assert impact.upper <= 0.25 + 4 * BAND


@pytest.mark.parametrize("below", ["a spike", "a wedge along x", "a wedge along y"])
@pytest.mark.parametrize("above", ["a spike", "a wedge along x", "a wedge along y"])
@pytest.mark.parametrize("way", [(1.0, 3.0, 0.0), (3.0, -1.0, 0.0)])
@pytest.mark.parametrize("gap", [-(2.0**-44), 0.0, 2.0**-44])
def test_tips_and_edges_that_pass_each_other(above, below, way, gap):
    """They touch for a moment, or are apart or overlap by less than the rounding of a pose. No face
    has a normal that frees them."""
    points, faces = ABOVE[above]
    start = [(x - way[0] / 2, y - way[1] / 2, z - 1.0 + gap) for x, y, z in points]
    impact = first_impact(moving((start, faces), Translation(way), BELOW[below], tolerance=0.0))
    assert impact.free
    assert impact.contact is not None


@pytest.mark.parametrize("below", BELOW)
@pytest.mark.parametrize("above", ABOVE)
@pytest.mark.parametrize("gap", [0.0, 2.0**-44])
def test_a_fall_that_ends_in_touch(above, below, gap):
    fall = Translation((0.0, 0.0, gap - 1.0))
    impact = first_impact(moving(ABOVE[above], fall, BELOW[below], tolerance=0.0))
    assert impact.free
    assert impact.contact == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("a", "b", "way", "touch"),
    [
        # Edge to edge.
        (((0, 2, 3), (1, 0, 1), (0, 1, 2)), ((3, 0, 2), (1, 3, 1), (3, 0, 0)), (2, 1, 1), 3 / 4),
        # Corner to corner, at the start.
        (((2, 0, 1), (1, 3, 1), (1, 3, 3)), ((3, 0, 0), (2, 0, 1), (2, 0, 0)), (1, 2, -3), 0),
        # Parallel, one through the other.
        (((2, 2, 2), (2, 0, 1), (2, 3, 2)), ((3, 0, 3), (3, 0, 1), (3, 3, 3)), (3, 0, 2), 1 / 3),
        (((1, 1, 3), (1, 1, 1), (1, 0, 3)), ((2, 2, 1), (2, 1, 3), (2, 0, 2)), (3, 1, -1), 1 / 3),
    ],
)
def test_triangles_that_touch_for_a_moment(a, b, way, touch):
    """Found among random ones of small integers (bench/impacts.py)."""
    sheets = [([tuple(map(float, p)) for p in corners], [(0, 1, 2)]) for corners in (a, b)]
    path = Translation(tuple(map(float, way)))
    pair = moving(sheets[0], path, sheets[1], tolerance=0.0, allow_open=True)
    impact = first_impact(pair)
    assert impact.free
    assert impact.contact == pytest.approx(touch)


@pytest.mark.parametrize("above", ABOVE)
@pytest.mark.parametrize("gap", [0.0, 1e-9])
def test_passing_at_a_cliff(above, gap):
    """Down along the face of a cliff: in touch, or with a gap between body and wall."""
    wall = box((1 + gap, -9, -9), (3, 9, 0))
    impact = first_impact(moving(ABOVE[above], DOWN, wall, tolerance=BAND))
    assert impact.free
    assert (impact.contact is None) == (gap > 0)


@pytest.mark.parametrize("cells", [2, 4])
def test_sliding_over_edges_inside_a_face(cells):
    """No edge between coplanar triangles stops a box that slides over them, nor one that turns."""
    slider = box((-1, -1, 0), (1, 1, 1))
    for path in (
        Translation((2.5, 1.25, 0.0)),
        Translation((2.5, 0.0, 0.0)),
        Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0),
    ):
        impact = first_impact(moving(slider, path, grid(cells), tolerance=BAND))
        assert impact.free
        assert impact.contact == 0.0


def test_a_spike_into_a_crack():
    """Two blocks with a crack of 1e-3 between them: the tip enters it and is stopped where the
    spike, of slope 1/2, is as wide as the crack."""
    crack = 1e-3
    for side in (-1.0, 1.0):
        low, high = sorted((side * crack / 2, side * 5.0))
        block = box((low, -5, -3), (high, 5, 0))
        impact = first_impact(moving(spike(1.0, 3.0), DOWN, block, tolerance=BAND))
        reached = (1.0 + crack) / 4
        assert impact.lower <= reached + BAND
        assert reached <= impact.upper <= reached + 4 * BAND
