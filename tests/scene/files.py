"""Small mesh files of every format, as bytes: the unit cube from (0, 0, 0) to (1, 1, 1)."""

from __future__ import annotations

import io
import json
import struct
import zipfile
from collections.abc import Sequence
from typing import Any

Points = Sequence[tuple[float, float, float]]
Faces = Sequence[Sequence[int]]

CUBE_POINTS: Points = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
CUBE_QUADS: Faces = [
    (0, 1, 3, 2),
    (4, 6, 7, 5),
    (0, 4, 5, 1),
    (2, 3, 7, 6),
    (0, 2, 6, 4),
    (1, 5, 7, 3),
]
CUBE: Faces = [half for a, b, c, d in CUBE_QUADS for half in ((a, b, c), (a, c, d))]
TWO_CUBES_POINTS: Points = [*CUBE_POINTS, *((x + 3, y, z) for x, y, z in CUBE_POINTS)]
TWO_CUBES: Faces = [*CUBE, *(tuple(i + 8 for i in face) for face in CUBE)]
TETRAHEDRON_POINTS: Points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TETRAHEDRON: Faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]

_3MF_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_3MF_PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
_3MF_START = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_RELATIONSHIPS = "http://schemas.openxmlformats.org/package/2006/relationships"
_COLLADA = "http://www.collada.org/2005/11/COLLADASchema"


def obj(points: Points = CUBE_POINTS, faces: Faces = CUBE) -> bytes:
    lines = ["v " + " ".join(map(str, point)) for point in points]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def binary_stl(
    points: Points = CUBE_POINTS, faces: Faces = CUBE, header: bytes = b"", count: int | None = None
) -> bytes:
    facets = (
        struct.pack("<12fH", 0, 0, 0, *(c for corner in face for c in points[corner]), 0)
        for face in faces
    )
    number = len(faces) if count is None else count
    return header.ljust(80, b" ") + struct.pack("<I", number) + b"".join(facets)


def ascii_stl(points: Points = CUBE_POINTS, faces: Faces = CUBE) -> bytes:
    lines = ["solid cube"]
    for face in faces:
        lines += [" facet normal 0 0 0", "  outer loop"]
        lines += ["   vertex {} {} {}".format(*points[corner]) for corner in face]
        lines += ["  endloop", " endfacet"]
    return "\n".join([*lines, "endsolid cube", ""]).encode()


def ply_header(kind: str, vertices: int, faces: int, coordinate: str = "float") -> bytes:
    axes = "".join(f"property {coordinate} {axis}\n" for axis in "xyz")
    return (
        f"ply\nformat {kind} 1.0\ncomment made for a test\nelement vertex {vertices}\n{axes}"
        f"element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()


def ascii_ply(points: Points = CUBE_POINTS, faces: Faces = CUBE_QUADS) -> bytes:
    lines = [" ".join(map(str, point)) for point in points]
    lines += [" ".join(map(str, (len(face), *face))) for face in faces]
    return ply_header("ascii", len(points), len(faces)) + ("\n".join(lines) + "\n").encode()


def binary_ply(
    points: Points = CUBE_POINTS,
    faces: Faces = CUBE_QUADS,
    *,
    big: bool = False,
    double: bool = False,
) -> bytes:
    order = ">" if big else "<"
    kind = "binary_big_endian" if big else "binary_little_endian"
    header = ply_header(kind, len(points), len(faces), "double" if double else "float")
    body = [struct.pack(order + ("3d" if double else "3f"), *point) for point in points]
    body += [struct.pack(f"{order}B{len(face)}i", len(face), *face) for face in faces]
    return header + b"".join(body)


def integer_ply(kind: str, points: Points) -> bytes:
    """The cube with corners of type short. kind: the format in the header."""
    content = ply_header(kind, len(points), len(CUBE_QUADS), "short")
    if kind == "ascii":
        rows = [*points, *((len(face), *face) for face in CUBE_QUADS)]
        return content + "".join(" ".join(map(str, row)) + "\n" for row in rows).encode()
    content += b"".join(struct.pack("<3h", *point) for point in points)
    return content + b"".join(struct.pack(f"<B{len(f)}i", len(f), *f) for f in CUBE_QUADS)


def off(points: Points = CUBE_POINTS, faces: Faces = CUBE_QUADS) -> bytes:
    lines = ["OFF", "# made for a test", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(map(str, point)) for point in points]
    lines += [" ".join(map(str, (len(face), *face))) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def gltf_document(
    points: Points = CUBE_POINTS, faces: Faces = CUBE
) -> tuple[dict[str, Any], bytes]:
    """(document with one buffer, that buffer): positions, then uint16 indices."""
    positions = b"".join(struct.pack("<3f", *point) for point in points)
    indices = b"".join(struct.pack("<3H", *face) for face in faces)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3 * len(faces), "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(positions)},
            {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices)},
        ],
        "buffers": [{"byteLength": len(positions) + len(indices)}],
    }
    return document, positions + indices


def glb(document: dict[str, Any] | None = None, buffer: bytes | None = None) -> bytes:
    default, default_buffer = gltf_document()
    text = json.dumps(default if document is None else document).encode()
    text += b" " * (-len(text) % 4)
    data = default_buffer if buffer is None else buffer
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def model_3mf(resources: str, items: str, *, attributes: str = 'unit="inch"') -> bytes:
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><model {attributes} xmlns="{_3MF_CORE}" '
        f'xmlns:p="{_3MF_PRODUCTION}"><resources>{resources}</resources>'
        f"<build>{items}</build></model>"
    ).encode()


def object_3mf(id_: int, points: Points = CUBE_POINTS, faces: Faces = CUBE) -> str:
    vertices = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*point) for point in points)
    triangles = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in faces)
    return (
        f'<object id="{id_}" type="model"><mesh><vertices>{vertices}</vertices>'
        f"<triangles>{triangles}</triangles></mesh></object>"
    )


def components_3mf(id_: int, components: str) -> str:
    return f'<object id="{id_}"><components>{components}</components></object>'


def package_3mf(parts: dict[str, bytes], start: str = "/3D/3dmodel.model") -> bytes:
    relationships = (
        f'<Relationships xmlns="{_RELATIONSHIPS}"><Relationship Id="r" Type="{_3MF_START}" '
        f'Target="{start}"/></Relationships>'
    )
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as package:
        package.writestr("_rels/.rels", relationships)
        for name, content in parts.items():
            package.writestr(name, content)
    return stream.getvalue()


def threemf(resources: str | None = None, items: str = '<item objectid="1"/>') -> bytes:
    model = model_3mf(object_3mf(1) if resources is None else resources, items)
    return package_3mf({"3D/3dmodel.model": model})


def collada(
    *,
    points: Points = CUBE_POINTS,
    faces: Faces = CUBE_QUADS,
    nodes: str = '<node id="n"><instance_geometry url="#g"/></node>',
    library_nodes: str = "",
    primitives: str | None = None,
    float_count: int | None = None,
    doctype: str = "",
) -> bytes:
    floats = " ".join(str(c) for point in points for c in point)
    count = 3 * len(points) if float_count is None else float_count
    corners = " ".join(str(i) for face in faces for i in face)
    sides = " ".join(str(len(face)) for face in faces)
    params = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    polylist = (
        f'<polylist count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/>'
        f"<vcount>{sides}</vcount><p>{corners}</p></polylist>"
    )
    return (
        f'<?xml version="1.0" encoding="utf-8"?>{doctype}<COLLADA xmlns="{_COLLADA}" '
        'version="1.4.1"><asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>'
        '<library_geometries><geometry id="g"><mesh><source id="s">'
        f'<float_array id="a" count="{count}">{floats}</float_array><technique_common>'
        f'<accessor source="#a" count="{len(points)}" stride="3">{params}</accessor>'
        '</technique_common></source><vertices id="v"><input semantic="POSITION" source="#s"/>'
        f"</vertices>{polylist if primitives is None else primitives}</mesh></geometry>"
        f"</library_geometries><library_nodes>{library_nodes}</library_nodes>"
        f'<library_visual_scenes><visual_scene id="S">{nodes}</visual_scene>'
        '</library_visual_scenes><scene><instance_visual_scene url="#S"/></scene></COLLADA>'
    ).encode()
