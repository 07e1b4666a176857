"""Small good files that use much of what their readers know, written here."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tests.scene import files, graphs, test_gltf
from tests.scene.robot import robots
from tests.scene.scene_file import scenes

GOLDEN = Path(__file__).resolve().parents[1] / "golden"

MJCF = """<mujoco model="m">
<compiler angle="radian" meshdir="."/><option><flag filterparent="disable"/></option>
<default><geom size=".1"/><default class="v"><geom contype="0" conaffinity="0"/></default></default>
<asset><mesh name="own" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><mesh name="file" file="a.stl"/>
<mesh name="made" builtin="sphere" params="1" scale="1 2 -1" refpos="1 0 0"/>
<hfield name="h" nrow="2" ncol="2" size="1 1 1 1" elevation="0 1 1 0"/></asset>
<worldbody><geom type="plane" size="1 1 1"/><geom type="hfield" hfield="h" pos="0 0 -3"/>
<body name="a" pos="1 2 3" euler=".1 .2 .3"><joint name="j" axis="0 1 1" range="-1 1" ref=".5"/>
<joint name="s" type="slide" pos="1 0 0"/><geom name="g" type="mesh" mesh="own"/>
<frame axisangle="0 0 1 1"><geom name="k" type="box" mesh="made"/></frame>
<body name="b"><joint name="q" type="ball"/><geom name="c" type="capsule" fromto="0 0 0 0 1 1"/>
<geom class="v" type="cylinder" size=".2 .3"/></body></body>
<replicate count="3" offset="1 0 0"><body name="r" pos="0 5 0"><freejoint/><geom/></body>
</replicate>
<body name="f" mocap="true"><geom name="e" type="ellipsoid" size="1 2 3" contype="2"/></body>
<body name="p"><geom type="mesh" mesh="file"/></body></worldbody>
<contact><exclude body1="a" body2="f"/><pair geom1="g" geom2="e"/></contact>
<equality><connect body1="a" body2="f" anchor="0 0 0"/></equality>
<keyframe><key name="x" qpos=".1 .2 1 0 0 0 0 5 0 1 0 0 0 1 5 0 1 0 0 0 2 5 0 1 0 0 0"/></keyframe>
</mujoco>"""

CONFIG = """clearance = "0.5 mm"
planar = "xy"
package = ["arm=../arm", "hand=hand"]
fail-on = "note"
[tool.satcheck]
tolerance = 0.1
"""

POSES = [{"a": 0.5, "b": [0, 1, 2]}, {"lift": -0.1, "c": [1e-3, 2, 3, 4, 5, 6]}]


def written(kind: str) -> list[bytes]:
    return [make() for make in _MAKERS.get(kind, ())]


def _glb() -> bytes:
    """A tree with instances, two of them of a mesh that cannot be used."""
    document, buffer = graphs.meshes("a", "b")
    document["nodes"] = [
        {"name": "top", "children": [1, 2], "scale": [2, 2, 2]},
        {"name": "left", "mesh": 0, "translation": [1, 2, 3], "rotation": [0, 0, 0.6, 0.8]},
        {"name": "right", "mesh": 1, "matrix": graphs.MOVED, "children": [3]},
        {"mesh": 0, "skin": 0, "weights": [0.5]},
    ]
    document["skins"] = [{"joints": [1, 2]}]
    document["scenes"] = [{"nodes": [0]}]
    document["extensionsUsed"] = document["extensionsRequired"] = ["KHR_mesh_quantization"]
    return files.glb(document, buffer)


def _gltf() -> bytes:
    document, buffer = files.gltf_document()
    data = base64.b64encode(buffer).decode()
    document["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{data}"
    return json.dumps(document).encode()


def _meshopt() -> bytes:
    return test_gltf.packed_with_meshopt("EXT_meshopt_compression", 0, True).glb()


def _threemf() -> bytes:
    placed = '<component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>'
    resources = files.object_3mf(1) + files.components_3mf(2, placed * 2)
    return files.threemf(resources, '<item objectid="2"/><item objectid="1"/>')


def _baseline() -> bytes:
    finding = {"asset": "", "a": "x", "b": "y", "severity": "error", "relation": "penetrating"}
    figures = {"units": "mm", "reason": "by design", "depth": 0.5}
    return json.dumps(
        {"schema": "satcheck.baseline/1", "findings": [{**finding, **figures}]}
    ).encode()


def _scene() -> bytes:
    return json.dumps(scenes.full()).encode()


def _shapes() -> bytes:
    bodies = [
        {"id": "ball", "shape": {"sphere": {"radius": 1}}},
        {"id": "rod", "shape": {"capsule": {"radius": 0.5, "length": 2}}, "position": [1, 0, 0]},
    ]
    return json.dumps({"schema": "satcheck.scene/1", "bodies": bodies}).encode()


def _simple() -> bytes:
    body: dict[str, Any] = {"id": "a", "mesh": "a.obj", "group": "g", "static": False}
    return json.dumps(
        {
            "schema": "satcheck-scene-1",
            "units": "mm",
            "bodies": [body, {**body, "id": "b", "transform": [[1, 0, 0, 2], *_ROWS]}],
            "ignore_within_groups": ["g"],
            "allowed_pairs": [["a", "b", "why"]],
        }
    ).encode()


_ROWS = [[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def _urdf() -> bytes:
    links = robots.link("a"), robots.link("b"), robots.joint("j", "a", "b", "revolute", _LIMIT)
    return robots.robot_of(*links).encode()


_LIMIT = '<origin xyz="1 0 0" rpy="0 0 1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1"/>'


def _reports() -> list[Callable[[], bytes]]:
    """The expected reports, whose files do not lie beside them."""
    return [path.read_bytes for path in sorted(GOLDEN.glob("*.json"))]


_MAKERS: Mapping[str, list[Callable[[], bytes]]] = {
    "obj": [files.obj],
    "stl": [files.binary_stl, files.ascii_stl],
    "ply": [files.ascii_ply, files.binary_ply],
    "off": [files.off],
    "glb": [_glb, _meshopt, graphs.with_broken_mesh],
    "gltf": [_gltf],
    "3mf": [_threemf],
    "dae": [files.collada],
    "json": [_scene, _shapes, _simple],
    "urdf": [_urdf],
    "mjcf": [MJCF.encode],
    "config": [CONFIG.encode],
    "baseline": [_baseline],
    "pose": [lambda: json.dumps(POSES).encode(), lambda: json.dumps(POSES[0]).encode()],
    "verify": _reports(),
    "view": _reports(),
}
