"""The prism over a flat region.

All prisms of a check reach farther above and below the plane than any of them is wide. Two prisms
therefore overlap or touch exactly if their regions do. They also have the same depth as the
regions: a translation that separates them separates the regions or is as long as the prisms are
high, and a translation that separates the regions needs no third component. All heights differ, so
only walls can touch, never the ends.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from satcheck.core import Mesh
from satcheck.scene.planar.turns import Floats, Indices


def prism(points: Floats, triangles: Indices, height: float) -> Mesh:
    """The closed mesh, |z| <= height, over signed triangles in the plane, (n, 2) and (m, 3).

    Its winding number at a point between its ends is the sum of the signs of the triangles below
    that point. Walls stand on the boundary edges. They are not welded.
    """
    count = len(points)
    ground = np.column_stack((points, np.full(count, -height)))
    roof = np.column_stack((points, np.full(count, height)))
    walls = _walls(triangles, count)
    faces = np.concatenate((triangles[:, ::-1], triangles + count, walls))
    return Mesh(np.concatenate((ground, roof)), faces.astype(np.uint32))


def _walls(triangles: Indices, roof: int) -> Indices:
    edges: Counter[tuple[int, int]] = Counter()
    for a, b, c in triangles.tolist():
        edges.update(((a, b), (b, c), (c, a)))
    walls = [
        face
        for (a, b), times in edges.items()
        for _ in range(times - edges.get((b, a), 0))
        for face in ((a, b, b + roof), (a, b + roof, a + roof))
    ]
    return np.array(walls, dtype=np.int64).reshape(-1, 3)
