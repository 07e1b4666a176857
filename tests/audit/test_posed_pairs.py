"""Many poses at once give what checks of single poses give, for every kind of body and of rule."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.audit.bodies import PlacedBodies, place
from satcheck.audit.pair import Pair
from satcheck.audit.planner import Planner
from satcheck.audit.posed_pairs import APART, DEEP, OPEN, UNDECIDED, PosedPairs
from satcheck.audit.samples import check_poses
from satcheck.report.report import OVERLAPS, Finding
from satcheck.scene import Scene, load_scene
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.robot import RandomPoses, posed
from satcheck.scene.robot.postures import pose_batches
from tests.scene.robot.robots import SAMPLES, joint, link, robot_of

QUICK = Settings(depth=False)
MESHES = ("l_bracket.obj", "snowflake.obj", "kettle.obj", "ring.glb", "box.obj")
SHAPES = (
    '<sphere radius="0.8"/>',
    '<capsule radius="0.4" length="1.5"/>',
    '<cylinder radius="0.5" length="1.6"/>',
    '<box size="1.5 0.5 0.8"/>',
)


def spider(folder: Path, geometries: list[str], rules: str = "") -> Scene:
    """Bodies on arms that turn about different axes through nearly the same point, so that many
    pairs overlap, some barely, and others do not."""
    elements = [link("hub", "")]
    for k, geometry in enumerate(geometries):
        x, y, z = math.sin(2.4 * k), math.cos(2.4 * k), 0.3 * (k % 3)
        origin = f'<origin xyz="{0.9 + 0.2 * k} 0.1 0" rpy="0.3 {0.5 * k} 0.1"/>'
        elements.append(
            link(f"part{k}", f"<collision>{origin}<geometry>{geometry}</geometry></collision>")
        )
        axis = f'<origin xyz="0 0 {0.4 * k}"/><axis xyz="{x} {y} {z}"/>'
        elements.append(joint(f"j{k}", "hub", f"part{k}", "continuous", axis))
    (folder / "r.urdf").write_text(robot_of(*elements))
    if not rules:
        return load_scene([folder / "r.urdf"])
    wall = '{id = "wall", shape = {type = "box", size = [1, 1, 1]}, position = [1, 1, 0.5]}'
    head = f'schema = "satcheck.scene/1"\nunits = "m"\nbodies = [{wall}]\n'
    (folder / "rules.toml").write_text(head + rules)
    return load_scene([folder / "rules.toml", folder / "r.urdf"])


def meshes(folder: Path, scale: str = "0.5 0.5 0.5") -> list[str]:
    for name in MESHES:
        (folder / name).write_bytes((SAMPLES / name).read_bytes())
    return [f'<mesh filename="{name}" scale="{scale}"/>' for name in MESHES]


def open_cups(folder: Path) -> list[str]:
    """Cubes without the faces at a corner, and small boxes for them."""
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = ("1243", "1562", "1375")  # seen from outside
    text = [*(f"v {x} {y} {z}" for x, y, z in corners), *(f"f {' '.join(f)}" for f in faces)]
    (folder / "cup.obj").write_text("\n".join(text) + "\n")
    return ['<mesh filename="cup.obj"/>'] * 2 + ['<box size="0.2 0.3 0.2"/>'] * 3


def plain(finding: Finding) -> dict[str, Any]:
    """All of a finding but its plan."""
    stated: dict[str, Any] = msgspec.to_builtins(replace(finding, plan=()))
    return stated


def compare(scene: Scene, settings: Settings, count: int, seed: int = 0) -> set[str]:
    """Every finding of every pose equals that of a check of the pose. Returns the relations."""
    poses = RandomPoses([robot.robot for robot in scene.robots], count, seed)
    found = check_poses(scene, poses, settings)
    relations = set()
    for sample, pose in zip(found.samples, poses, strict=True):
        report = check(posed(scene, pose), settings)
        expected = [
            f for f in report.findings if not (f.relation == "separated" and f.severity == "none")
        ]
        assert [plain(f) for f in sample.findings] == [plain(f) for f in expected]
        assert sample.verdict == report.summary.verdict
        relations |= {finding.relation for finding in report.findings}
    return relations


def test_meshes(tmp_path: Path) -> None:
    scene = spider(tmp_path, meshes(tmp_path))
    assert compare(scene, QUICK, 40) >= {"separated", "penetrating"}


def test_mirrored_and_stretched_meshes(tmp_path: Path) -> None:
    scene = spider(tmp_path, meshes(tmp_path, "-0.5 0.7 0.4"))
    assert compare(scene, QUICK, 20) >= {"separated", "penetrating"}


def test_curved_shapes_and_meshes(tmp_path: Path) -> None:
    scene = spider(tmp_path, [*SHAPES, *meshes(tmp_path)[:2]])
    assert compare(scene, QUICK, 15) >= {"separated", "penetrating"}


@pytest.mark.parametrize(
    "rules",
    [
        '[[rules]]\na = "part0"\nb = "part1"\nallowed = true\nreason = "test"\n',
        '[[rules]]\na = "part*"\nb = "part2"\nmax_depth = 0.2\n',
        '[[rules]]\na = "part*"\nb = "part*"\nclearance = 0.3\n',
        '[[rules]]\na = "part*"\nb = "part*"\nseverity = "warning"\n',
        '[[rules]]\na = "part*"\nb = "part*"\ntolerance = 0.05\n',
    ],
)
def test_rules(tmp_path: Path, rules: str) -> None:
    scene = spider(tmp_path, [*SHAPES[2:], *meshes(tmp_path)[:2]], rules)
    compare(scene, QUICK, 12)


def test_flags(tmp_path: Path) -> None:
    scene = spider(tmp_path, meshes(tmp_path)[:3])
    assert "near" in compare(scene, Settings(depth=False, clearance=0.4), 15)
    compare(scene, Settings(depth=False, tolerance=0.1, surface_tolerance=0.02), 15)


def posed_pairs(scene: Scene, bodies: PlacedBodies, settings: Settings) -> PosedPairs:
    planner, placed = Planner(settings, bodies.book, scene.composed), bodies.placed
    pairs = [
        Pair(placed[i], placed[j], settings, planner.request(i, j))
        for i, j in sorted(bodies.book.checked_pairs())
    ]
    return PosedPairs(list(placed.values()), pairs)


def sorted_and_decided(scene: Scene, count: int, seed: int) -> Counter[tuple[int, str]]:
    """How many pairs the core sorts so, and a check of the pose decides so."""
    bodies = place(scene, QUICK)
    pairs = posed_pairs(scene, bodies, QUICK)
    poses = RandomPoses([robot.robot for robot in scene.robots], count, seed)
    seen: Counter[tuple[int, str]] = Counter()
    for batch in pose_batches(scene, poses, 10):
        codes, _ = pairs.sift(batch.matrices)
        for row in range(batch.count):
            report = check(posed(scene, batch.pose(row)), QUICK)
            relations = {(f.a, f.b): f.relation for f in report.findings}
            for code, pair in zip(codes[row], pairs.pairs, strict=True):
                seen[int(code), relations.get((pair.a.id, pair.b.id), "separated")] += 1
    return seen


def require_proofs(seen: Counter[tuple[int, str]]) -> None:
    assert {relation for code, relation in seen if code == APART} <= {"separated"}
    assert {relation for code, relation in seen if code == DEEP} <= set(OVERLAPS)
    assert {relation for code, relation in seen if code == UNDECIDED} <= {"indeterminate"}


def test_the_core_sorts_as_the_ladder_decides(tmp_path: Path) -> None:
    """What a report does not list is counted by these codes alone."""
    scene = spider(tmp_path, [*meshes(tmp_path), *SHAPES, *open_cups(tmp_path)])
    seen = sorted_and_decided(scene, 25, 7)
    require_proofs(seen)
    assert {code for code, _ in seen} == {OPEN, APART, DEEP, UNDECIDED}


def test_few_curved_bodies_climb(tmp_path: Path) -> None:
    """Discs and rods, which hold no large balls, among concave meshes."""
    discs = ['<cylinder radius="0.6" length="0.05"/>', '<cylinder radius="0.05" length="1.6"/>']
    scene = spider(tmp_path, [*discs, *SHAPES[:2], *meshes(tmp_path)[:2], *discs])
    seen = sorted_and_decided(scene, 25, 8)
    require_proofs(seen)
    climbing = sum(number for (code, _), number in seen.items() if code == OPEN)
    assert climbing < 0.1 * seen[DEEP, "penetrating"]


def test_a_thin_overlap_of_closed_bodies_is_not_deep(tmp_path: Path) -> None:
    """An edge of a box reaches 0.011 into another box, and the largest ball in both is only 0.0091
    thick: within the tolerance, although no translation as short as that frees them."""
    slide = '<origin xyz="0 0.5 0"/><axis xyz="1 0 0"/><limit lower="0" upper="3"/>'
    turned = '<origin rpy="0 0 0.7853981633974483"/><geometry><box size="1 1 2"/></geometry>'
    wall = '<origin xyz="2 0 0"/><geometry><box size="1 6 1"/></geometry>'
    text = robot_of(
        link("wall", f"<collision>{wall}</collision>"),
        link("block", f"<collision>{turned}</collision>"),
        joint("slide", "wall", "block", "prismatic", slide),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    settings = Settings(depth=False, tolerance=0.01)
    pose = {"slide": (1.5 - math.sqrt(0.5) + 0.011,)}
    assert [f.relation for f in check(posed(scene, pose), settings).findings] == ["touching"]
    bodies = place(scene, settings)
    pairs = posed_pairs(scene, bodies, settings)
    (batch,) = pose_batches(scene, [pose], 1)
    assert pairs.sift(batch.matrices)[0].tolist() == [[OPEN]]


def test_matrices_have_the_bits_of_single_poses() -> None:
    scene = load_scene([SAMPLES / "arm.urdf", SAMPLES / "arm.srdf"])
    poses = RandomPoses([robot.robot for robot in scene.robots], 30, 1)
    (batch,) = pose_batches(scene, poses, 30)
    matrices = batch.matrices
    for row, pose in enumerate(poses):
        bodies = posed(scene, pose).bodies
        expected = [body.transform or IDENTITY for body in bodies]
        assert np.array_equal(matrices[row], np.array(expected)[:, :12])
