"""Draw docs/kettle_and_snowflake.png: `python -m docs.kettle_and_snowflake`.

Three views of the same meshes: where they are, where the deepest pair of convex parts pushes the
kettle, and where satcheck moves it. Triangles of the snowflake that are not clear of it are red.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.image import imsave
from numpy.typing import NDArray

from sample_meshes.kitchen import kettle_parts, snowflake_parts
from satcheck import core
from satcheck.audit import check
from satcheck.scene import load_scene

Floats = NDArray[np.float64]

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "sample_meshes"
FILES = [SAMPLES / "kettle.obj", SAMPLES / "snowflake.obj"]

SIZE, MARGIN, FINER = 360, 0.04, 2
EYE, UP = np.array([0.75, -1.0, 0.55]), np.array([0.0, 0.0, 1.0])
LIGHT = np.array([0.35, -0.6, 0.7])
PAPER, COPPER, ICE, RED = (255, 255, 255), (196, 128, 84), (120, 170, 214), (214, 40, 40)


def translations() -> list[tuple[float, float, float]]:
    """None, out of the deepest pair of parts, and the translation that satcheck verified."""
    parts = [[core.Hull(np.array(p)) for p in of] for of in (kettle_parts(), snowflake_parts())]
    results = [core.check_pair(p, q, query="depth") for p in parts[0] for q in parts[1]]
    deepest = min(
        (p for p in results if p.outcome == "penetrating"), key=lambda p: p.distance or 0.0
    )
    (finding,) = check(FILES).findings
    if deepest.normal is None or deepest.distance is None or finding.mtv is None:
        raise AssertionError("the samples overlap")
    x, y, z = (deepest.distance * c for c in deepest.normal)
    return [(0.0, 0.0, 0.0), (x, y, z), finding.mtv]


def corners(mesh: core.Mesh) -> Floats:
    triangles: Floats = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    return triangles


def colliding(flake: Floats, kettle: core.Mesh) -> list[bool]:
    """Per triangle of the snowflake: does it share more than a touch with the kettle?"""
    solid = core.Surface(kettle, True)
    triangle = np.array([[0, 1, 2]], dtype=np.uint32)
    return [
        core.mesh_relation(core.Surface(core.Mesh(t, triangle), False), solid).relation
        not in ("separated", "touching")
        for t in flake
    ]


def camera() -> Floats:
    """Rows: right, up, towards the eye."""
    towards = EYE / np.linalg.norm(EYE)
    right = np.cross(UP, towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def drawn(triangles: Floats, colours: Floats, low: Floats, scale: float) -> Floats:
    """An image (SIZE, SIZE, 3) by a depth buffer, drawn finer and averaged."""
    pixels = SIZE * FINER
    image = np.full((pixels, pixels, 3), PAPER, dtype=float)
    depth = np.full((pixels, pixels), -np.inf)
    seen = triangles @ camera().T
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    shade = 0.45 + 0.55 * np.abs(normals @ (LIGHT / np.linalg.norm(LIGHT)))
    flat = (seen[:, :, :2] - low) * scale * FINER
    for (p, q, r), z, colour in zip(flat, seen[:, :, 2], colours * shade[:, None], strict=True):
        left, bottom = np.floor(np.minimum(np.minimum(p, q), r)).astype(int).clip(0)
        right, top = np.ceil(np.maximum(np.maximum(p, q), r)).astype(int).clip(0, pixels)
        area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        if area == 0 or left >= right or bottom >= top:
            continue
        y, x = np.mgrid[bottom:top, left:right] + 0.5
        u = ((q[0] - x) * (r[1] - y) - (q[1] - y) * (r[0] - x)) / area
        v = ((r[0] - x) * (p[1] - y) - (r[1] - y) * (p[0] - x)) / area
        height = u * z[0] + v * z[1] + (1 - u - v) * z[2]
        window = (slice(bottom, top), slice(left, right))
        nearer = (u >= 0) & (v >= 0) & (u + v <= 1) & (height > depth[window])
        depth[window][nearer] = height[nearer]
        image[window][nearer] = colour
    averaged: Floats = image.reshape(SIZE, FINER, SIZE, FINER, 3).mean(axis=(1, 3))[::-1]
    return averaged


def main() -> None:
    kettle, snowflake = (body.file.mesh for body in load_scene(FILES).bodies)
    moved = [kettle.translated(t) for t in translations()]
    everything = np.concatenate([corners(mesh) for mesh in (*moved, snowflake)]) @ camera().T
    low, high = everything.reshape(-1, 3).min(axis=0)[:2], everything.reshape(-1, 3).max(axis=0)[:2]
    extent = (high - low).max() * (1 + 2 * MARGIN)
    low = (low + high - extent) / 2
    flake = corners(snowflake)
    views = []
    for mesh in moved:
        body = corners(mesh)
        colours = [COPPER] * len(body) + [RED if hit else ICE for hit in colliding(flake, mesh)]
        triangles = np.concatenate([body, flake])
        views.append(drawn(triangles, np.array(colours, dtype=float), low, SIZE / extent))
    pixels = np.concatenate(views, axis=1).round().astype(np.uint8)
    imsave(HERE / "kettle_and_snowflake.png", pixels)


if __name__ == "__main__":
    main()
