"""Draw docs/axes.svg: `python -m docs.axes`; and what docs/laboratory.md says of round bodies."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from bench.drawing import write_both
from satcheck.audit.axes import axes_of
from satcheck.cli.formats.axes_plot import draw
from satcheck.core import Mesh
from satcheck.report.axes import AxesReport
from satcheck.scene import load_scene

HERE = Path(__file__).parent
SCENE = HERE.parent / "sample_meshes" / "crossed_edges.toml"
VERTICES = 1000
# Of two round bodies of radius 1: they overlap by about half a radius.
OFFSET = 1.5


def main() -> None:
    report = axes_of(load_scene([SCENE]))
    write_both(HERE / "axes.svg", lambda dark: draw(report, dark=dark))


def growth() -> str:
    """What docs/laboratory.md says of two round bodies."""
    counts = (report := of_round_bodies()).counts
    return (
        f"two bodies of {VERTICES:,} vertices have {counts.distinct:,}, against {report.gjk_steps} "
        "steps of GJK and EPA"
    )


def of_round_bodies() -> AxesReport:
    """The axes of two hulls of points that are spread at random on two spheres."""
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{name}.obj" for name in "ab"]
        for path, x in zip(paths, (0.0, OFFSET), strict=True):
            points = rng.normal(size=(VERTICES, 3))
            points /= np.linalg.norm(points, axis=1)[:, None]
            path.write_text(_obj(points + np.array([x, 0.0, 0.0])), encoding="utf-8")
        return axes_of(load_scene(paths))


def _obj(points: np.ndarray) -> str:
    hull = Mesh(points, np.zeros((1, 3), dtype=np.uint32)).convex_hull()
    corners = ["v " + " ".join(map(repr, point)) for point in np.asarray(hull.vertices).tolist()]
    faces = [f"f {i + 1} {j + 1} {k + 1}" for i, j, k in np.asarray(hull.triangles).tolist()]
    return "\n".join((*corners, *faces, ""))


if __name__ == "__main__":
    main()
