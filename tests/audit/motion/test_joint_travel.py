"""Bounds of the motion of links, against places at many moments."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest

from satcheck.audit import Settings
from satcheck.audit.bodies import place
from satcheck.audit.body import PlacedBody
from satcheck.audit.motion.joint_travel import JointTravel
from satcheck.scene import Scene, load_scene
from satcheck.scene.robot import with_joint_path
from tests.scene.robot.robots import joint, link, robot_of

BOX = '<collision><geometry><box size="0.4 0.2 0.6"/></geometry></collision>'
IDS = ["l0", "l1", "l2", "l3"]
LIMIT = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
STEP = 1e-4


def chain(folder: Path, kinds: tuple[str, ...]) -> Path:
    """A chain of links, each with a box."""
    parts = [link("l0", BOX)]
    for k, kind in enumerate(kinds):
        axis = f'<axis xyz="{0.1 + k % 2} {k} {1 - k % 3}"/><origin xyz="{1 - 0.3 * k} 0.5 {k}"/>'
        parts += [link(f"l{k + 1}", BOX), joint(f"j{k}", f"l{k}", f"l{k + 1}", kind, axis + LIMIT)]
    (folder / "chain.urdf").write_text(robot_of(*parts))
    return folder / "chain.urdf"


def bodies_of(scene: Scene) -> list[PlacedBody]:
    return list(place(scene, Settings()).placed.values())


@pytest.mark.parametrize(
    "kinds",
    [
        ("revolute", "revolute", "revolute"),
        ("prismatic", "revolute", "planar"),
        ("planar", "prismatic", "revolute"),
        ("prismatic", "prismatic", "revolute"),
    ],
    ids="-".join,
)
@pytest.mark.parametrize("seed", range(3))
def test_no_point_is_faster_than_its_bounds(
    tmp_path: Path, kinds: tuple[str, ...], seed: int
) -> None:
    """Seen from the first link, and from the second one, which the first joint carries."""
    scene = load_scene([chain(tmp_path, kinds)])
    rng = random.Random(seed)
    start, end = (
        {
            f"j{k}": tuple(rng.uniform(-2, 2) for _ in range(3 if kind == "planar" else 1))
            for k, kind in enumerate(kinds)
        }
        for _ in range(2)
    )
    placed = with_joint_path(scene, [start, end])
    assert placed.joint_path is not None
    travel = JointTravel(placed, placed.joint_path, bodies_of(placed))
    corners = np.array(
        [[x, y, z, 1] for x in (-0.2, 0.2) for y in (-0.1, 0.1) for z in (-0.3, 0.3)]
    )
    times = np.arange(0.3, 0.7, STEP)
    matrices = travel.at(times).placements(IDS, len(times)).reshape(-1, 4, 3, 4)
    for frame, joints in ((0, [2, 1, 0]), (1, [2, 1])):
        at = travel.at(np.array([0.5]))
        speed, acceleration = (
            float(own[0]) for own in travel.fastest(at, np.array([0.2]), 3, joints)
        )
        world = matrices[:, 3] @ corners.T
        turn, shift = matrices[:, frame, :, :3], matrices[:, frame, :, 3:]
        seen = turn.transpose(0, 2, 1) @ (world - shift)
        moved = np.diff(seen, axis=0) / STEP
        assert np.linalg.norm(moved, axis=1).max() <= speed
        assert np.linalg.norm(np.diff(moved, axis=0) / STEP, axis=1).max() <= acceleration + 1e-6
        assert travel.in_piece((3, joints), 0.0, 1.0)[0] >= np.linalg.norm(moved, axis=1).max()


def test_rounding_grows_with_the_distance_of_a_mesh_from_its_link(tmp_path: Path) -> None:
    pads = []
    for x in (0.0, 1e6):
        box = BOX.replace("<geo", f'<origin xyz="{x} 0 0"/><geo')
        turning = joint("j0", "l0", "l1", "revolute", LIMIT)
        (tmp_path / "far.urdf").write_text(robot_of(link("l0", BOX), link("l1", box), turning))
        scene = load_scene([tmp_path / "far.urdf"])
        placed = with_joint_path(scene, [{"j0": (0.0,)}, {"j0": (1.0,)}])
        assert placed.joint_path is not None
        travel = JointTravel(placed, placed.joint_path, bodies_of(placed))
        pads.append(travel.pad(1))
        assert x <= travel.reach(1) <= 4 * x + 100
    assert pads[1] >= 1e4 * pads[0]
