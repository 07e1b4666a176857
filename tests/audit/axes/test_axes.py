"""The candidate axes of two bodies: their counts, their signs, where a test stops, the winner."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from docs import axes as growth_page
from satcheck import core
from satcheck.audit import Settings, check
from satcheck.audit.axes import MOST_EDGE_PAIRS, axes_of
from satcheck.core.errors import SatcheckError
from satcheck.report.axes import AxesReport
from satcheck.scene import Scene, load_scene
from tests.audit.shapes import (
    Mesh,
    bracket,
    moved,
    open_box,
    placed_scene,
    pose,
    scene_of,
    unit_box,
    write,
)
from tests.oracles.random_shapes import (
    Points,
    box_corners,
    random_hull,
    random_quaternion,
    rotation_matrix,
)

# Both figures are those of float64 computations on bodies of size 1.
SAME = 1e-12


def hull_of(points: Points) -> Mesh:
    no_triangles = np.zeros((1, 3), dtype=np.uint32)
    hull = core.Mesh(np.ascontiguousarray(points), no_triangles).convex_hull()
    return (
        [(x, y, z) for x, y, z in np.asarray(hull.vertices).tolist()],
        [tuple(row) for row in np.asarray(hull.triangles).tolist()],
    )


def turned_boxes(rng: np.random.Generator, apart: float) -> tuple[Mesh, Mesh]:
    a, b = (
        box_corners(tuple(rng.uniform(0.3, 1, 3))) @ rotation_matrix(random_quaternion(rng)).T
        for _ in range(2)
    )
    return hull_of(a), hull_of(b + rng.normal(size=3) * apart)


def listed_signs(report: AxesReport) -> set[str]:
    return {axis.state for axis in report.axes}


@pytest.mark.parametrize("seed", range(8))
def test_two_boxes_have_fifteen_axes(tmp_path: Path, seed: int) -> None:
    a, b = turned_boxes(np.random.default_rng(seed), 0.6)
    report = axes_of(scene_of(tmp_path, a=a, b=b))
    counts = report.counts
    assert (counts.candidates, counts.edge_pairs) == (6 + 6 + 12 * 12, 12 * 12)
    assert counts.directions == (3, 3, 9)
    assert counts.distinct == len(report.axes) == 15
    assert sorted(axis.number for axis in report.axes) == list(range(1, 16))
    kinds = [axis.kind for axis in sorted(report.axes, key=lambda axis: axis.number)]
    assert kinds == ["face-a"] * 3 + ["face-b"] * 3 + ["edge-edge"] * 9
    # Opposite faces, and two pairs of edges that make opposite faces of the difference.
    assert [axis.candidates for axis in report.axes] == [2] * 15
    assert counts.facet_pairs == 18


def test_boxes_that_are_turned_alike_have_three(tmp_path: Path) -> None:
    report = axes_of(scene_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25, 0.125)))
    assert report.counts.directions == (3, 3, 9)
    assert [axis.direction for axis in report.axes] == [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    assert [axis.gap for axis in report.axes] == [-0.5, -0.75, -0.875]
    assert sum(axis.candidates for axis in report.axes) == 12 + report.counts.facet_pairs


def test_boxes_of_float32_have_fifteen_too(tmp_path: Path) -> None:
    """A turned box loses its flat faces when its corners are rounded; the file says how finely."""
    import struct

    rng = np.random.default_rng(4)
    paths = []
    for name, (points, faces) in zip("ab", turned_boxes(rng, 0.6), strict=True):
        corners = np.float32(points)[np.array(faces)]
        triangles = b"".join(struct.pack("<12fH", 0, 0, 0, *t.ravel(), 0) for t in corners)
        paths.append(tmp_path / f"{name}.stl")
        paths[-1].write_bytes(bytes(80) + struct.pack("<I", len(corners)) + triangles)
    report = axes_of(load_scene(paths))
    assert (report.a.faces, report.a.edges) == (6, 12)
    assert report.counts.directions == (3, 3, 9)
    assert len(report.axes) == 15


@pytest.mark.parametrize("offset", [(1.0, 0.25, 0.5), (1.0, 1.0, 0.5), (1.0, 1.0, 1.0)])
def test_touching_boxes_have_a_gap_of_exactly_zero(
    tmp_path: Path, offset: tuple[float, float, float]
) -> None:
    report = axes_of(scene_of(tmp_path, a=unit_box(0.1), b=unit_box(0.1 + offset[0], *offset[1:])))
    best = report.axes[0]
    assert (best.state, best.gap, best.gap_bounds) == ("touch", 0.0, (0.0, 0.0))
    assert report.relation == "touching"
    assert report.winner is not None
    assert (report.winner.kind, report.winner.length) == ("touching", 0.0)
    assert report.early_out.axis is None


@pytest.mark.parametrize(("ulps", "state"), [(-1, "overlap"), (1, "gap")])
def test_a_single_unit_in_the_last_place_is_seen(tmp_path: Path, ulps: int, state: str) -> None:
    """Along a direction that float64 cannot hold: the normal of a slanted face."""
    corner = np.nextafter(1.0, 1.0 + ulps)
    wedge: Mesh = (
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
        [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)],
    )
    above: Mesh = (
        [(0, 0, corner), (2, 2, 2), (1, 2, 2), (2, 1, 2)],
        [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)],
    )
    report = axes_of(scene_of(tmp_path, a=wedge, b=above))
    slanted = next(axis for axis in report.axes if min(axis.direction) > 0.5)
    assert slanted.state == state
    assert 0 < abs(slanted.gap) < 1e-15
    assert report.relation == {"gap": "separated", "overlap": "penetrating"}[state]


@pytest.mark.parametrize("seed", range(40))
def test_the_winner_is_what_a_check_says(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    meshes = []
    for _ in range(2):
        points = random_hull(rng, int(rng.integers(4, 24)))
        if rng.random() < 0.4:
            points = box_corners(tuple(rng.uniform(0.2, 1, 3)))
        points = points @ rotation_matrix(random_quaternion(rng)).T
        meshes.append(hull_of(points + rng.normal(size=3) * 0.45))
    scene = scene_of(tmp_path, a=meshes[0], b=meshes[1])
    report = axes_of(scene)
    finding = check(scene, Settings(depth=True, clearance=100.0, tolerance=0.0)).findings[0]
    assert report.of == "bodies"
    winner = report.winner
    assert winner is not None
    assert report.axes[0].number == winner.axis
    if winner.kind == "mtv":
        assert finding.exact_relation in ("penetrating", "contains", "inside")
        assert finding.depth == pytest.approx(winner.length, abs=SAME)
        assert winner.mtv == pytest.approx(finding.mtv, abs=1e-9)
        assert listed_signs(report) == {"overlap"}
    else:
        assert finding.exact_relation == "separated"
        assert finding.distance is not None
        assert 0 < winner.length <= finding.distance + SAME
        first = min(axis.number for axis in report.axes if axis.state == "gap")
        assert report.early_out.axis == report.early_out.tested == first
        assert report.early_out.not_needed == len(report.axes) - first


def test_an_early_out_is_the_first_gap_in_the_order_of_testing(tmp_path: Path) -> None:
    report = axes_of(scene_of(tmp_path, a=unit_box(), b=unit_box(0.25, 3.0)))
    assert [axis.number for axis in report.axes if axis.state == "gap"] == [report.early_out.axis]
    assert report.early_out.tested + report.early_out.not_needed == 3


def test_between_corners_the_distance_exceeds_every_gap(tmp_path: Path) -> None:
    report = axes_of(scene_of(tmp_path, a=unit_box(), b=unit_box(2.0, 2.0, 2.0)))
    assert report.winner is not None
    assert report.winner.length == 1.0
    assert report.distance == pytest.approx(3**0.5)


def test_a_concave_body_gives_its_hull(tmp_path: Path) -> None:
    report = axes_of(scene_of(tmp_path, a=bracket(), b=unit_box(3.0, 3.0, 1.0)))
    assert (report.of, report.a.convex, report.b.convex) == ("hulls", False, True)
    assert report.relation == "penetrating"  # in the notch: the meshes are apart


def test_an_open_box_gives_its_hull(tmp_path: Path) -> None:
    report = axes_of(scene_of(tmp_path, a=open_box(), b=unit_box(9.0)))
    assert report.of == "hulls"
    assert report.relation == "separated"


def test_placed_bodies_are_taken_as_they_stand(tmp_path: Path) -> None:
    write(tmp_path, a=unit_box(), b=unit_box())
    bodies = [("a", "a.obj", pose()), ("b", "b.obj", pose(1.6, 0.2, 0.1, turn=30))]
    report = axes_of(placed_scene(tmp_path, bodies))
    assert report.counts.directions == (3, 3, 9)
    assert len(report.axes) == 5  # x and y of each, and z, which they share
    assert report.relation == "separated"


def test_a_pair_of_a_scene_is_named(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.5), c=unit_box(5.0))
    assert axes_of(scene, ("a", "c")).relation == "separated"
    assert axes_of(scene, ("b", "a")).b.id == "a"
    for ids, code in (
        (None, "not-a-pair"),
        (("a", "a"), "not-a-pair"),
        (("a", "x"), "no-such-body"),
    ):
        with pytest.raises(SatcheckError) as raised:
            axes_of(scene, ids)
        assert raised.value.code == code


def test_the_page_says_how_the_axes_grow() -> None:
    page = (growth_page.HERE / "laboratory.md").read_text(encoding="utf-8")
    assert growth_page.growth() in page


FLAT: Mesh = ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])


def test_flat_bodies_have_axes_unless_they_lie_in_one_plane(tmp_path: Path) -> None:
    report = axes_of(scene_of(tmp_path, a=FLAT, b=unit_box(0.25, 0.25, -0.25)))
    assert report.winner is not None
    assert report.winner.length == 0.25
    assert axes_of(scene_of(tmp_path, a=FLAT, b=moved(FLAT, 9, 0, 1))).relation == "separated"
    with pytest.raises(SatcheckError, match="--planar"):
        axes_of(scene_of(tmp_path, a=FLAT, b=moved(FLAT, 9, 0, 0)))


def test_hulls_with_too_many_edges_are_refused_with_their_count(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(1100, 3))
    round_body = hull_of(points / np.linalg.norm(points, axis=1)[:, None])
    edges = 3 * len(round_body[0]) - 6  # of triangles, by Euler
    assert edges**2 > MOST_EDGE_PAIRS
    with pytest.raises(SatcheckError, match=f"{edges**2:,} pairs of edges") as raised:
        axes_of(scene_of(tmp_path, a=round_body, b=moved(round_body, 1.5, 0, 0)))
    assert raised.value.code == "too-many-axes"


def shapes_scene(folder: Path, *shapes: str) -> Scene:
    path = folder / "scene.toml"
    bodies = [
        f'[[bodies]]\nid = "{name}"\nshape = {shape}'
        for name, shape in zip("ab", shapes, strict=True)
    ]
    path.write_text("\n".join(['schema = "satcheck.scene/1"', *bodies]), encoding="utf-8")
    return load_scene([path])


BALL = '{type = "sphere", radius = 1}\nposition = [2, 0, 0]'


def test_a_curved_shape_has_no_faces(tmp_path: Path) -> None:
    scene = shapes_scene(tmp_path, '{type = "box", size = [1, 1, 1]}', BALL)
    with pytest.raises(SatcheckError, match="body 'b': a curved shape") as raised:
        axes_of(scene)
    assert raised.value.code == "curved-shape"


def test_in_a_plane_the_edges_of_outlines_are_the_axes(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.75, 0.5, 7.0))
    report = axes_of(scene, planar="xy")
    assert report.relation == "penetrating"
    assert report.counts.candidates == 8
    assert [axis.direction for axis in report.axes] == [(1, 0, 0), (0, 1, 0)]
    assert [axis.kind for axis in report.axes] == ["edge-a", "edge-a"]
    assert report.winner is not None
    assert report.winner.mtv == pytest.approx((-0.25, 0, 0))
    assert axes_of(scene, planar="yz").relation == "separated"
    assert axes_of(scene, planar="yz").axes[0].direction == (0, 0, 1)


def test_a_concave_outline_gives_its_hull(tmp_path: Path) -> None:
    report = axes_of(scene_of(tmp_path, a=bracket(), b=unit_box(3.0, 3.0)), planar="xy")
    assert (report.of, report.a.convex) == ("hulls", False)
    assert report.a.edges == 5


def test_a_sign_that_hangs_on_a_curve_is_not_known(tmp_path: Path) -> None:
    """The polygon of a disc lies within it: near a touch, it does not say how the disc lies."""
    square = '{type = "box", size = [2, 2, 2]}'
    touching = axes_of(shapes_scene(tmp_path, square, BALL), planar="xy")
    assert touching.axes[0].state == "unknown"
    assert touching.relation == "indeterminate"
    assert touching.winner is None
    deep = axes_of(shapes_scene(tmp_path, square, BALL.replace("2, 0", "1.5, 0")), planar="xy")
    assert deep.relation == "penetrating"
    assert listed_signs(deep) == {"overlap"}
    low, high = deep.axes[0].gap_bounds
    assert low < -0.5 < high
