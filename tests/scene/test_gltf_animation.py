"""Animations of glTF at one time: each interpolation, nodes, skins and morph targets."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from satcheck.audit import Settings, check
from satcheck.scene import Scene, load_scene
from satcheck.scene.read_options import ReadOptions
from satcheck.verify import verify
from tests.cli.process import satcheck
from tests.scene import files

KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
HALF = math.sqrt(0.5)


class Animated:
    """A tetrahedron at one node, with an animation."""

    def __init__(self) -> None:
        self.document, self.buffer = files.gltf_document()
        self.document["animations"] = [{"name": "walk", "channels": [], "samplers": []}]

    @property
    def animation(self) -> dict[str, Any]:
        return self.document["animations"][0]

    def accessor(self, rows: Sequence[Sequence[float]]) -> int:
        self.buffer += bytes(-len(self.buffer) % 4)
        views, accessors = self.document["bufferViews"], self.document["accessors"]
        flat = [value for row in rows for value in row]
        data = struct.pack(f"<{len(flat)}f", *flat)
        views.append({"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)})
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": 5126,
                "count": len(rows),
                "type": KINDS[len(rows[0])],
            }
        )
        self.buffer += data
        self.document["buffers"][0]["byteLength"] = len(self.buffer)
        return len(accessors) - 1

    def channel(
        self,
        path: str,
        times: Sequence[float],
        values: Sequence[Sequence[float]],
        interpolation: str = "LINEAR",
        node: int = 0,
    ) -> None:
        samplers = self.animation["samplers"]
        samplers.append(
            {
                "input": self.accessor([[time] for time in times]),
                "output": self.accessor(values),
                "interpolation": interpolation,
            }
        )
        target = {"node": node, "path": path}
        self.animation["channels"].append({"sampler": len(samplers) - 1, "target": target})

    def load(self, folder: Path, time: float | None) -> Scene:
        path = folder / "a.glb"
        path.write_bytes(files.glb(self.document, self.buffer))
        return load_scene([path], reading=ReadOptions(time=time))

    def box(self, folder: Path, time: float | None) -> tuple[tuple[float, ...], ...]:
        scene = self.load(folder, time)
        assert not scene.unreadable, scene.issues
        return scene.bodies[0].world_mesh().bounds


@pytest.fixture
def still(tmp_path: Path) -> tuple[tuple[float, ...], ...]:
    return Animated().box(tmp_path, None)


def moved(box: tuple[tuple[float, ...], ...], x: float) -> list[Any]:
    return [pytest.approx((corner[0] + x, *corner[1:]), abs=1e-6) for corner in box]


# A spline from 0 to 8 in 2 seconds that leaves with speed 1 and arrives with speed 3: by Hermite's
# formula at half of the time 8 / 2 + 2 (1 - 3) / 8.
SPLINE = ([0, 0, 0], [0, 0, 0], [1, 0, 0], [3, 0, 0], [8, 0, 0], [0, 0, 0])


@pytest.mark.parametrize(
    ("interpolation", "values", "time", "x"),
    [
        ("LINEAR", ([0, 0, 0], [8, 0, 0]), 2.5, 6),
        ("LINEAR", ([0, 0, 0], [8, 0, 0]), 0, 0),
        ("LINEAR", ([0, 0, 0], [8, 0, 0]), 9, 8),
        ("STEP", ([0, 0, 0], [8, 0, 0]), 2.9, 0),
        ("STEP", ([0, 0, 0], [8, 0, 0]), 3, 8),
        ("CUBICSPLINE", SPLINE, 1, 0),
        ("CUBICSPLINE", SPLINE, 2, 3.5),
        ("CUBICSPLINE", SPLINE, 3, 8),
    ],
)
def test_a_node_moves_between_its_keys(
    tmp_path: Path,
    still: tuple[tuple[float, ...], ...],
    interpolation: str,
    values: Sequence[Sequence[float]],
    time: float,
    x: float,
) -> None:
    animated = Animated()
    animated.channel("translation", (1, 3), values, interpolation)
    assert list(animated.box(tmp_path, time)) == moved(still, x)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_rotation_takes_the_shorter_arc_at_an_even_speed(tmp_path: Path, sign: int) -> None:
    """A third of a right angle about z; -q is the same rotation as q."""
    turned, third = Animated(), math.radians(30) / 2
    turned.channel("rotation", (0, 3), ([0, 0, 0, 1], [0, 0, sign * HALF, sign * HALF]))
    fixed = Animated()
    fixed.document["nodes"][0]["rotation"] = [0, 0, math.sin(third), math.cos(third)]
    low, high = fixed.box(tmp_path, None)
    assert turned.box(tmp_path, 1) == (pytest.approx(low, abs=1e-6), pytest.approx(high, abs=1e-6))


def test_a_scale_replaces_that_of_the_node(tmp_path: Path) -> None:
    animated = Animated()
    animated.document["nodes"][0]["scale"] = [7, 7, 7]
    animated.channel("scale", (0, 1), ([1, 1, 1], [3, 1, 1]))
    plain = Animated().box(tmp_path, None)
    doubled = tuple(pytest.approx((2 * x, y, z), abs=1e-6) for x, y, z in plain)
    assert animated.box(tmp_path, 0.5) == doubled


def test_morph_targets_follow_their_weights(
    tmp_path: Path, still: tuple[tuple[float, ...], ...]
) -> None:
    animated = Animated()
    primitive = animated.document["meshes"][0]["primitives"][0]
    count = animated.document["accessors"][primitive["attributes"]["POSITION"]]["count"]
    primitive["targets"] = [{"POSITION": animated.accessor([[4, 0, 0]] * count)}]
    animated.channel("weights", (0, 2), ([0], [1]))
    assert list(animated.box(tmp_path, 1)) == moved(still, 2)
    assert list(animated.box(tmp_path, None)) == moved(still, 0)


def test_a_skin_follows_its_joints(tmp_path: Path, still: tuple[tuple[float, ...], ...]) -> None:
    animated = Animated()
    attributes = animated.document["meshes"][0]["primitives"][0]["attributes"]
    count = animated.document["accessors"][attributes["POSITION"]]["count"]
    attributes["JOINTS_0"] = animated.accessor([[0, 0, 0, 0]] * count)
    attributes["WEIGHTS_0"] = animated.accessor([[1, 0, 0, 0]] * count)
    animated.document["nodes"].append({"name": "joint"})
    animated.document["scenes"][0]["nodes"].append(1)
    animated.document["skins"] = [{"joints": [1]}]
    animated.document["nodes"][0]["skin"] = 0
    animated.channel("translation", (0, 1), ([0, 0, 0], [5, 0, 0]), node=1)
    assert list(animated.box(tmp_path, 1)) == moved(still, 5)
    assert list(animated.box(tmp_path, None)) == moved(still, 0)


def test_the_time_is_told_and_without_it_that_there_is_an_animation(tmp_path: Path) -> None:
    animated = Animated()
    animated.channel("translation", (0, 1), ([0, 0, 0], [5, 0, 0]))
    animated.document["animations"].append({"channels": [], "samplers": []})
    said = {}
    for time in (None, 0.5):
        (issue,) = (i for i in animated.load(tmp_path, time).issues if i.code == "time-sampled")
        assert issue.severity == "note"
        said[time] = issue.message
    assert "--time" in said[None]
    assert "the first of 2 animations ('walk') at 0.5 s" in said[0.5]


def test_a_report_is_verified_at_its_own_time(tmp_path: Path) -> None:
    animated = Animated()
    animated.document["nodes"].append(dict(animated.document["nodes"][0], name="other"))
    animated.document["scenes"][0]["nodes"].append(1)
    animated.channel("translation", (0, 1), ([0, 0, 0], [50, 0, 0]))
    primitive = animated.document["meshes"][0]["primitives"][0]
    count = animated.document["accessors"][primitive["attributes"]["POSITION"]]["count"]
    primitive["targets"] = [{"POSITION": animated.accessor([[4, 0, 0]] * count)}]
    animated.channel("weights", (0, 1), ([0], [1]))
    report = check(animated.load(tmp_path, 1), Settings(certificate=True))
    assert report.findings[0].relation == "separated"
    document = report.to_dict()
    assert document["reading"]["time"] == 1
    assert not verify(document, Path("/")).faults
    document["reading"]["time"] = 0.5
    assert verify(document, Path("/")).faults  # the morph target is another shape then


def broken(change: str) -> Animated:
    animated = Animated()
    animated.channel("translation", (0, 1), ([0, 0, 0], [5, 0, 0]))
    sampler = animated.animation["samplers"][0]
    target = animated.animation["channels"][0]["target"]
    match change:
        case "interpolation":
            sampler["interpolation"] = "BEZIER"
        case "falling":
            sampler["input"] = animated.accessor([[1], [1]])
        case "count":
            sampler["output"] = animated.accessor([[0, 0, 0]])
        case "path":
            target["path"] = "colour"
        case "node":
            target["node"] = 99
        case "matrix":
            animated.document["nodes"][0]["matrix"] = [float(k % 5 == 0) for k in range(16)]
        case "pointer":
            target["extensions"] = {"KHR_animation_pointer": {"pointer": "/nodes/0/scale"}}
        case "empty":
            sampler["input"] = sampler["output"] = 99
    return animated


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ("interpolation", "bad-record"),
        ("falling", "bad-record"),
        ("count", "count-mismatch"),
        ("path", "bad-record"),
        ("node", "index-out-of-range"),
        ("matrix", "bad-record"),
        ("pointer", "unsupported-feature"),
        ("empty", "index-out-of-range"),
    ],
)
def test_an_animation_that_cannot_be_trusted_is_refused(
    tmp_path: Path, change: str, code: str
) -> None:
    animated = broken(change)
    (lost,) = animated.load(tmp_path, 0.5).unreadable
    assert lost.issue.code == code
    assert not animated.load(tmp_path, None).unreadable  # nobody asked for it


def test_the_command_takes_a_time(tmp_path: Path) -> None:
    animated = Animated()
    animated.channel("translation", [0, 2], [[0, 0, 0], [8, 0, 0]])
    animated.load(tmp_path, None)
    (tmp_path / "still.glb").write_bytes(files.glb())
    paths = [str(tmp_path / name) for name in ("a.glb", "still.glb")]
    assert satcheck(*paths).code == 1
    assert satcheck(*paths, "--time", "1").code == 0


def test_an_animation_is_chosen_by_its_name_or_its_number(tmp_path: Path) -> None:
    animated = Animated()
    animated.channel("translation", [0, 2], [[0, 0, 0], [8, 0, 0]])
    walk = animated.document["animations"][0]
    run = {**walk, "name": "run", "samplers": [{**walk["samplers"][0], "interpolation": "STEP"}]}
    animated.document["animations"] = [walk, run]
    still = animated.load(tmp_path, None).bodies[0].world_mesh().bounds
    path = tmp_path / "a.glb"
    for name, x in (("walk", 4.0), ("run", 0.0), ("1", 0.0), (None, 4.0)):
        scene = load_scene([path], reading=ReadOptions(time=1.0, animation=name))
        assert list(scene.bodies[0].world_mesh().bounds) == moved(still, x)
    (lost,) = load_scene([path], reading=ReadOptions(time=1.0, animation="fly")).unreadable
    assert (lost.issue.code, "walk, run" in lost.issue.message) == ("unknown-part", True)
    assert satcheck(str(path), "--animation", "run").code == 2
