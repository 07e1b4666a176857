"""Meshes with sheets and holes, and what a check says about a pair of them."""

from __future__ import annotations

from satcheck.audit import Settings, check
from tests.audit.shapes import (
    Mesh,
    scene_of,
    unit_box,
)

SQUARE: Mesh = ([(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)], [(0, 1, 2, 3)])


def only(report):
    (finding,) = report.findings
    return finding


def relation(folder, a: Mesh, b: Mesh, **settings):
    finding = only(check(scene_of(folder, a=a, b=b), Settings(**settings)))
    assert finding.quality in ("exact", "bounded", None)
    return finding.relation


def together(*meshes: Mesh) -> Mesh:
    points, faces = [], []
    for more_points, more_faces in meshes:
        faces += [tuple(len(points) + k for k in face) for face in more_faces]
        points += more_points
    return points, faces


def triangulated(mesh: Mesh) -> Mesh:
    points, faces = mesh
    return points, [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]


def without(mesh: Mesh, *triangles: int) -> Mesh:
    points, faces = triangulated(mesh)
    return points, [face for k, face in enumerate(faces) if k not in triangles]


def with_reverse(mesh: Mesh) -> Mesh:
    points, faces = mesh
    return points, [*faces, *(face[::-1] for face in faces)]


DOUBLE = with_reverse(SQUARE)


SHEET_AND_BOX = together(DOUBLE, unit_box(20))


def inverted(mesh: Mesh) -> Mesh:
    points, faces = mesh
    return points, [face[::-1] for face in faces]


def split_square(axis: int, at: float) -> Mesh:
    """A face of a box of edge 4, wound outward, with a vertex on each of its edges."""
    t = 1 + axis / 2 + at / 8
    corners = [(0, 0), (t, 0), (4, 0), (4, t), (4, 4), (4 - t, 4), (0, 4), (0, 4 - t)]
    points = []
    for u, v in corners if at else corners[::-1]:
        point = [0.0, 0.0, 0.0]
        point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = at, u, v
        points.append((point[0], point[1], point[2]))
    return points, [tuple(range(8))]
