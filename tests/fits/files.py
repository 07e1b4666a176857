"""Files of fits: turned into place by their vertices, or by a node of a glTF file or a joint of a
robot.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import NamedTuple

from tests.fits.solids import Point, Solid

Matrix = tuple[Point, Point, Point]


class Placing(NamedTuple):
    """roll, pitch, yaw: about x, then y, then z, all fixed."""

    angles: Point
    shift: Point

    @property
    def matrix(self) -> Matrix:
        (sr, sp, sy), (cr, cp, cy) = map(math.sin, self.angles), map(math.cos, self.angles)
        return (
            (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            (-sp, cp * sr, cp * cr),
        )

    def of(self, p: Point) -> Point:
        x, y, z = (
            sum(m * c for m, c in zip(row, p, strict=True)) + t
            for row, t in zip(self.matrix, self.shift, strict=True)
        )
        return x, y, z


def placing(rng: Random, size: float) -> Placing:
    """Any turn, or one of whole steps of 15 degrees; as far off as it is large, up to 30 times."""
    step = math.pi / 12
    turns = [
        rng.uniform(-3, 3) if rng.random() < 0.5 else step * rng.randrange(-6, 7) for _ in "123"
    ]
    far = size * rng.choice([0.0, 1.0, 30.0])
    x, y, z = (rng.uniform(-far, far) for _ in "123")
    return Placing((turns[0], turns[1], turns[2]), (x, y, z))


def placed(solid: Solid, by: Placing) -> Solid:
    return Solid([by.of(p) for p in solid.vertices], solid.triangles)


def scaled(solid: Solid, factor: float) -> Solid:
    return Solid(
        [(factor * x, factor * y, factor * z) for x, y, z in solid.vertices], solid.triangles
    )


def stl(path: Path, solid: Solid) -> None:
    data = bytearray(80) + struct.pack("<I", len(solid.triangles))
    for triangle in solid.triangles:
        corners = (c for i in triangle for c in solid.vertices[i])
        data += struct.pack("<12fH", 0, 0, 0, *corners, 0)
    path.write_bytes(data)


def obj(path: Path, solid: Solid, decimals: int | None = None) -> None:
    """decimals: of each number; None: all digits of float64."""
    as_text = repr if decimals is None else f"{{:.{decimals}f}}".format
    lines = ["v " + " ".join(map(as_text, p)) for p in solid.vertices]
    lines += ["f " + " ".join(str(i + 1) for i in t) for t in solid.triangles]
    path.write_text("\n".join(lines) + "\n")


def quaternion(by: Placing) -> list[float]:
    """x, y, z, w."""
    (sr, sp, sy), (cr, cp, cy) = (
        [f(angle / 2) for angle in by.angles] for f in (math.sin, math.cos)
    )
    return [
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    ]


def glb(path: Path, solid: Solid, by: Placing | None = None) -> None:
    """by: the node places the mesh."""
    positions = b"".join(struct.pack("<3f", *p) for p in solid.vertices)
    indices = b"".join(struct.pack("<3I", *t) for t in solid.triangles)
    rounded = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in solid.vertices]
    node = {"mesh": 0, "name": path.stem}
    if by is not None:
        node |= {"rotation": quaternion(by), "translation": list(by.shift)}
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": len(solid.vertices),
                "type": "VEC3",
                "min": [min(p[i] for p in rounded) for i in range(3)],
                "max": [max(p[i] for p in rounded) for i in range(3)],
            },
            {
                "bufferView": 1,
                "componentType": 5125,
                "count": 3 * len(solid.triangles),
                "type": "SCALAR",
            },
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(positions)},
            {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices)},
        ],
        "buffers": [{"byteLength": len(positions) + len(indices)}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data = positions + indices
    path.write_bytes(
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data))
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(data), b"BIN\0")
        + data
    )


def urdf(path: Path, names: tuple[str, str], by: tuple[Placing, Placing]) -> None:
    links, joints = ['<link name="world"/>'], []
    for name, place in zip(names, by, strict=True):
        mesh = f'<geometry><mesh filename="{name}.stl"/></geometry>'
        links.append(f'<link name="{name}"><collision>{mesh}</collision></link>')
        xyz, rpy = (" ".join(map(repr, values)) for values in (place.shift, place.angles))
        joints.append(
            f'<joint name="to_{name}" type="fixed"><parent link="world"/><child link="{name}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/></joint>'
        )
    path.write_text(f'<robot name="fit">{"".join(links)}{"".join(joints)}</robot>\n')


Written = tuple[str, ...]  # the arguments of a check
Writer = Callable[[Path, tuple[Solid, Solid], Placing, Random], Written]


def _in_place(write: Callable[[Path, Solid], None], suffix: str) -> Writer:
    def written(folder: Path, solids: tuple[Solid, Solid], by: Placing, _: Random) -> Written:
        for name, solid in zip("ab", solids, strict=True):
            write(folder / f"{name}.{suffix}", placed(solid, by))
        return f"a.{suffix}", f"b.{suffix}"

    return written


def _rounded(folder: Path, solids: tuple[Solid, Solid], by: Placing, rng: Random) -> Written:
    """Decimals as exporters write them. They may be coarser than float32, which is the coarsest
    that satcheck takes them for by default: then the tolerance is stated."""
    size = max(abs(c) for solid in solids for p in placed(solid, by).vertices for c in p)
    more = rng.choice([0, 0, 2, 4, 7])
    decimals = max(1, 7 - math.ceil(math.log10(size))) + more
    for name, solid in zip("ab", solids, strict=True):
        obj(folder / f"{name}.obj", placed(solid, by), decimals)
    return "a.obj", "b.obj", *([] if more else ["--tolerance", repr(2 * 10.0**-decimals)])


def _by_nodes(folder: Path, solids: tuple[Solid, Solid], by: Placing, _: Random) -> Written:
    for name, solid in zip("ab", solids, strict=True):
        glb(folder / f"{name}.glb", solid, by)
    return "a.glb", "b.glb"


def _by_joints(folder: Path, solids: tuple[Solid, Solid], by: Placing, rng: Random) -> Written:
    """The second mesh in a frame of its own, shifted along the axes."""
    own = Placing((0.0, 0.0, 0.0), (rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)))
    back = by.of(tuple(-c for c in own.shift))  # type: ignore[arg-type]
    stl(folder / "a.stl", solids[0])
    stl(folder / "b.stl", placed(solids[1], own))
    urdf(folder / "fit.urdf", ("a", "b"), (by, Placing(by.angles, back)))
    return ("fit.urdf",)


def _by_same_joints(folder: Path, solids: tuple[Solid, Solid], by: Placing, _: Random) -> Written:
    for name, solid in zip("ab", solids, strict=True):
        stl(folder / f"{name}.stl", solid)
    urdf(folder / "fit.urdf", ("a", "b"), (by, by))
    return ("fit.urdf",)


FORMATS: dict[str, Writer] = {
    "stl": _in_place(stl, "stl"),
    "glb": _in_place(glb, "glb"),
    "glb-node": _by_nodes,
    "urdf": _by_joints,
    "urdf-same": _by_same_joints,
    "obj": _in_place(obj, "obj"),
    "obj-rounded": _rounded,
}
