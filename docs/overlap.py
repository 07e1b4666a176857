"""Draw docs/overlap.svg and its dark twin: `python -m docs.overlap`.

Two sample meshes that overlap, their common volume in red, and the shortest way out as an arrow;
dashed: where it takes the upper faces of A.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bench.drawing import write_both
from satcheck.audit import check
from satcheck.cli.plotting import POINTS_PER_INCH, style
from satcheck.core import Mesh
from satcheck.scene import load_scene

Floats = NDArray[np.float64]

HERE = Path(__file__).parent
FILES = [HERE.parent / "sample_meshes" / name for name in ("l_bracket.obj", "peg_in_arm.ply")]
SIZE = (640.0, 420.0)  # points
TO_EYE, TO_LIGHT = np.array([0.25, -0.75, 1.3]), np.array([0.2, -0.45, 1.0])
# In the units of the files, z up.
ARROW_AT = np.array([0.0, 4.0, 4.0])
NAMES = {"A": (4.5, 1.0, 4.0), "B": (3.0, 4.0, 3.0), "common\nvolume": (0.8, 2.9, 4.0)}
BLUE, AMBER = ("#2f6fbf", "#4a90e2"), ("#c98500", "#e3b341")  # on light and on dark paper
RED = ("#d62828", "#ff5a5a")


def camera() -> Floats:
    """Rows: right, up, towards the eye."""
    towards = TO_EYE / np.linalg.norm(TO_EYE)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def seen(points: Floats) -> Floats:
    """(n, 3) to (n, 2): right and up."""
    flat: Floats = np.atleast_2d(points) @ camera()[:2].T
    return flat


def common(a: Mesh, b: Mesh) -> Mesh:
    """The common volume, by manifold3d."""
    solids = [
        manifold3d.Manifold(
            manifold3d.Mesh64(np.array(mesh.vertices), np.array(mesh.triangles, dtype=np.uint64))
        )
        for mesh in (a, b)
    ]
    mesh = (solids[0] ^ solids[1]).to_mesh64()
    triangles = np.array(mesh.tri_verts, dtype=np.uint32)
    return Mesh(np.array(mesh.vert_properties[:, :3], dtype=np.float64), triangles)


def faces(mesh: Mesh) -> Iterator[tuple[Floats, Floats]]:
    """Triangles of one plane as one polygon (n, 3), and its outer normal; faces have no holes."""
    vertices, triangles = np.array(mesh.vertices), np.array(mesh.triangles)
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    planes = np.column_stack([normals, (normals * corners[:, 0]).sum(axis=1)]).round(9)
    for plane in np.unique(planes, axis=0):
        rows = triangles[(planes == plane).all(axis=1)].tolist()
        edges = Counter((row[k], row[(k + 1) % 3]) for row in rows for k in range(3))
        following = {tail: head for tail, head in edges if (head, tail) not in edges}
        loop = [next(iter(following))]
        while following[loop[-1]] != loop[0]:
            loop.append(following[loop[-1]])
        yield vertices[loop], plane[:3]


def fill(axes: Axes, mesh: Mesh, colour: str, alpha: float) -> None:
    """The faces that look towards the eye."""
    rgb = np.array([int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)])
    for polygon, normal in faces(mesh):
        if normal @ TO_EYE > 0:
            bright = 0.7 + 0.3 * max(normal @ TO_LIGHT / np.linalg.norm(TO_LIGHT), 0.0)
            shade = (*(bright * rgb), alpha)
            axes.fill(*seen(polygon).T, facecolor=shade, edgecolor=colour, linewidth=1.3)


def draw(dark: bool) -> Figure:
    a, b = (body.file.mesh for body in load_scene(FILES).bodies)
    (finding,) = check(FILES).findings
    assert finding.mtv is not None
    mtv = np.array(finding.mtv)
    with style(dark=dark) as palette:
        figure = Figure((SIZE[0] / POINTS_PER_INCH, SIZE[1] / POINTS_PER_INCH))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), aspect="equal")
        axes.set_axis_off()
        ghost: dict[str, Any] = {"fill": False, "edgecolor": palette.faint, "linestyle": "--"}
        for polygon in (polygon for polygon, normal in faces(a) if normal[2] > 0):
            axes.fill(*seen(polygon + mtv).T, **ghost)
        fill(axes, a, palette.paper, 1.0)
        fill(axes, b, AMBER[dark], 0.8)
        fill(axes, a, BLUE[dark], 0.45)
        fill(axes, common(a, b), RED[dark], 0.9)
        _write(axes, mtv, RED[dark])
    return figure


def _write(axes: Axes, mtv: Floats, colour: str) -> None:
    """The arrow, and the words."""
    start, end = seen(np.array([ARROW_AT, ARROW_AT + mtv]))
    arrow: dict[str, Any] = {"arrowstyle": "-|>", "lw": 3.5, "mutation_scale": 17}
    arrow |= {"color": colour, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", end, start, arrowprops=arrow)
    beside: dict[str, Any] = {"xytext": (-8, 8), "textcoords": "offset points"}
    way_out = "the way out:\nmove A by ({:g}, {:g}, {:g})".format(*mtv)
    axes.annotate(way_out, end, **beside, ha="right", va="bottom", size=14)
    for words, place in NAMES.items():
        x, y = seen(np.array(place))[0]
        axes.text(x, y, words, ha="center", va="center", size=13)


def main() -> None:
    write_both(HERE / "overlap.svg", draw)


if __name__ == "__main__":
    main()
