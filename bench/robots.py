"""Robots in many random poses: satcheck beside pinocchio with coal, in one process.

    pip install '.[peers]'
    python -m bench.robots ROBOT.urdf[:ROBOT.srdf] ... --packages DIR [--poses 10000] [--rounds 3]
        [--boxes 50]

Without an SRDF, links with a joint between them are left out, and pairs that meet in half of all
poses.
DIR: the folder of the packages that the files name. --boxes: each robot also beside a scene of so
many boxes around it.

All check the same pairs in the same poses. satcheck draws the poses and makes the counts of its
report within its time; pinocchio gets its configurations before the clock runs. Each round asks
everybody once, one after the other: read the ratios. One core: CPU seconds; two cores: wall
seconds (pinocchio's pool of threads, compiled, all pairs). Prints a table of poses a second,
medians over the rounds.

In the same run the answers are compared, pose by pose and pair by pair, on the first 1,000 poses.
coal tests surfaces in float64: it does not find a body inside another, and it has tolerances. Each
difference is counted, by what satcheck proved about the pair.
"""

from __future__ import annotations

import argparse
import math
import os
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from satcheck.audit import Settings
from satcheck.audit.samples import check_poses
from satcheck.report.report import OVERLAPS
from satcheck.scene import Scene, load_scene
from satcheck.scene.robot import Pose, RandomPoses, posed

JUDGED = 1000
WARM_UP = 64
Pairs = list[tuple[str, str]]


def boxes_around(count: int) -> list[tuple[str, list[float], list[float]]]:
    """(name, size, centre) of boxes in a shell around the root of a robot, metres."""
    draw = random.Random(5)
    boxes: list[tuple[str, list[float], list[float]]] = []
    while len(boxes) < count:
        centre = [draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-0.2, 1.2)]
        if 0.5 < math.hypot(*centre[:2]) < 1:
            boxes.append((f"box{len(boxes)}", [draw.uniform(0.05, 0.2) for _ in range(3)], centre))
    return boxes


def scene_of(files: Sequence[str], boxes: Sequence[Any], folder: Path) -> Scene:
    if not boxes:
        return load_scene(list(files))
    shape = '{{type = "box", size = {}}}'
    lines = [
        f'{{id = "{name}", static = true, position = {at}, shape = {shape.format(size)}}}'
        for name, size, at in boxes
    ]
    head = 'schema = "satcheck.scene/1"\nunits = "m"\ncheck_static = false\nbodies = ['
    (folder / "boxes.toml").write_text(head + ",\n".join(lines) + "]\n", encoding="utf-8")
    return load_scene([folder / "boxes.toml", *files])


def often_in_contact(scene: Scene) -> set[frozenset[str]]:
    """Pairs that an SRDF would leave out: links with a joint between them, and pairs that meet in
    half of all poses."""
    (robot,) = scene.robots
    poses = RandomPoses([robot.robot], 200, 9)
    found = check_poses(scene, poses, Settings(depth=False)).pairs
    often = {frozenset((pair.a, pair.b)) for pair in found if 2 * pair.contacts >= len(poses)}
    joined = {
        frozenset((a, b))
        for above, link in robot.neighbours()
        for a in robot.bodies_of(above)
        for b in robot.bodies_of(link)
    }
    return often | joined


def without(
    scene: Scene, pairs: set[frozenset[str]], files: Sequence[str], folder: Path
) -> list[str]:
    """The files, with an SRDF that leaves out these pairs."""
    links = {body.id: body.link for body in scene.robots[0].bodies}
    named = {tuple(sorted({links[id_] for id_ in pair})) for pair in pairs}
    lines = [
        f'<disable_collisions link1="{pair[0]}" link2="{pair[1]}" reason="Adjacent"/>'
        for pair in sorted(named)
        if len(pair) == 2
    ]
    name = scene.robots[0].robot.name
    path = folder / "pairs.srdf"
    path.write_text(
        f'<robot name="{name}">\n' + "\n".join(lines) + "\n</robot>\n", encoding="utf-8"
    )
    return [*files, str(path)]


class Pinocchio:
    """The same robot, boxes and pairs."""

    def __init__(
        self, urdf: str, scene: Scene, pairs: Pairs, boxes: Sequence[Any], packages: str
    ) -> None:
        self.model = pin.buildModelFromUrdf(urdf)
        geometry = pin.buildGeomFromUrdf(
            self.model, urdf, pin.GeometryType.COLLISION, package_dirs=[packages]
        )
        numbers: dict[str, int] = {}
        for number, one in enumerate(geometry.geometryObjects):
            link, _, place = one.name.rpartition("_")
            numbers[scene.robots[0].bodies_of(link)[int(place)]] = number
        for name, size, at in boxes:
            place = pin.SE3(np.eye(3), np.array(at))
            numbers[name] = geometry.addGeometryObject(
                pin.GeometryObject(name, 0, 0, place, coal.Box(*size))
            )
        for a, b in pairs:
            geometry.addCollisionPair(pin.CollisionPair(numbers[a], numbers[b]))
        self.geometry = geometry
        self.data, self.found = self.model.createData(), geometry.createData()
        self.pool = pin.GeometryPool(self.model, geometry, 2)

    def configurations(self, scene: Scene, poses: Sequence[Pose]) -> NDArray[np.float64]:
        rows = []
        for pose in poses:
            posture = posed(scene, pose).posture
            assert posture is not None
            q = pin.neutral(self.model)
            for name, values in posture.joints.items():
                joint = self.model.joints[self.model.getJointId(name)]
                turns = joint.nq == 2
                q[joint.idx_q : joint.idx_q + joint.nq] = (
                    (np.cos(values[0]), np.sin(values[0])) if turns else values
                )
            rows.append(q)
        return np.array(rows)

    def check(self, q: NDArray[np.float64], *, first: bool) -> int:
        ask, fixed = pin.computeCollisions, (self.model, self.data, self.geometry, self.found)
        return sum(ask(*fixed, row, first) for row in q)

    def check_on_two(self, columns: NDArray[np.float64]) -> int:
        return int(np.sum(pin.computeCollisionsInParallel(2, self.pool, columns, False, False)))

    def pairs_of(self, row: NDArray[np.float64]) -> list[bool]:
        pin.computeCollisions(self.model, self.data, self.geometry, self.found, row, False)
        return [result.isCollision() for result in self.found.collisionResults]


def judged(scene: Scene, poses: Sequence[Pose], peer: Pinocchio, pairs: Pairs) -> Counter[str]:
    """How many (pose, pair) the two agree on, and what satcheck says where they do not."""
    samples = check_poses(scene, poses, Settings(depth=False)).samples
    counts: Counter[str] = Counter()
    for sample, q in zip(samples, peer.configurations(scene, poses), strict=True):
        relations = {(f.a, f.b): f.relation for f in sample.findings}
        for pair, hit in zip(pairs, peer.pairs_of(q), strict=True):
            relation = relations.get(pair, "separated")
            if hit == (relation in OVERLAPS):
                counts["agree"] += 1
            else:
                counts[f"{relation}, coal says {'hit' if hit else 'free'}"] += 1
    return counts


def clocked(clock: Callable[[], float], ask: Callable[[], object]) -> float:
    start = clock()
    ask()
    return clock() - start


def measure(robot: str, options: argparse.Namespace, box_count: int, folder: Path) -> str:
    files = robot.split(":")
    boxes = boxes_around(box_count)
    alone = load_scene(files)
    if len(files) == 1:
        files = without(alone, often_in_contact(alone), files, folder)
    scene = scene_of(files, boxes, folder)
    robots = [each.robot for each in scene.robots]
    poses = RandomPoses(robots, options.poses, 0)
    pairs = [(p.a, p.b) for p in check_poses(scene, poses[:1], Settings(depth=False)).pairs]
    peer = Pinocchio(files[0], scene, pairs, boxes, options.packages)
    q = peer.configurations(scene, poses)
    columns = np.asfortranarray(q.T)
    ways: dict[str, tuple[Callable[[], float], Callable[[], object]]] = {
        "satcheck": (
            time.process_time,
            lambda: check_poses(scene, poses, Settings(depth=False, jobs=1)),
        ),
        "pinocchio + coal": (time.process_time, lambda: peer.check(q, first=False)),
        "pinocchio + coal, first hit": (time.process_time, lambda: peer.check(q, first=True)),
        "satcheck, two cores": (
            time.perf_counter,
            lambda: check_poses(scene, poses, Settings(depth=False, jobs=2)),
        ),
        "pinocchio + coal, two cores": (time.perf_counter, lambda: peer.check_on_two(columns)),
    }
    peer.check(q[:WARM_UP], first=False)
    times: dict[str, list[float]] = {way: [] for way in ways}
    for _ in range(options.rounds):
        for way, (clock, ask) in ways.items():
            times[way].append(clocked(clock, ask))
    counts = judged(scene, poses[:JUDGED], peer, pairs)
    pace = {way: options.poses / median(took) for way, took in times.items()}
    name = Path(files[0]).stem + (f" beside {box_count} boxes" if boxes else "")
    bodies = len(scene.bodies)
    said = ", ".join(f"{count:,} {what}" for what, count in counts.most_common())
    cells = [f"{pace[way]:,.0f}" for way in ways]
    one = pace["satcheck"] / pace["pinocchio + coal"]
    two = pace["satcheck, two cores"] / pace["pinocchio + coal, two cores"]
    ratios = f"{one:.2f} | {two:.2f}"
    return f"| {name} | {bodies} | {len(pairs)} | {' | '.join(cells)} | {ratios} | {said} |"


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("robots", nargs="+", metavar="ROBOT.urdf[:ROBOT.srdf]")
    parser.add_argument("--packages", required=True, metavar="DIR")
    parser.add_argument("--poses", type=int, default=10_000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--boxes", type=int, default=0)
    options = parser.parse_args()
    os.environ["ROS_PACKAGE_PATH"] = options.packages
    lines = [
        "| robot | bodies | pairs | satcheck | pin | pin, first hit | satcheck, 2 cores "
        "| pin, 2 cores | ratio | ratio, 2 cores | answers |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for robot in options.robots:
        for box_count in dict.fromkeys((0, options.boxes)):
            with tempfile.TemporaryDirectory() as folder:
                lines.append(measure(robot, options, box_count, Path(folder)))
                sys.stderr.write(lines[-1] + "\n")
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
