"""Small good files that use much of what their readers know, written here."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ezdxf.filemanagement import new

from tests.scene import files, graphs, test_gltf
from tests.scene.format import scenes
from tests.scene.robot import robots

GOLDEN = Path(__file__).resolve().parents[1] / "golden"

SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="210mm" height="297mm" viewBox="0 0 210 297">
<style>.a { fill: none; stroke: red } #b > rect { fill-rule: evenodd }</style>
<defs><symbol id="s"><circle r="3"/></symbol></defs>
<g id="b" transform="translate(10, 20) rotate(30) matrix(1 0 0 1 2 3)"><rect width="5" height="4"
 rx="1"/><path d="M0 0 h10 v10 l-5 5 z m1 1 c1 .5 2 .5 3 0 s1-.5 2 0 q.5 .5 1 0 t1 0
 a2 3 9 0 1-4 4 z"/>
</g><use href="#s" x="4"/><polygon points="0,0 4,0 4,4"/><ellipse rx="4" ry="2"/>
<line x1="0" y1="0" x2="4" y2="1" stroke-width="2"/></svg>"""

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


def _dxf() -> bytes:
    document = new()
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    space.add_lwpolyline([(0, 0, 0, 0, 1), (10, 0, 0, 0, 1)], close=True)
    space.add_circle((20, 0), 3)
    space.add_line((0, 30), (10, 30))
    space.add_line((10, 30), (5, 35))
    space.add_arc((5, 30), 5, 0, 180)
    block = document.blocks.new("plate")
    block.add_lwpolyline([(0, 0), (4, 0), (4, 3)], close=True)
    space.add_blockref("plate", (40, 0), {"rotation": 30})
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


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
    "svg": [SVG.encode],
    "dxf": [_dxf],
    "json": [_scene, _shapes, _simple],
    "urdf": [_urdf],
    "mjcf": [MJCF.encode],
    "config": [CONFIG.encode],
    "baseline": [_baseline],
    "pose": [lambda: json.dumps(POSES).encode(), lambda: json.dumps(POSES[0]).encode()],
    "verify": _reports(),
    "view": _reports(),
}
