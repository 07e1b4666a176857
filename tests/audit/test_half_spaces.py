"""Half spaces against bodies of all kinds, by an independent truth in rational numbers."""

from __future__ import annotations

import json
import math
import random
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from satcheck.audit import Finding, Report, Settings, check
from satcheck.audit.samples import check_poses
from satcheck.core.shapes import HalfSpace
from satcheck.scene import Scene, load_scene
from satcheck.scene.bodies import is_half_space
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.new_scene_file import new_scene_file
from tests.audit.resolve.boxes import resolve
from tests.cli.process import satcheck
from tests.oracles.half_space import Matrix, heights_of_shape, heights_of_vertices
from tests.plugin_marks import needs
from tests.verify.reports import verified

Vertices = list[list[float]]
QUARTER_TURNS = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    [[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]],
]
KINDS = ("box", "hull", "channel", "sphere", "capsule", "cylinder", "cone", "ellipsoid")
# Coordinates here are below 64. A rounded corner of a block, a rounded vertex, and a figure of a
# size that was computed in float64 are off by some roundoffs of that.
ROUNDING = 64 * 2.0**-53 * 8


def turn(rng: random.Random) -> list[list[float]]:
    x, y, z, w = (rng.gauss(0, 1) for _ in range(4))
    s = 2 / (x * x + y * y + z * z + w * w)
    return [
        [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
    ]


def placed(rotation: list[list[float]], at: Sequence[float]) -> list[list[float]]:
    rows = [[*row, c] for row, c in zip(rotation, at, strict=True)]
    return [*rows, [0.0, 0.0, 0.0, 1.0]]


def size(rng: random.Random) -> float:
    return rng.choice([0.25, 0.5, 1.0, 2.0, rng.uniform(0.2, 2.0)])


def channel(rng: random.Random) -> tuple[Vertices, list[list[int]]]:
    """A table: a plate with two legs along y. It is not convex."""
    h, w, t = size(rng), size(rng) + 1, 0.25
    profile = [(-w, -h), (t - w, -h), (t - w, 0.0), (w - t, 0.0)]
    profile += [(w - t, -h), (w, -h), (w, t), (-w, t)]
    n = len(profile)
    vertices = [[x, y, z] for y in (-0.5, 0.5) for x, z in profile]
    ends = [[0, 1, 2], [0, 2, 7], [2, 3, 6], [2, 6, 7], [3, 4, 5], [3, 5, 6]]
    faces = ends + [[a + n, c + n, b + n] for a, b, c in ends]
    for i in range(n):
        j = (i + 1) % n
        faces += [[i, i + n, j + n], [i, j + n, j]]
    return vertices, faces


def hull(rng: random.Random) -> tuple[Vertices, list[list[int]]]:
    """A tetrahedron."""
    while True:
        points = [[rng.uniform(-1, 1) for _ in range(3)] for _ in range(4)]
        a, b, c = ([p - q for p, q in zip(point, points[0], strict=True)] for point in points[1:])
        volume = (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
        )
        if abs(volume) > 0.1:
            faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
            return points, faces if volume > 0 else [face[::-1] for face in faces]


def shape(kind: str, rng: random.Random) -> dict[str, Any]:
    match kind:
        case "box":
            return {"type": kind, "size": [size(rng) for _ in range(3)]}
        case "sphere":
            return {"type": kind, "radius": size(rng)}
        case "capsule":
            return {"type": kind, "radius": size(rng), "length": size(rng)}
        case "ellipsoid":
            return {"type": kind, "radii": [size(rng) for _ in range(3)]}
    return {"type": kind, "radius": size(rng), "height": size(rng)}


class Case:
    """A body over a half space. aim: the height that it is lifted to; rounding moves it."""

    def __init__(self, folder: Path, rng: random.Random, kind: str, plane: str, aim: float) -> None:
        self.plane: Matrix = placed(
            turn(rng) if plane == "tilted" else rng.choice(QUARTER_TURNS),
            [rng.choice([0.0, 0.25, -1.5, rng.uniform(-2, 2)]) for _ in range(3)],
        )
        self.kind, self.folder = kind, folder
        own = QUARTER_TURNS[0] if rng.random() < 0.5 else turn(rng)
        self.vertices: Vertices = []
        self.faces: list[list[int]] = []
        if kind == "channel":
            self.vertices, self.faces = channel(rng)
        elif kind == "hull":
            self.vertices, self.faces = hull(rng)
        else:
            self.shape = shape(kind, rng)
            if kind == "box":
                half = [c / 2 for c in self.shape["size"]]
                self.vertices = [
                    [i * half[0], j * half[1], k * half[2]]
                    for i in (-1, 1)
                    for j in (-1, 1)
                    for k in (-1, 1)
                ]
        self.matrix: Matrix = placed(own, [0.0, 0.0, 0.0])
        lift = aim - float(self.heights()[0])
        aside = [rng.uniform(-3, 3), rng.uniform(-3, 3), lift]
        at = [sum(row[k] * aside[k] for k in range(3)) for row in self.plane[:3]]
        self.matrix = placed(own, at)

    def heights(self) -> tuple[Fraction, Fraction]:
        if self.vertices:
            return heights_of_vertices(self.plane, self.matrix, self.vertices)
        return heights_of_shape(self.plane, self.matrix, self.shape)

    def scene(self) -> Scene:
        body: dict[str, Any] = {"id": "body", "matrix": self.matrix}
        if self.faces:
            lines = [f"OFF\n{len(self.vertices)} {len(self.faces)} 0"]
            lines += [" ".join(map(repr, vertex)) for vertex in self.vertices]
            lines += [f"3 {a} {b} {c}" for a, b, c in self.faces]
            (self.folder / "body.off").write_text("\n".join(lines) + "\n")
            body["mesh"] = "body.off"
        else:
            body["shape"] = self.shape
        floor = {"id": "floor", "shape": {"type": "half-space"}, "matrix": self.plane}
        return written(self.folder, [floor, body])


def written(folder: Path, bodies: list[dict[str, Any]], **more: Any) -> Scene:
    path = folder / "scene.json"
    path.write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": bodies, **more}))
    return load_scene([path])


def examined(scene: Scene, **settings: Any) -> Finding:
    (finding,) = check(scene, Settings(depth=True, clearance=16.0, **settings)).findings
    return finding


def judge(case: Case, finding: Finding) -> None:
    """Compares a finding with the truth."""
    least, greatest = case.heights()
    assert finding.tolerance is not None
    sure = Fraction(finding.tolerance + ROUNDING)
    if abs(least) <= sure:
        if abs(abs(least) - Fraction(finding.tolerance)) > ROUNDING:
            assert finding.relation == "touching"
        return
    if least > 0:
        assert (finding.relation, finding.exact_relation) == ("near", "separated")
        assert finding.distance is not None
        assert finding.distance == pytest.approx(float(least), rel=1e-15, abs=1e-300)
    else:
        buried = greatest < 0
        assert finding.exact_relation == ("contains" if buried else "penetrating")
        assert finding.relation == finding.exact_relation
        assert finding.depth_bounds is not None
        low, high = map(Fraction, finding.depth_bounds)
        assert low <= -least <= high
        assert high - low <= 2 * ROUNDING
        assert finding.mtv_verified
        assert finding.mtv is not None
        assert math.hypot(*finding.mtv) == pytest.approx(float(-least), rel=1e-9)
        if high - low > 1e-9 * high:  # the corners of the block are rounded
            assert finding.quality == "bounded"
            return
    assert finding.quality == "exact"


@pytest.mark.parametrize("plane", ["axis", "tilted"])
@pytest.mark.parametrize("kind", KINDS)
def test_pairs_have_the_true_figures(tmp_path: Path, kind: str, plane: str) -> None:
    """Sixteen times thirteen pairs: 208."""
    rng = random.Random(f"{kind} {plane}")
    aims = [0.0, 0.0, 1e-9, -1e-9, 1e-6, -1e-6]
    aims += [rng.uniform(0.01, 3) for _ in range(2)] + [rng.uniform(-0.3, -0.01) for _ in range(3)]
    aims += [rng.uniform(-12, -6) for _ in range(2)]
    for aim in aims:
        case = Case(tmp_path, rng, kind, plane, aim)
        judge(case, examined(case.scene()))


def test_an_upright_plane_decides_the_last_bit(tmp_path: Path) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    for at, relation in (
        (0.5, "touching"),
        (math.nextafter(0.5, 1), "separated"),
        (math.nextafter(0.5, 0), "penetrating"),
    ):
        for form in ({"type": "box", "size": [1, 1, 1]}, {"type": "sphere", "radius": 0.5}):
            body = {"id": "body", "shape": form, "position": [0.25, 7, at]}
            finding = examined(written(tmp_path, [floor, body]))
            assert (finding.relation, finding.exact_relation) == ("touching", relation)


@pytest.mark.parametrize("plane", ["axis", "tilted"])
@pytest.mark.parametrize(("sunk", "thickness"), [(0.25, 0.25), (9.0, 1.0)])
def test_the_thickness_is_that_of_the_part_below(
    tmp_path: Path, plane: str, sunk: float, thickness: float
) -> None:
    """Of a cube of size 1 that stands upright on the plane."""
    rng = random.Random(1)
    rows = QUARTER_TURNS[2] if plane == "axis" else turn(rng)
    at = [(0.5 - sunk) * row[2] for row in rows]
    floor = {"id": "floor", "shape": {"type": "half-space"}, "matrix": placed(rows, [0, 0, 0])}
    cube = {"type": "box", "size": [1, 1, 1]}
    body = {"id": "body", "shape": cube, "matrix": placed(rows, at)}
    finding = examined(written(tmp_path, [floor, body]), thickness=True)
    assert finding.thickness_bounds is not None
    low, high = finding.thickness_bounds
    assert low - ROUNDING <= thickness <= high + ROUNDING
    assert high - low <= 1e-2 * thickness


def test_certificates_are_made_and_accepted(tmp_path: Path) -> None:
    rng = random.Random(2)
    for kind in ("box", "channel", "sphere"):
        for aim in (0.0, 0.5, -0.25):
            scene = Case(tmp_path, rng, kind, "axis", aim).scene()
            report = check(scene, Settings(depth=True, certificate=True))
            found = verified(json.loads(json.dumps(report.to_dict())))
            assert [one.outcome for one in found.findings] == ["accepted"], (kind, aim)


@pytest.mark.parametrize("kind", ["sphere", "capsule", "cylinder", "cone", "ellipsoid"])
def test_a_depth_next_to_the_tolerance_is_decided(tmp_path: Path, kind: str) -> None:
    """Within the rounding of the corners of a turned block, too."""
    rng = random.Random(f"next to the tolerance {kind}")
    for beyond in (0.0, 1e-12, -1e-12, 1e-14, -1e-14, 3e-16, -3e-16, 1e-16, -1e-16):
        case = Case(tmp_path, rng, kind, "tilted", -0.25 - beyond)
        (finding,) = check(case.scene(), Settings(tolerance=0.25)).findings
        deeper = -case.heights()[0] > Fraction(0.25)
        assert finding.relation == ("penetrating" if deeper else "touching")
        assert finding.undecided is None


def test_a_block_that_is_too_small_proves_nothing(tmp_path: Path) -> None:
    """A body beside a small block would be apart from it, though it lies below the plane."""
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    body = {"id": "body", "shape": {"type": "box", "size": [1, 1, 1]}, "position": [40, 0, -5]}
    scene = written(tmp_path, [floor, body])
    report = check(scene, Settings(depth=True, certificate=True)).to_dict()
    assert report["findings"][0]["relation"] == "contains"
    document = json.loads(json.dumps(report))
    assert verified(document).accepted
    apart = {**document["findings"][0], "relation": "separated", "exact_relation": "separated"}
    apart |= {"depth": None, "depth_bounds": None, "mtv": None, "normal": None, "witness": None}
    document["bodies"][0]["shape"]["reach"] = 1.0
    document["findings"] = [apart]
    assert not verified(document).accepted


def test_bodies_that_are_moved_are_within_reach(tmp_path: Path) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    body = {"id": "body", "shape": {"type": "sphere", "radius": 0.5}, "position": [0, 0, 1]}
    scene = written(tmp_path, [floor, body])
    rows = (1.0, 0.0, 0.0, 1e6, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -7.0, 0.0, 0.0, 0.0, 1.0)
    floor_body, ball = scene.bodies
    moved = replace(scene, bodies=(floor_body, replace(ball, transform=rows)))
    assert examined(moved).relation == "contains"
    assert examined(moved).depth == 7.5


def in_mujoco(folder: Path, *bodies: str) -> Scene:
    path = folder / "m.xml"
    plane = '<geom name="floor" type="plane" size="1 1 1"/>'
    path.write_text(f"<mujoco><worldbody>{plane}{''.join(bodies)}</worldbody></mujoco>")
    return load_scene([path])


ARM = (
    '<body name="arm" pos="0 0 3"><joint name="turn" type="hinge" axis="0 1 0"/>'
    '<geom name="arm" type="box" size="4 .25 .25" pos="3 0 0"/></body>'
)
SLIDE = (
    '<body name="lift" pos="9 9 0"><joint name="drop" type="slide" axis="0 0 1"/>'
    '<geom name="lift" type="box" size=".5 .5 .5"/></body>'
)


def relations(report: Report) -> dict[tuple[str, str], str]:
    return {(one.a, one.b): one.relation for one in report.findings}


@needs("mjcf")
def test_samples_see_the_floor(tmp_path: Path) -> None:
    """Far away, too: the slide has no limits."""
    scene = in_mujoco(tmp_path, ARM, SLIDE)
    poses = [
        {"turn": (0.0,), "drop": (0.5,)},
        {"turn": (math.pi / 2,), "drop": (0.75,)},
        {"turn": (0.0,), "drop": (-3e6,)},
        {"turn": (0.0,), "drop": (0.25,)},
        {"turn": (0.0,), "drop": (3e6,)},
    ]
    found = check_poses(scene, poses, Settings(depth=False))
    met = [
        {(one.b, one.relation) for one in sample.findings if one.a == "world"}
        for sample in found.samples
    ]
    assert met == [
        {("lift", "touching")},
        {("arm", "penetrating")},
        {("lift", "contains")},
        {("lift", "penetrating")},
        set(),
    ]
    assert [sample.verdict for sample in found.samples] == ["pass", "fail", "fail", "fail", "pass"]


@needs("mjcf")
def test_a_path_of_joints_hits_the_floor(tmp_path: Path) -> None:
    from satcheck.scene.robot.joint_path import with_joint_path

    scene = in_mujoco(tmp_path, ARM, SLIDE)
    down = with_joint_path(scene, [{"drop": (1000.0,)}, {"drop": (0.0,)}])
    by_pair = {(one.a, one.b): one for one in check(down, Settings(depth=False)).findings}
    hit = by_pair["world", "lift"].motion
    assert hit is not None
    assert hit.relation == "penetrating"
    assert hit.time_of_impact is not None
    assert hit.tolerance is not None
    assert abs(hit.time_of_impact[0] - 0.9995) * 1000 <= 2 * hit.tolerance
    assert hit.time_of_impact[1] >= 0.9995
    free = with_joint_path(scene, [{"drop": (1000.0,)}, {"drop": (0.75,)}])
    by_pair = {(one.a, one.b): one for one in check(free, Settings(depth=False)).findings}
    assert by_pair["world", "lift"].relation == "separated"


CART = (
    '<body name="cart" pos="0 0 0"><joint name="along" type="slide" axis="1 0 0"/>'
    '<joint name="drop" type="slide" axis="0 0 1"/><joint name="spin" axis="0 0 1"/>'
    '<geom name="cart" type="box" size=".5 .5 .5"/></body>'
)


@needs("mjcf")
@pytest.mark.parametrize(
    ("height", "relation", "way"),
    [(0.501, "separated", 1e6), (0.5001, "separated", 1e6), (0.5, "touching", 1000.0)],
)
def test_a_way_along_a_floor_takes_few_steps(
    tmp_path: Path, height: float, relation: str, way: float
) -> None:
    """Only the height counts, not the way."""
    from satcheck.scene.robot.joint_path import with_joint_path

    start = {"along": (0.0,), "drop": (height,), "spin": (0.0,)}
    path = [start, {"along": (way,), "drop": (height,), "spin": (9.0,)}]
    scene = with_joint_path(in_mujoco(tmp_path, CART), path)
    (finding,) = check(scene, Settings(depth=False)).findings
    assert finding.motion is not None
    assert finding.motion.relation == relation
    assert finding.motion.steps is not None
    assert finding.motion.steps < 64


@needs("mjcf")
def test_an_impact_after_a_long_way_is_found(tmp_path: Path) -> None:
    """Its time is as narrow as the rounding of a length of the way."""
    from satcheck.scene.robot.joint_path import with_joint_path

    scene = with_joint_path(in_mujoco(tmp_path, CART), [{"drop": (1e6,)}, {"drop": (0.0,)}])
    (finding,) = check(scene, Settings(depth=False)).findings
    assert finding.motion is not None
    assert finding.motion.time_of_impact is not None
    assert finding.motion.tolerance is not None
    lower, upper = (1e6 * (1 - time) for time in finding.motion.time_of_impact)
    assert upper <= 0.5 <= lower + finding.motion.tolerance
    assert lower - upper <= 16 * finding.motion.tolerance
    assert finding.motion.tolerance <= 1e-5


@needs("mjcf")
def test_a_turn_about_a_tilted_axis_counts_by_what_rises(tmp_path: Path) -> None:
    """Against the heights at many moments: no overlap is missed, and none is found too late."""
    from satcheck.scene.robot.joint_path import with_joint_path

    for seed in range(8):
        rng = random.Random(seed)
        axes = [" ".join(repr(rng.gauss(0, 1)) for _ in range(3)) for _ in range(3)]
        arm = (
            f'<body name="arm" pos="0 0 1.5"><joint name="a" axis="{axes[0]}"/>'
            f'<joint name="b" type="slide" axis="{axes[1]}"/><joint name="c" axis="{axes[2]}"/>'
            '<geom name="arm" type="box" size="1 .25 .25" pos=".75 0 0"/></body>'
        )
        scene = in_mujoco(tmp_path, arm)
        start, end = ({j: (rng.uniform(-2, 2),) for j in "abc"} for _ in range(2))
        (finding,) = check(with_joint_path(scene, [start, end]), Settings(depth=False)).findings
        shares = [k / 256 for k in range(257)]
        poses = [{j: (start[j][0] * (1 - t) + end[j][0] * t,) for j in "abc"} for t in shares]
        found = check_poses(scene, poses, Settings(depth=False)).samples
        hits = [t for t, sample in zip(shares, found, strict=True) if sample.verdict == "fail"]
        hit = finding.motion and finding.motion.time_of_impact
        assert not hits if hit is None else min(hits, default=1.0) >= hit[0]


def test_a_motion_hits_the_floor(tmp_path: Path) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    body = {"id": "body", "shape": {"type": "box", "size": [1, 1, 1]}, "position": [0, 0, 2]}
    motion = {"bodies": ["body"], "translation": [3000.0, 0.0, -3.0]}
    (finding,) = check(written(tmp_path, [floor, body], motion=[motion])).findings
    assert finding.motion is not None
    assert finding.motion.relation == "penetrating"
    assert finding.motion.time_of_impact is not None
    assert finding.motion.contact is not None
    assert finding.motion.contact <= 0.5 <= finding.motion.time_of_impact[1]
    assert finding.motion.time_of_impact[1] - finding.motion.contact < 1e-7


def test_two_half_spaces(tmp_path: Path) -> None:
    """Walls that face each other have a gap; others share a region without end."""
    up = placed(QUARTER_TURNS[0], [0.0, 0.0, 0.0])
    down = placed(QUARTER_TURNS[1], [0.0, 0.0, 2.5])
    wall = placed(QUARTER_TURNS[2], [-9.0, 0.0, 0.0])
    bodies = [
        {"id": name, "shape": {"type": "half-space"}, "matrix": matrix}
        for name, matrix in (("floor", up), ("ceiling", down), ("wall", wall))
    ]
    body = {"id": "body", "shape": {"type": "box", "size": [1, 1, 1]}, "position": [0, 0, 1]}
    unchecked = relations(check(written(tmp_path, [*bodies, body])))
    assert set(unchecked) == {("floor", "body"), ("ceiling", "body"), ("wall", "body")}
    report = check(written(tmp_path, [*bodies, body], check_static=True), Settings(clearance=3.0))
    found = {(one.a, one.b): one for one in report.findings}
    assert found["floor", "ceiling"].distance == 2.5
    for pair in (("floor", "wall"), ("ceiling", "wall")):
        assert found[pair].relation == "indeterminate"
        assert "without end" in (found[pair].reason or "")
    assert report.summary.pairs.indeterminate == 2


def test_in_a_plane_a_wall_is_a_half_plane(tmp_path: Path) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    turned = placed(QUARTER_TURNS[2], [0.0, 0.0, 0.0])
    wall = {"id": "wall", "shape": {"type": "half-space"}, "matrix": turned}
    body = {"id": "body", "shape": {"type": "box", "size": [1, 1, 1]}, "position": [0.25, 0, 1]}
    found = relations(check(written(tmp_path, [floor, wall, body]), Settings(planar="xy")))
    assert found == {("floor", "body"): "indeterminate", ("wall", "body"): "penetrating"}


def test_a_scene_states_no_reach(tmp_path: Path) -> None:
    from satcheck.core.errors import SatcheckError

    floor = {"id": "floor", "shape": {"type": "half-space", "reach": 2.0}}
    with pytest.raises(SatcheckError, match=r"shape\.reach: unknown key"):
        written(tmp_path, [floor])


def test_a_half_space_is_pinned_and_static(tmp_path: Path) -> None:
    (floor,) = written(tmp_path, [{"id": "floor", "shape": {"type": "half-space"}}]).bodies
    assert is_half_space(floor)
    assert isinstance(floor.shape, HalfSpace)
    assert (floor.static, floor.pinned) == (True, True)


SDF = (
    '<?xml version="1.0"?><sdf version="1.9"><world name="w"><model name="ground_plane">'
    '<static>true</static><link name="link"><collision name="c"><geometry><plane>'
    "<normal>0 0 1</normal><size>100 100</size></plane></geometry></collision></link></model>"
    '<model name="crate"><pose>0 0 {height} 0 0 0</pose><link name="l"><collision name="c">'
    "<geometry><box><size>1 1 1</size></box></geometry></collision></link></model></world></sdf>"
)


@needs("sdf")
@pytest.mark.parametrize(
    ("height", "relation", "verdict"),
    [(1.5, "separated", "pass"), (0.5, "touching", "pass"), (0.2, "penetrating", "fail")],
)
def test_a_crate_and_the_ground_plane_of_gazebo(
    tmp_path: Path, height: float, relation: str, verdict: str
) -> None:
    path = tmp_path / "w.sdf"
    path.write_text(SDF.format(height=height))
    report = check(load_scene([path]))
    assert relations(report) == {("ground_plane::link", "crate::l"): relation}
    assert report.summary.verdict == verdict


@needs("sdf")
@pytest.mark.parametrize(("height", "answer"), [(0.5, "yes"), (1.5, "no")])
def test_a_floor_holds_what_rests_on_it(tmp_path: Path, height: float, answer: str) -> None:
    path = tmp_path / "w.sdf"
    path.write_text(SDF.format(height=height))
    rules = tmp_path / "rules.toml"
    rules.write_text('[[rules]]\nbodies = "crate::l"\nsupported = true\nstable = true\n')
    statics = check(load_scene([path], rules=[rules])).to_dict()["statics"]
    assert {one["answer"] for one in statics["findings"]} == {answer}


def test_an_open_mesh_meets_a_floor_whatever_fills_its_hole(tmp_path: Path) -> None:
    """A box without its bottom, as a mesh."""
    lines = ["OFF", "8 5 0"]
    lines += [f"{x} {y} {z}" for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    lines += ["4 4 5 7 6", "4 0 1 5 4", "4 2 6 7 3", "4 0 4 6 2", "4 1 3 7 5"]
    (tmp_path / "lid.off").write_text("\n".join(lines) + "\n")
    for z, relation in ((0, "touching"), (0.5, "near"), (-0.5, "penetrating"), (-3, "contains")):
        floor = {"id": "floor", "shape": {"type": "half-space"}}
        lid = {"id": "lid", "mesh": "lid.off", "position": [0, 0, z]}
        finding = examined(written(tmp_path, [floor, lid]))
        assert (finding.relation, finding.quality) == (relation, "exact")
        assert finding.depth == (-z if z < 0 else None)


def test_resolve_lifts_what_is_sunk_and_a_new_scene_has_no_reach(tmp_path: Path) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    body = {"id": "body", "shape": {"type": "box", "size": [1, 1, 1]}, "position": [0, 0, 0.25]}
    scene = written(tmp_path, [floor, body])
    (move,) = resolve(scene).moves
    assert move.body == "body"
    assert move.translation == pytest.approx((0, 0, 0.25), abs=1e-12)
    stated = json.loads(new_scene_file(tmp_path / "new.json", scene, MeshFiles()))
    assert stated["bodies"][0]["shape"] == {"type": "half-space"}


def slope(angle: float) -> dict[str, Any]:
    c, s = math.cos(angle), math.sin(angle)
    rows = [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
    return {"id": "floor", "shape": {"type": "half-space"}, "matrix": placed(rows, [0, 0, 0])}


def crate(id_: str, *at: float) -> dict[str, Any]:
    return {"id": id_, "shape": {"type": "box", "size": [1, 1, 1]}, "position": at}


@pytest.mark.parametrize(("angle", "rounds"), [(0.0, 0), (0.0, 12), (0.4, 12)])
def test_the_free_places_of_resolve_lie_on_a_floor_and_beside_no_half_space(
    tmp_path: Path, angle: float, rounds: int
) -> None:
    """Without rounds of pushing by free places alone, which a tilted half space has none of."""
    scene = written(tmp_path, [slope(angle), crate("a", 0, 0, -2), crate("b", 0.5, 0, -2)])
    found = resolve(scene, iterations=rounds)
    assert found.summary.verdict == "resolved"
    assert len(found.moves) == 2
    # The way along the normal, and the rest of a crate to get past the other one.
    out = 2 * math.cos(angle) + (math.cos(angle) + math.sin(angle)) / 2
    assert all(out - 1e-9 <= move.length <= out + math.sqrt(3) for move in found.moves)


def test_there_is_no_way_out_of_a_half_space_but_over_its_plane(tmp_path: Path) -> None:
    """A crate between a floor and a ceiling that are too close for it."""
    rows = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]
    ceiling = {
        "id": "ceiling",
        "shape": {"type": "half-space"},
        "matrix": placed(rows, [0, 0, 0.5]),
    }
    found = resolve(written(tmp_path, [slope(0.0), ceiling, crate("a", 1, 2, -3)]))
    assert found.summary.remaining == 1
    assert len(found.left) == 1
    higher = {**ceiling, "matrix": placed(rows, [0, 0, 1.5])}
    (move,) = resolve(written(tmp_path, [slope(0.0), higher, crate("a", 1, 2, -3)])).moves
    assert move.translation == pytest.approx((0, 0, 3.5), abs=1e-12)


FAR = """<?xml version="1.0"?><sdf version="1.9"><world name="w">
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry>
<plane><normal>0 0 1</normal><size>1 1</size></plane></geometry></collision></link></model>
<model name="r"><link name="tip"><pose>0 0 6 0 0 0</pose><collision name="c"><geometry>
<box><size>1 1 1</size></box></geometry></collision></link>
<joint name="k" type="prismatic"><parent>world</parent><child>tip</child><axis><xyz>0 0 1</xyz>
<limit><lower>-{0}</lower><upper>{0}</upper></limit></axis></joint></model></world></sdf>
"""


@needs("sdf")
@pytest.mark.parametrize("limit", ["10", "1e4", "1e8", "1e10"])
def test_a_far_limit_of_a_joint_hides_no_overlap_on_a_path(tmp_path: Path, limit: str) -> None:
    """The tip ends a millimetre deep. The block below it is as large as the limit."""
    (tmp_path / "w.sdf").write_text(FAR.format(limit))
    (tmp_path / "path.json").write_text('[{"r::k": 0}, {"r::k": -5.501}]')
    ran = satcheck("w.sdf", "--path", "path.json", cwd=tmp_path)
    assert ran.code in ((1,) if float(limit) <= 1e4 else (1, 3)), ran.err


@pytest.mark.parametrize("height", [0.4, 0.5, 0.6])
def test_verify_accepts_floors_in_a_plane(tmp_path: Path, height: float) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    box = {"id": "b", "shape": {"type": "box", "size": [1, 1, 1]}, "position": [0, 0, height]}
    written(tmp_path, [floor, box])
    report = tmp_path / "report.json"
    done = satcheck(
        "scene.json", "--planar", "xz", "--certificate", "-o", str(report), cwd=tmp_path
    )
    assert done.code == (1 if height < 0.5 else 0)
    assert satcheck("verify", str(report), cwd=tmp_path).code == 0
