"""Write the samples that hold several bodies: `python -m sample_meshes.hierarchies`.

A GLB file with a hierarchy of nodes, and a 3MF package with components. Same bytes every time.
"""

from __future__ import annotations

import io
import json
import struct
import zipfile
from typing import Any

from sample_meshes.make import (
    ARRAY_BUFFER,
    ELEMENT_ARRAY_BUFFER,
    FLOAT,
    GLB_BIN,
    GLB_JSON,
    GLB_MAGIC,
    HERE,
    UNSIGNED_SHORT,
    Face,
    Mesh,
    Point,
    box,
    padded,
)

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
START = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
RELATIONSHIPS = "http://schemas.openxmlformats.org/package/2006/relationships"
CONTENT_TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
MODEL_TYPE = "application/vnd.ms-package.3dmanufacturing-3dmodel+xml"
RELATIONSHIPS_TYPE = "application/vnd.openxmlformats-package.relationships+xml"


def finger() -> Mesh:
    """An L that hangs from z = 0, 0.5 thick, its claw towards +x."""
    outline = [(0.0, 0.0), (0.5, 0.0), (0.5, -2.0), (1.0, -2.0), (1.0, -3.0), (0.0, -3.0)]
    points: list[Point] = [(x, y, z) for y in (-0.5, 0.5) for x, z in outline]
    front: list[Face] = [(0, 3, 2), (0, 2, 1), (0, 4, 3), (0, 5, 4)]
    faces = [*front, *((6 + c, 6 + b, 6 + a) for a, b, c in front)]
    faces += [((i + 1) % 6, 6 + (i + 1) % 6, 6 + i, i) for i in range(6)]
    return Mesh(points, faces)


def gripper() -> bytes:
    """Nodes of one mesh, one of them mirrored, under a node without a mesh."""
    meshes = {
        "palm": box((-2.0, -1.0, 0.0), (2.0, 1.0, 1.0)),
        "finger": finger(),
        "payload": box((-1.75, -0.25, 2.0), (1.5, 0.25, 3.5)),
    }
    nodes: list[dict[str, Any]] = [
        {"name": "gripper", "translation": [0, 0, 4], "children": [1, 2, 3]},
        {"name": "palm", "mesh": 0},
        {"name": "left", "mesh": 1, "translation": [-2, 0, 0]},
        {"name": "right", "mesh": 1, "translation": [2, 0, 0], "scale": [-1, 1, 1]},
        {"name": "payload", "mesh": 2},
    ]
    return glb(meshes, nodes, [0, 4])


def glb(meshes: dict[str, Mesh], nodes: list[dict[str, Any]], roots: list[int]) -> bytes:
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    chunks: list[bytes] = []
    for mesh in meshes.values():
        points = [struct.pack("<3f", *point) for point in mesh.points]
        single = [struct.unpack("<3f", point) for point in points]
        corners = [corner for triangle in mesh.triangles() for corner in triangle]
        accessors += [
            {
                "bufferView": len(views),
                "componentType": FLOAT,
                "count": len(points),
                "type": "VEC3",
                "min": [min(axis) for axis in zip(*single, strict=True)],
                "max": [max(axis) for axis in zip(*single, strict=True)],
            },
            {
                "bufferView": len(views) + 1,
                "componentType": UNSIGNED_SHORT,
                "count": len(corners),
                "type": "SCALAR",
            },
        ]
        indices = struct.pack(f"<{len(corners)}H", *corners)
        both = (b"".join(points), ARRAY_BUFFER), (indices, ELEMENT_ARRAY_BUFFER)
        for content, target in both:
            start = sum(map(len, chunks))
            view = {"buffer": 0, "byteOffset": start, "byteLength": len(content), "target": target}
            views.append(view)
            chunks.append(padded(content, b"\0"))
    document = {
        "asset": {"version": "2.0", "generator": "satcheck sample_meshes/hierarchies.py"},
        "scene": 0,
        "scenes": [{"nodes": roots}],
        "nodes": nodes,
        "meshes": [
            {
                "name": name,
                "primitives": [{"attributes": {"POSITION": 2 * k}, "indices": 2 * k + 1}],
            }
            for k, name in enumerate(meshes)
        ],
        "buffers": [{"byteLength": sum(map(len, chunks))}],
        "bufferViews": views,
        "accessors": accessors,
    }
    head = padded(json.dumps(document, separators=(",", ":")).encode(), b" ")
    body = b"".join(chunks)
    return b"".join(
        [
            struct.pack("<3I", GLB_MAGIC, 2, 12 + 8 + len(head) + 8 + len(body)),
            struct.pack("<2I", len(head), GLB_JSON) + head,
            struct.pack("<2I", len(body), GLB_BIN) + body,
        ]
    )


def rack() -> bytes:
    """Two build items: a rack of components, one of them twice, and a crate in its tray."""
    resources = [
        mesh_object(1, "post", box((0.0, 0.0, 0.0), (1.0, 1.0, 3.0))),
        mesh_object(2, "tray", box((0.0, 0.0, 0.0), (4.0, 4.0, 1.0))),
        '<object id="3" name="rack"><components><component objectid="1"/>'
        '<component objectid="1" transform="1 0 0 0 1 0 0 0 1 3 3 0"/>'
        '<component objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 3"/></components></object>',
        mesh_object(4, "crate", box((0.0, 0.0, 0.0), (2.0, 2.0, 2.0))),
    ]
    model = (
        f'<model unit="millimeter" xmlns="{CORE}"><resources>{"".join(resources)}</resources>'
        '<build><item objectid="3"/>'
        '<item objectid="4" transform="0 1 0 -1 0 0 0 0 1 3 1 3.5"/></build></model>'
    )
    relationship = f'<Relationship Id="rel0" Type="{START}" Target="/3D/3dmodel.model"/>'
    types = (
        f'<Default Extension="rels" ContentType="{RELATIONSHIPS_TYPE}"/>'
        f'<Default Extension="model" ContentType="{MODEL_TYPE}"/>'
    )
    return package(
        {
            "[Content_Types].xml": f'<Types xmlns="{CONTENT_TYPES}">{types}</Types>',
            "_rels/.rels": (
                f'<Relationships xmlns="{RELATIONSHIPS}">{relationship}</Relationships>'
            ),
            "3D/3dmodel.model": model,
        }
    )


def mesh_object(number: int, name: str, mesh: Mesh) -> str:
    vertices = "".join('<vertex x="{:g}" y="{:g}" z="{:g}"/>'.format(*p) for p in mesh.points)
    triangles = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*t) for t in mesh.triangles())
    return (
        f'<object id="{number}" name="{name}" type="model"><mesh><vertices>{vertices}</vertices>'
        f"<triangles>{triangles}</triangles></mesh></object>"
    )


def package(parts: dict[str, str]) -> bytes:
    """A zip archive without compression and without the time of day."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, text in parts.items():
            archive.writestr(
                zipfile.ZipInfo(name), '<?xml version="1.0" encoding="UTF-8"?>\n' + text
            )
    return stream.getvalue()


def samples() -> dict[str, bytes]:
    """File name to content."""
    return {"gripper.glb": gripper(), "rack.3mf": rack()}


def main() -> None:
    for name, content in samples().items():
        (HERE / name).write_bytes(content)


if __name__ == "__main__":
    main()
