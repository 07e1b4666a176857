"""Write the sample meshes beside this file: `python sample_meshes/make.py`. Same bytes every time.

Standard library only. Coordinates are exact in every format here: halves, eighths and so on, or
rounded to six decimals before anything is written. What each mesh is for stands in index.json.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).parent
Point = tuple[float, float, float]
Face = tuple[int, ...]
DECIMALS = 6
# glTF 2.0: magic, chunk types, component types, buffer targets
GLB_MAGIC, GLB_JSON, GLB_BIN = 0x46546C67, 0x4E4F534A, 0x004E4942
FLOAT, UNSIGNED_SHORT, ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 5126, 5123, 34962, 34963


class Mesh(NamedTuple):
    """Faces are triangles or convex polygons, counter-clockwise from outside."""

    points: list[Point]
    faces: list[Face]

    def triangles(self) -> list[Face]:
        return [(f[0], f[i], f[i + 1]) for f in self.faces for i in range(1, len(f) - 1)]


# --- shapes -----------------------------------------------------------------------------------


def box(low: Point, high: Point) -> Mesh:
    points = [
        (x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])
    ]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return Mesh(points, list(faces))


def l_bracket() -> Mesh:
    """Two arms of 2 x 6 that share the corner at the origin, 4 high; the notch is x > 2, y > 2."""
    outline = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 6), (0, 6)]
    points: list[Point] = [(float(x), float(y), z) for z in (0.0, 4.0) for x, y in outline]
    top: list[Face] = [(3, 4, 5), (3, 5, 0), (3, 0, 1), (3, 1, 2)]
    faces = [tuple(reversed(face)) for face in top]
    faces += [tuple(6 + i for i in face) for face in top]
    faces += [(i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i) for i in range(6)]
    return Mesh(points, faces)


def tube(path: list[tuple[Point, Point]], radius: float, sides: int) -> Mesh:
    """A closed tube around a loop in the xy plane, given as (centre, outward unit normal)."""
    points: list[Point] = []
    for (x, y, z), (u, v, _) in path:
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            out, up = radius * math.cos(angle), radius * math.sin(angle)
            points.append((x + out * u, y + out * v, z + up))
    faces: list[Face] = []
    for i in range(len(path)):
        here, there = i * sides, (i + 1) % len(path) * sides
        for k in range(sides):
            turn = (k + 1) % sides
            faces.append((here + k, there + k, there + turn, here + turn))
    return rounded(Mesh(points, split(faces)))


def ring(radius: float, thickness: float, segments: int, sides: int) -> Mesh:
    angles = [2 * math.pi * i / segments for i in range(segments)]
    normals = [(math.cos(a), math.sin(a), 0.0) for a in angles]
    return tube(
        [((radius * u, radius * v, 0.0), (u, v, 0.0)) for u, v, _ in normals], thickness, sides
    )


def link(straight: float, bend: float, thickness: float, segments: int, sides: int) -> Mesh:
    """A chain link: two half circles of radius `bend`, `straight` apart along x."""
    path: list[tuple[Point, Point]] = []
    for centre, start in ((straight / 2, -math.pi / 2), (-straight / 2, math.pi / 2)):
        for i in range(segments + 1):
            angle = start + math.pi * i / segments
            u, v = math.cos(angle), math.sin(angle)
            path.append(((centre + bend * u, bend * v, 0.0), (u, v, 0.0)))
    return tube(path, thickness, sides)


def rod(radius: float, low: float, high: float, sides: int) -> Mesh:
    angles = [2 * math.pi * (k + 0.5) / sides for k in range(sides)]
    points = [(radius * math.cos(a), radius * math.sin(a), z) for z in (low, high) for a in angles]
    faces: list[Face] = [tuple(range(sides))[::-1], tuple(range(sides, 2 * sides))]
    faces += [(k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in range(sides)]
    return rounded(Mesh(points, faces))


def needle(tip: Point, length: float, half_width: float) -> Mesh:
    """A square pyramid that stands on its tip."""
    x, y, z = tip
    w, top = half_width, z + length
    points = [
        tip,
        (x - w, y - w, top),
        (x + w, y - w, top),
        (x + w, y + w, top),
        (x - w, y + w, top),
    ]
    return Mesh(points, [(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 1, 4), (1, 2, 3, 4)])


def split(faces: list[Face]) -> list[Face]:
    """Quads that need not be flat become two triangles."""
    return [triangle for a, b, c, d in faces for triangle in ((a, b, c), (a, c, d))]


def rounded(mesh: Mesh) -> Mesh:
    points = [(tidy(x), tidy(y), tidy(z)) for x, y, z in mesh.points]
    return mesh._replace(points=points)


def tidy(value: float) -> float:
    """The last bit of sin and cos differs between machines; no negative zero."""
    return round(value, DECIMALS) + 0.0


def moved(mesh: Mesh, move: Callable[[Point], Point]) -> Mesh:
    """A rigid motion, given as a function of a point."""
    return mesh._replace(points=[move(point) for point in mesh.points])


def with_fin(mesh: Mesh) -> Mesh:
    """One more triangle on the edge x = 2, z = 2 of a box: three faces meet in that edge."""
    edge = [i for i, (x, _, z) in enumerate(mesh.points) if (x, z) == (2.0, 2.0)]
    return Mesh(
        [*mesh.points, (4.0, 1.0, 2.0)], [*mesh.faces, (edge[0], len(mesh.points), edge[1])]
    )


def without_lid(mesh: Mesh) -> Mesh:
    top = max(z for _, _, z in mesh.points)
    faces = [face for face in mesh.faces if any(mesh.points[i][2] != top for i in face)]
    return mesh._replace(faces=faces)


def turned_inside_out(mesh: Mesh) -> Mesh:
    return mesh._replace(faces=[face[::-1] for face in mesh.faces])


# --- formats ----------------------------------------------------------------------------------


def obj(mesh: Mesh, form: str = ".12g") -> bytes:
    """The digits written are the precision that a reader may assume."""
    lines = [f"v {x:{form}} {y:{form}} {z:{form}}" for x, y, z in mesh.points]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in mesh.faces]
    return ("\n".join(lines) + "\n").encode()


def off(mesh: Mesh) -> bytes:
    lines = ["OFF", f"{len(mesh.points)} {len(mesh.faces)} 0"]
    lines += [f"{x:.12g} {y:.12g} {z:.12g}" for x, y, z in mesh.points]
    lines += [" ".join(str(i) for i in (len(face), *face)) for face in mesh.faces]
    return ("\n".join(lines) + "\n").encode()


def stl(mesh: Mesh) -> bytes:
    out = [b"satcheck sample, binary STL".ljust(80), struct.pack("<I", len(mesh.triangles()))]
    for triangle in mesh.triangles():
        corners = [mesh.points[i] for i in triangle]
        out.append(struct.pack("<12fH", *normal(corners), *(c for p in corners for c in p), 0))
    return b"".join(out)


def stl_text(mesh: Mesh) -> bytes:
    lines = ["solid sample"]
    for triangle in mesh.triangles():
        corners = [mesh.points[i] for i in triangle]
        lines.append("facet normal {:g} {:g} {:g}".format(*normal(corners)))
        lines.append("  outer loop")
        lines += ["    vertex {:.12g} {:.12g} {:.12g}".format(*corner) for corner in corners]
        lines += ["  endloop", "endfacet"]
    return ("\n".join([*lines, "endsolid sample"]) + "\n").encode()


def ply(mesh: Mesh) -> bytes:
    """Binary, double precision."""
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(mesh.points)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    body = b"".join(struct.pack("<3d", *point) for point in mesh.points)
    body += b"".join(struct.pack(f"<B{len(f)}i", len(f), *f) for f in mesh.faces)
    return head.encode() + body


def glb(mesh: Mesh) -> bytes:
    points = b"".join(struct.pack("<3f", *point) for point in mesh.points)
    indices = b"".join(struct.pack("<3H", *t) for t in mesh.triangles())
    single = [struct.unpack_from("<3f", points, 12 * i) for i in range(len(mesh.points))]
    document = {
        "asset": {"version": "2.0", "generator": "satcheck sample_meshes/make.py"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(points) + len(padded(indices, b"\0"))}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(points), "target": ARRAY_BUFFER},
            {
                "buffer": 0,
                "byteOffset": len(points),
                "byteLength": len(indices),
                "target": ELEMENT_ARRAY_BUFFER,
            },
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": FLOAT,
                "count": len(mesh.points),
                "type": "VEC3",
                "min": [min(axis) for axis in zip(*single, strict=True)],
                "max": [max(axis) for axis in zip(*single, strict=True)],
            },
            {
                "bufferView": 1,
                "componentType": UNSIGNED_SHORT,
                "count": 3 * len(mesh.triangles()),
                "type": "SCALAR",
            },
        ],
    }
    head = padded(json.dumps(document, separators=(",", ":")).encode(), b" ")
    body = padded(points + indices, b"\0")
    total = 12 + 8 + len(head) + 8 + len(body)
    return b"".join(
        [
            struct.pack("<3I", GLB_MAGIC, 2, total),
            struct.pack("<2I", len(head), GLB_JSON) + head,
            struct.pack("<2I", len(body), GLB_BIN) + body,
        ]
    )


def padded(data: bytes, filler: bytes) -> bytes:
    return data + filler * (-len(data) % 4)


def normal(corners: list[Point]) -> Point:
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    n = (uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)
    size = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    return (tidy(n[0] / size), tidy(n[1] / size), tidy(n[2] / size))


# --- the samples ------------------------------------------------------------------------------


def samples() -> dict[str, bytes]:
    """File name to content."""
    big_box = box((0.0, 0.0, 0.0), (2.0, 2.0, 2.0))
    chain = link(straight=3.0, bend=1.0, thickness=0.3, segments=8, sides=8)
    e, n = 4_000_000.0, 5_000_000.0
    return {
        "box.obj": obj(big_box),
        "box_pushed.stl": stl(box((1.0, 0.25, 0.5), (3.0, 2.25, 2.5))),
        "box_flush.stl": stl_text(box((2.0, 0.5, 0.5), (4.0, 1.5, 1.5))),
        "cube.off": off(box((2.5, 0.5, 1.5), (3.5, 1.5, 2.5))),
        "l_bracket.obj": obj(l_bracket()),
        "peg_in_notch.ply": ply(box((3.0, 3.0, 1.0), (5.0, 5.0, 3.0))),
        "peg_in_arm.ply": ply(box((1.5, 3.0, 1.0), (3.5, 5.0, 3.0))),
        "seed_in_arm.stl": stl(box((0.25, 4.0, 1.0), (1.25, 5.0, 2.0))),
        "ring.glb": glb(ring(radius=2.0, thickness=0.5, segments=24, sides=12)),
        "rod.stl": stl_text(rod(radius=0.5, low=-3.0, high=3.0, sides=12)),
        "link_a.ply": ply(chain),
        "link_b.glb": glb(moved(chain, lambda p: (p[0] + 4.0, -p[2] + 0.0, p[1]))),
        "needle.stl": stl(needle(tip=(1.25, 0.75, 1.75), length=20.0, half_width=1 / 128)),
        "far_a.obj": obj(box((e, n, 0.0), (e + 1, n + 1, 1.0)), ".3f"),
        "far_b.obj": obj(box((e + 0.875, n + 0.25, 0.25), (e + 1.875, n + 1.25, 1.25)), ".3f"),
        "fin_box.obj": obj(with_fin(big_box)),
        "open_box.off": off(without_lid(box((1.0, -1.0, 1.0), (5.0, 3.0, 4.0)))),
        "arm_beam.stl": stl(box((-1 / 16, -1 / 16, 0.0), (1 / 16, 1 / 16, 1.0))),
        "arm_finger.obj": obj(box((-1 / 32, 0.0, 0.0), (1 / 32, 1 / 32, 0.25))),
        "inside_out.stl": stl_text(turned_inside_out(box((-1.5, 0.25, 0.5), (0.5, 1.25, 1.5)))),
    }


def main() -> None:
    for name, content in samples().items():
        (HERE / name).write_bytes(content)


if __name__ == "__main__":
    main()
