"""Draw docs/axes.svg and write the table of docs/laboratory.md: `python -m docs.axes`."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
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
VERTICES = (10, 100, 1000)
# Of two round bodies of radius 1: they overlap by about half a radius.
OFFSET = 1.5
HEAD = """| vertices of each body | candidates | axes to test | steps of GJK and EPA |
|---|---|---|---|
"""


def main() -> None:
    report = axes_of(load_scene([SCENE]))
    write_both(HERE / "axes.svg", lambda dark: draw(report, dark=dark))
    page = (HERE / "laboratory.md").read_text(encoding="utf-8")
    before, rest = page.split(HEAD)
    after = rest[rest.index("\n\n") :]
    (HERE / "laboratory.md").write_text(
        before + HEAD + "\n".join(growth()) + after, encoding="utf-8"
    )


def growth() -> list[str]:
    """A row for each pair of round bodies: vertices, candidates, axes to test, steps of GJK."""
    rows = []
    for vertices, report in zip(VERTICES, round_bodies(), strict=True):
        counts = report.counts
        cells = (vertices, counts.candidates, counts.distinct, report.gjk_steps or 0)
        rows.append(f"| {' | '.join(f'{cell:,}' for cell in cells)} |")
    return rows


def round_bodies() -> Iterator[AxesReport]:
    """Pairs of hulls of points that are spread at random on two spheres."""
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        for vertices in VERTICES:
            paths = [Path(folder) / f"{name}.obj" for name in "ab"]
            for path, x in zip(paths, (0.0, OFFSET), strict=True):
                points = rng.normal(size=(vertices, 3))
                points /= np.linalg.norm(points, axis=1)[:, None]
                path.write_text(_obj(points + np.array([x, 0.0, 0.0])), encoding="utf-8")
            yield axes_of(load_scene(paths))


def _obj(points: np.ndarray) -> str:
    hull = Mesh(points, np.zeros((1, 3), dtype=np.uint32)).convex_hull()
    corners = ["v " + " ".join(map(repr, point)) for point in np.asarray(hull.vertices).tolist()]
    faces = [f"f {i + 1} {j + 1} {k + 1}" for i, j, k in np.asarray(hull.triangles).tolist()]
    return "\n".join((*corners, *faces, ""))


if __name__ == "__main__":
    main()
