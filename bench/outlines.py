"""Flat outlines beside shapely and Box2D: do the interiors of two polygons meet?

    pip install shapely pyb2d3
    python -m bench.outlines [--pairs 200] [--rounds 3]

The truth comes from rational arithmetic on the same coordinates, without any tolerance. Convex
polygons: every edge of both as a separating line. Concave outlines lie on a grid, so that 64 bits
hold every orientation: a proper crossing of two edges, or a corner of one within the other.

shapely answers in one call for all pairs. Box2D is called from a loop in C, which needs gcc and the
library in pyb2d3; it takes at most 8 corners. satcheck answers convex pairs one by one
(`sat_polygons`, a call from Python each) and all outlines as prisms, made as those of a drawing.
All take turns in every round; the least CPU time counts. So what satcheck keeps with a surface
after its first question is free, while shapely's polygons are not prepared. What is not installed
is left out and said so.
"""

from __future__ import annotations

import argparse
import ctypes
import importlib
import importlib.util
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck import core
from satcheck.scene.drawing.contour import Contour, DrawnShape
from satcheck.scene.drawing.sheet import sheet_of
from satcheck.scene.planar.prism import prism

Polygon = NDArray[np.float64]
PolygonPair = tuple[Polygon, Polygon]
Ask = Callable[[], NDArray[np.bool_]]
BOX2D_CORNERS = 8
BOX2D = r"""
#include "box2d/collision.h"
#include <math.h>
b2Polygon* make(const double* xy, int polygons, int corners) {
  b2Polygon* made = malloc(polygons * sizeof(b2Polygon));
  for (int i = 0; i < polygons; ++i) {
    b2Vec2 p[8];
    for (int k = 0; k < corners; ++k, xy += 2) p[k] = (b2Vec2){(float)xy[0], (float)xy[1]};
    b2Hull hull = b2ComputeHull(p, corners);
    made[i] = b2MakePolygon(&hull, 0);
  }
  return made;
}
void ask(const b2Polygon* a, const b2Polygon* b, int pairs, unsigned char* meet) {
  for (int i = 0; i < pairs; ++i) {
    b2Manifold m = b2CollidePolygons(a + i, b2Transform_identity, b + i, b2Transform_identity);
    meet[i] = 0;
    for (int k = 0; k < m.pointCount; ++k) meet[i] |= m.points[k].separation < 0;
  }
}
"""


def ring(rng: np.random.Generator, corners: int) -> Polygon:
    """Convex: corners on a circle."""
    turns = (np.arange(corners) + rng.uniform(0, 0.6, corners)) * 2 * np.pi / corners
    return np.column_stack((np.cos(turns), np.sin(turns)))


def convex_pairs(rng: np.random.Generator, corners: int, count: int) -> list[PolygonPair]:
    return [
        (ring(rng, corners), ring(rng, corners) + rng.uniform(-1.6, 1.6, 2)) for _ in range(count)
    ]


def squares(rng: np.random.Generator, count: int, ulps: int) -> list[PolygonPair]:
    """Two squares edge to edge, the second moved to the right by so many ulp."""
    pairs = []
    for _ in range(count):
        x, y = rng.uniform(1, 1.9), rng.uniform(-0.5, 0.5)
        start = x + ulps * np.spacing(x)
        left = np.array([[0, 0], [x, 0], [x, 1], [0, 1]])
        pairs.append((left, np.array([[start, y], [3, y], [3, y + 1], [start, y + 1]])))
    return pairs


def stars(rng: np.random.Generator, corners: int, count: int) -> list[PolygonPair]:
    """Concave, on a grid."""

    def star() -> Polygon:
        turns = np.arange(corners) * 2 * np.pi / corners
        radii = rng.uniform(0.5, 1, corners)[:, None] * 2**20
        return np.asarray(np.rint(radii * np.column_stack((np.cos(turns), np.sin(turns)))))

    return [(star(), star() + np.rint(rng.uniform(-1.9, 1.9, 2) * 2**20)) for _ in range(count)]


def convex_truth(a: Polygon, b: Polygon) -> bool:
    first, second = ([[Fraction(x) for x in p] for p in polygon.tolist()] for polygon in (a, b))
    for one, other in ((first, second), (second, first)):
        for (x, y), (u, v) in zip(one, one[1:] + one[:1], strict=True):
            if all((u - x) * (q - y) - (v - y) * (p - x) <= 0 for p, q in other):
                return False
    return True


def star_truth(a: Polygon, b: Polygon) -> bool:
    """Raises ValueError for outlines that touch and do not cross: not decided here."""
    p, r = a.astype(np.int64)[:, None], b.astype(np.int64)[None]
    q, s = np.roll(p, -1, axis=0), np.roll(r, -1, axis=1)
    sides = [np.sign(turn(*t)) for t in ((p, q, r), (p, q, s), (r, s, p), (r, s, q))]
    if ((sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0)).any():
        return True
    if ((sides[0] * sides[1] <= 0) & (sides[2] * sides[3] <= 0)).any():
        raise ValueError("the outlines touch")
    return within(a[0], b) or within(b[0], a)


def turn(p: NDArray[Any], q: NDArray[Any], r: NDArray[Any]) -> NDArray[Any]:
    d, e = q - p, r - p
    return np.asarray(d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0])


def within(point: Polygon, polygon: Polygon) -> bool:
    p, q = polygon.astype(np.int64), np.roll(polygon, -1, axis=0).astype(np.int64)
    x = point.astype(np.int64)
    up, down = (p[:, 1] <= x[1]) & (q[:, 1] > x[1]), (p[:, 1] > x[1]) & (q[:, 1] <= x[1])
    side = turn(p, q, np.broadcast_to(x, p.shape))
    return bool((up & (side > 0)).sum() != (down & (side < 0)).sum())


def one_by_one(meet: Callable[[Any, Any], bool], pairs: list[tuple[Any, Any]]) -> Ask:
    return lambda: np.array([meet(a, b) for a, b in pairs])


def prisms(pairs: list[PolygonPair]) -> Ask:
    def made(polygon: Polygon, height: float) -> core.Surface:
        corners = tuple((x, y) for x, y in polygon.tolist())
        sheet = sheet_of(DrawnShape("outline", (Contour(corners),), "nonzero"))
        return core.Surface(prism(sheet.points, sheet.triangles, height), solid=True)

    # As flat_scene does: taller than wide, of different heights.
    height = 8.0 * max(float(np.abs(polygon).max()) for pair in pairs for polygon in pair)
    surfaces = [(made(a, height), made(b, 1.5 * height)) for a, b in pairs]
    apart = ("separated", "touching")
    return one_by_one(lambda a, b: core.mesh_relation(a, b).relation not in apart, surfaces)


def shapely(pairs: list[PolygonPair]) -> Ask:
    library: Any = importlib.import_module("shapely")
    a, b = (np.array([library.Polygon(pair[k]) for pair in pairs]) for k in (0, 1))
    return lambda: np.asarray(library.intersects(a, b) & ~library.touches(a, b))


def box2d(pairs: list[PolygonPair]) -> Ask:
    root = Path(sysconfig.get_paths()["purelib"])
    archive = next(iter(root.rglob("libbox2d.a")))
    header = next(iter(root.rglob("box2d/collision.h")))
    folder = Path(tempfile.mkdtemp())
    source, target = folder / "ask.c", folder / "ask.so"
    source.write_text("#include <stdlib.h>\n" + BOX2D)
    command = ["gcc", "-O3", "-shared", "-fPIC", f"-I{header.parent.parent}"]
    subprocess.run([*command, source, archive, "-lm", "-lpthread", "-o", target], check=True)
    library = ctypes.CDLL(str(target))
    library.make.restype = ctypes.c_void_p
    count, corners = len(pairs), len(pairs[0][0])
    made = []
    for k in (0, 1):
        xy = np.ascontiguousarray([pair[k] for pair in pairs], dtype=np.float64)
        made.append(ctypes.c_void_p(library.make(ctypes.c_void_p(xy.ctypes.data), count, corners)))
    meet = np.zeros(count, dtype=np.uint8)

    def ask() -> NDArray[np.bool_]:
        library.ask(*made, count, ctypes.c_void_p(meet.ctypes.data))
        return meet.astype(bool)

    return ask


def asked_of(pairs: list[PolygonPair], *, convex: bool) -> dict[str, Ask]:
    asks = {"satcheck, prisms": prisms(pairs)}
    if convex:
        asks["satcheck, SAT"] = one_by_one(
            lambda a, b: core.sat_polygons(a, b).outcome == "penetrating", pairs
        )
    if importlib.util.find_spec("shapely"):
        asks["shapely"] = shapely(pairs)
    if convex and len(pairs[0][0]) <= BOX2D_CORNERS and importlib.util.find_spec("pyb2d3"):
        asks["Box2D"] = box2d(pairs)
    return asks


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    rng = np.random.default_rng(1)
    n = options.pairs
    sets = {f"convex {k}": (convex_pairs(rng, k, n), True) for k in (4, 8, 32)}
    sets |= {
        name: (squares(rng, n, ulps), True)
        for name, ulps in (("flush", 0), ("gap 1 ulp", 1), ("deep 1 ulp", -1))
    }
    sets |= {f"concave {k}": (stars(rng, k, max(n // 5, 5)), False) for k in (16, 100, 1000)}
    for name in ("shapely", "pyb2d3"):
        if not importlib.util.find_spec(name):
            sys.stderr.write(f"{name}: not installed, left out\n")
    out = sys.stdout.write
    out("| pairs | library | ns | wrong | left out |\n|---|---|---|---|---|\n")
    for title, (drawn, convex) in sets.items():
        pairs, truth = [], []
        for a, b in drawn:
            try:
                truth.append(convex_truth(a, b) if convex else star_truth(a, b))
            except ValueError:
                continue
            pairs.append((a, b))
        asks = asked_of(pairs, convex=convex)
        best, wrong = dict.fromkeys(asks, np.inf), dict.fromkeys(asks, 0)
        for _ in range(options.rounds):
            for name, ask in asks.items():
                start = time.process_time_ns()
                answers = ask()
                best[name] = min(best[name], (time.process_time_ns() - start) / len(pairs))
                wrong[name] = int((answers != np.array(truth)).sum())
        for name in asks:
            skipped = len(drawn) - len(pairs)
            out(
                f"| {title}, {sum(truth)} meet | {name} | {best[name]:.0f} | "
                f"{wrong[name]}/{len(pairs)} | {skipped} |\n"
            )


if __name__ == "__main__":
    main()
