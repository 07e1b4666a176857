"""Libraries that bench/outlines.py asks. Each takes all pairs of a set at once, in native code."""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import os
import subprocess
import sysconfig
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal

import manifold3d
import numpy as np
from numpy.typing import NDArray

from bench.outline_pairs import PolygonPair, loops_of
from satcheck import core
from satcheck.scene.planar.region import prism

Query = Literal["overlap", "depth", "distance"]
Floats = NDArray[np.float64]
# CPU time in ns and a figure of each pair: 1 or 0, the depth or 0, the gap or 0.
Answer = tuple[float, Floats]
Ask = Callable[[Query], Answer]
BOX2D_CORNERS = 8
PEERS = Path(__file__).parent / "peers"
PARRY = Path(os.environ.get("CARGO_TARGET_DIR", PEERS / "parry" / "target"))


def convex_peers(pairs: list[PolygonPair]) -> Iterator[tuple[str, Ask, tuple[Query, ...]]]:
    """Name, question, and the queries that the library has."""
    everything: tuple[Query, ...] = ("overlap", "depth", "distance")
    yield "satcheck", satcheck(pairs), everything
    if importlib.util.find_spec("shapely"):
        yield "shapely", shapely(pairs), ("overlap", "distance")
    few = max(len(polygon) for pair in pairs for polygon in pair) <= BOX2D_CORNERS
    if few and importlib.util.find_spec("pyb2d3"):
        yield "Box2D", box2d(pairs), everything
    if importlib.util.find_spec("pymunk"):
        yield "Chipmunk", chipmunk(pairs), ("overlap", "depth")
    if (PARRY / "release" / "parry2d_peer").exists():
        yield "parry2d", parry2d(pairs), everything


def concave_peers(pairs: list[tuple[Any, Any]]) -> Iterator[tuple[str, Ask, tuple[Query, ...]]]:
    yield "satcheck", prisms(pairs), ("overlap", "distance")
    if importlib.util.find_spec("shapely"):
        yield "shapely", shapely(pairs), ("overlap", "distance")


def missing() -> list[str]:
    found = [name for name in ("shapely", "pyb2d3", "pymunk") if not importlib.util.find_spec(name)]
    return found + ["parry2d"] * (not (PARRY / "release" / "parry2d_peer").exists())


def timed(answer: Callable[[], Any]) -> Answer:
    start = time.process_time_ns()
    figures = answer()
    return time.process_time_ns() - start, np.asarray(figures, dtype=np.float64)


def flat(pairs: list[PolygonPair]) -> tuple[Floats, NDArray[np.uint32]]:
    """All corners in one array, and where each polygon starts."""
    polygons = [polygon for pair in pairs for polygon in pair]
    starts = np.cumsum([0, *map(len, polygons)]).astype(np.uint32)
    return np.ascontiguousarray(np.concatenate(polygons), dtype=np.float64), starts


def satcheck(pairs: list[PolygonPair]) -> Ask:
    """As hulls of prisms, which a check in a plane makes of convex outlines."""
    widest = max(float(np.abs(polygon).max()) for pair in pairs for polygon in pair)

    def made(polygon: Floats, height: float) -> core.Hull:
        ends = [np.column_stack((polygon, np.full(len(polygon), z))) for z in (-height, height)]
        return core.Hull(np.concatenate(ends))

    shapes = [hull for a, b in pairs for hull in (made(a, 8 * widest), made(b, 12 * widest))]
    first = np.arange(0, 2 * len(pairs), 2, dtype=np.uint32)
    second = first + np.uint32(1)
    poses = np.tile((0.0, 0, 0, 0, 0, 0, 1), (len(pairs), 1))

    def ask(query: Query) -> Answer:
        start = time.process_time_ns()
        results = core.check_pairs(shapes, first, second, poses, poses, query=query, threads=1)
        spent = time.process_time_ns() - start
        if query == "overlap":
            penetrating = results.outcome == core.OUTCOMES.index("penetrating")
            return spent, penetrating.astype(np.float64)
        return spent, np.maximum(results.distance if query == "distance" else -results.distance, 0)

    return ask


def prisms(pairs: list[tuple[Any, Any]]) -> Ask:
    def made(outline: Any, height: float) -> core.Surface:
        loops = loops_of(outline)
        triangles = np.asarray(manifold3d.triangulate(loops), dtype=np.int64)
        return core.Surface(prism(np.concatenate(loops), triangles, height), solid=True)

    # As flat_scene does: taller than wide, of different heights.
    widest = max(float(np.abs(loop).max()) for pair in pairs for o in pair for loop in loops_of(o))
    surfaces = [(made(a, 8 * widest), made(b, 12 * widest)) for a, b in pairs]
    apart = ("separated", "touching")

    def ask(query: Query) -> Answer:
        if query == "distance":
            return timed(lambda: [core.mesh_distance(a, b).distance for a, b in surfaces])
        return timed(lambda: [core.mesh_relation(a, b).relation not in apart for a, b in surfaces])

    return ask


def shapely(pairs: list[tuple[Any, Any]]) -> Ask:
    library: Any = importlib.import_module("shapely")
    a, b = (
        np.array([library.Polygon(loops[0], loops[1:]) for loops in map(loops_of, outlines)])
        for outlines in zip(*pairs, strict=True)
    )
    return lambda query: timed(
        lambda: (
            library.distance(a, b)
            if query == "distance"
            else library.intersects(a, b) & ~library.touches(a, b)
        )
    )


def box2d(pairs: list[PolygonPair]) -> Ask:
    root = Path(sysconfig.get_paths()["purelib"])
    header = next(iter(root.rglob("box2d/collision.h")))
    archive = next(iter(root.rglob("libbox2d.a")))
    return in_c("box2d_peer.c", [f"-I{header.parent.parent}"], [str(archive)], pairs)


def chipmunk(pairs: list[PolygonPair]) -> Ask:
    library = str(importlib.import_module("pymunk._chipmunk").__file__)
    return in_c("chipmunk_peer.c", [], [library, "-Wl,--unresolved-symbols=ignore-all"], pairs)


def in_c(source: str, options: list[str], libraries: list[str], pairs: list[PolygonPair]) -> Ask:
    target = Path(tempfile.mkdtemp()) / "peer.so"
    command = ["gcc", "-O3", "-shared", "-fPIC", *options, str(PEERS / "native" / source)]
    subprocess.run([*command, *libraries, "-lm", "-lpthread", "-o", target], check=True)
    library = ctypes.CDLL(str(target))
    library.make.restype = ctypes.c_void_p
    corners, starts = flat(pairs)
    address = [ctypes.c_void_p(array.ctypes.data) for array in (corners, starts)]
    made = ctypes.c_void_p(library.make(*address, 2 * len(pairs)))
    figures = np.zeros(len(pairs))
    words = {"overlap": b"o", "depth": b"d", "distance": b"g"}

    def ask(query: Query) -> Answer:
        def answer() -> Floats:
            word = ctypes.c_char(words[query])
            library.ask(made, len(pairs), word, ctypes.c_void_p(figures.ctypes.data))
            return figures

        spent, found = timed(answer)
        return spent, found.copy()

    return ask


def parry2d(pairs: list[PolygonPair]) -> Ask:
    child = subprocess.Popen(
        [PARRY / "release" / "parry2d_peer"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert child.stdin is not None
    assert child.stdout is not None
    to, back = child.stdin, child.stdout
    polygons = [polygon for pair in pairs for polygon in pair]
    numbers = ([len(polygon), *polygon.ravel().tolist()] for polygon in polygons)
    to.write(" ".join(repr(x) for row in numbers for x in row).encode() + b"\n")

    def ask(query: Query) -> Answer:
        to.write(query.encode() + b"\n")
        to.flush()
        spent, *figures = map(float, back.readline().split())
        return spent, np.array(figures)

    return ask
