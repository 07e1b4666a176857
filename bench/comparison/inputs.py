"""The files that the benches check, written by rules: the same bytes every time."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from bench.scene_of import scene_of
from sample_meshes import hierarchies, make
from sample_meshes.make import Mesh, Point

LARGE = (320, 200)  # segments and sides of a ring: 128,000 triangles
# A node of a GLB file is one of these meshes.
MESHES = {
    "box.obj": make.box((0.0, 0.0, 0.0), (2.0, 2.0, 2.0)),
    "l_bracket.obj": make.l_bracket(),
    "link_a.ply": make.link(straight=3.0, bend=1.0, thickness=0.3, segments=8, sides=8),
    "ring.glb": make.ring(radius=2.0, thickness=0.5, segments=24, sides=12),
    "rod.stl": make.rod(radius=0.5, low=-3.0, high=3.0, sides=12),
}


def ring(segments: int, sides: int) -> Mesh:
    return make.ring(radius=2.0, thickness=0.7, segments=segments, sides=sides)


def turned(mesh: Mesh, angle: float, by: Point) -> Mesh:
    """About an axis that is none of the frame, then moved: nothing is parallel any more."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = 1 / 3, 2 / 3, 2 / 3

    def move(p: Point) -> Point:
        along = (x * p[0] + y * p[1] + z * p[2]) * (1 - c)
        cross = (y * p[2] - z * p[1], z * p[0] - x * p[2], x * p[1] - y * p[0])
        axis = (x, y, z)
        turn = [p[k] * c + cross[k] * s + axis[k] * along + by[k] for k in range(3)]
        return make.tidy(turn[0]), make.tidy(turn[1]), make.tidy(turn[2])

    return make.moved(mesh, move)


def crossing_rings(folder: Path, segments: int, sides: int) -> list[str]:
    """Two rings whose tubes cross."""
    first = ring(segments, sides)
    return write_pair(folder, f"ring_{segments}", first, turned(first, 1.3, (2.9, 0.2, 0.1)))


def write_pair(folder: Path, name: str, a: Mesh, b: Mesh) -> list[str]:
    paths = [folder / f"{name}_{letter}.obj" for letter in "ab"]
    for path, mesh in zip(paths, (a, b), strict=True):
        path.write_bytes(make.obj(mesh))
    return [str(path) for path in paths]


def glb_of_nodes(count: int) -> bytes:
    """The bodies of scene_of.py as nodes of one GLB file, as far as they are of MESHES."""
    numbers = {name: k for k, name in enumerate(MESHES)}
    nodes: list[dict[str, Any]] = []
    for body in scene_of(count, Path())["bodies"]:
        number = numbers.get(Path(body["mesh"]).name)
        if number is not None:
            matrix = [body["transform"][row][column] for column in range(4) for row in range(4)]
            nodes.append({"name": body["id"], "mesh": number, "matrix": matrix})
    return hierarchies.glb(MESHES, nodes, list(range(len(nodes))))


def model_3mf(mesh: Mesh) -> bytes:
    """Deflated by nobody: the time is that of the reader, not of zlib."""
    types = (
        f'<Default Extension="rels" ContentType="{hierarchies.RELATIONSHIPS_TYPE}"/>'
        f'<Default Extension="model" ContentType="{hierarchies.MODEL_TYPE}"/>'
    )
    link = f'<Relationship Id="rel0" Type="{hierarchies.START}" Target="/3D/3dmodel.model"/>'
    body = hierarchies.mesh_object(1, "ring", mesh)
    model = (
        f'<model unit="meter" xmlns="{hierarchies.CORE}"><resources>{body}</resources>'
        '<build><item objectid="1"/></build></model>'
    )
    return hierarchies.package(
        {
            "[Content_Types].xml": f'<Types xmlns="{hierarchies.CONTENT_TYPES}">{types}</Types>',
            "_rels/.rels": (
                f'<Relationships xmlns="{hierarchies.RELATIONSHIPS}">{link}</Relationships>'
            ),
            "3D/3dmodel.model": model,
        }
    )


def dae(mesh: Mesh) -> bytes:
    points = " ".join("{:.9g} {:.9g} {:.9g}".format(*point) for point in mesh.points)
    triangles = mesh.triangles()
    corners = " ".join("{} {} {}".format(*triangle) for triangle in triangles)
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    count = len(mesh.points)
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count="{3 * count}">{points}</float_array>
<technique_common><accessor source="#f" count="{count}" stride="3">{axes}</accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(triangles)}"><input semantic="VERTEX" source="#v" offset="0"/>
<p>{corners}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="ring">
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
""".encode()


WRITERS: dict[str, Callable[[Mesh], bytes]] = {
    "obj": make.obj,
    "stl": make.stl,
    "ply": make.ply,
    "off": make.off,
    "glb": make.glb,
    "3mf": model_3mf,
    "dae": dae,
}
