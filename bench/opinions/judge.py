"""What others say of a pair that satcheck lets pass, or calls an overlap. Runs in a child process.

`python -m bench.opinions.judge` reads a question a line, and answers each with a line, both JSON.
Nothing of the solver is used: the meshes come from its readers, everything else is python-fcl,
manifold3d, and our own slow arithmetic (`crossing.py`, `surface.py`).
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, dataclass
from typing import Any, Literal

import fcl
import manifold3d
import numpy as np

from bench.opinions.crossing import cross_for_sure
from bench.opinions.meshes import read
from bench.opinions.surface import Mesh, Points, area, distances, rim, winding_numbers
from bench.peers.ask_fcl_mesh import soup

Standing = Literal["agrees", "false", "doubted", "no answer"]

# Triangle pairs of FCL that are looked at exactly, and sampled points of each body.
CONTACTS = 400
SAMPLES = 40
# Parts of the size: what rounding in a placement may do, and how far inside a sample has to be.
ROUNDING = 1e-14
DEEP = 1e-6
# Beyond this many products of samples and triangles no winding number is taken.
WORK = 20_000_000
INSIDE = 0.9


@dataclass(frozen=True)
class Opinion:
    """Standing `false`: proven wrong; `doubted`: another library disagrees, without proof."""

    standing: Standing
    words: str


def of_pass(a: Mesh, b: Mesh, tolerance: float) -> Opinion:
    """About a pair that is said to be separated, near or touching within the tolerance."""
    margin = tolerance + ROUNDING * float(max(np.abs(m.vertices).max() for m in (a, b)))
    meeting = contacts(a, b)
    for i, j in meeting:
        if cross_for_sure(a.corners[i].tolist(), b.corners[j].tolist(), margin):
            return Opinion("false", f"triangles {i} and {j} cross by more than {margin:.3g}")
    for inner, outer, words in ((a, b, "A within B"), (b, a, "B within A")):
        wound, depth = deepest(corners_within(inner, outer), outer)
        if wound >= INSIDE and depth > margin:
            closed = not len(rim(outer))
            where = f"{words}: winding number {wound:.3g}, {depth:.3g} from the surface"
            return Opinion("false" if closed else "doubted", where)
    point = common_point(a, b, margin)
    if point is not None:
        closed = not len(rim(a)) and not len(rim(b))
        where = "both wind about {:.6g} {:.6g} {:.6g}".format(*point)
        return Opinion("false" if closed else "doubted", where)
    volume = common_volume(a, b)
    if volume is not None and volume > margin * min(area(a), area(b)):
        return Opinion("doubted", f"manifold3d: common volume {volume:.3g}")
    count = f"FCL: {len(meeting)} triangle pairs meet, none for sure; " if meeting else ""
    return Opinion("agrees", count + ("no volume asked" if volume is None else "no common volume"))


def of_alarm(a: Mesh, b: Mesh) -> Opinion:
    """About a pair that is said to overlap."""
    if contacts(a, b):
        return Opinion("agrees", "FCL: surfaces meet")
    if any(deepest(corners_within(*way), way[1])[0] > 0.5 for way in ((a, b), (b, a))):
        return Opinion("agrees", "a point of one lies within the other")
    volume = common_volume(a, b)
    if volume is None:
        return Opinion("no answer", "surfaces apart by FCL, no common volume to be had")
    return Opinion("agrees" if volume > 0 else "doubted", f"manifold3d: common volume {volume:.3g}")


def contacts(a: Mesh, b: Mesh) -> list[tuple[int, int]]:
    """Triangles of A and B that meet, by FCL in float64; at most CONTACTS pairs."""
    request = fcl.CollisionRequest(num_max_contacts=CONTACTS, enable_contact=True)
    result = fcl.CollisionResult()
    fcl.collide(soup(a.vertices, a.triangles), soup(b.vertices, b.triangles), request, result)
    return [(contact.b1, contact.b2) for contact in result.contacts]


def corners_within(inner: Mesh, outer: Mesh) -> Points:
    """Some corners of one body that lie in the box of the other."""
    low, high = outer.vertices.min(axis=0), outer.vertices.max(axis=0)
    used = inner.vertices[np.unique(inner.triangles)]
    within = used[np.all((used >= low) & (used <= high), axis=1)]
    return within[:: max(1, len(within) // SAMPLES)]


def deepest(points: Points, mesh: Mesh) -> tuple[float, float]:
    """The winding number that is furthest from 0, of the points clear of the surface, and how far
    that point is from it; (0, 0) where there is none, or it is too much work."""
    if not len(points) or len(points) * len(mesh.triangles) > WORK:
        return 0.0, 0.0
    depths = distances(mesh, points)
    clear = depths > DEEP * mesh.size
    if not clear.any():
        return 0.0, 0.0
    wound = np.abs(winding_numbers(mesh, points[clear]))
    best = int(wound.argmax())
    return float(wound[best]), float(depths[clear][best])


def common_point(a: Mesh, b: Mesh, margin: float) -> Points | None:
    """Of random points in the common box one that both surfaces wind about, clear of both."""
    low = np.maximum(a.vertices.min(axis=0), b.vertices.min(axis=0))
    high = np.minimum(a.vertices.max(axis=0), b.vertices.max(axis=0))
    if np.any(low >= high):
        return None
    points = low + np.random.default_rng(0).random((2 * SAMPLES, 3)) * (high - low)
    for mesh in (a, b):
        if len(points) * len(mesh.triangles) > WORK:
            return None
        points = points[np.abs(winding_numbers(mesh, points)) >= INSIDE]
    for mesh in (a, b):
        points = points[distances(mesh, points) > max(margin, DEEP * mesh.size)]
    return points[0] if len(points) else None


def common_volume(a: Mesh, b: Mesh) -> float | None:
    """By manifold3d; None where one is no manifold to it, or is inside out."""
    solids = []
    for mesh in (a, b):
        points, names = np.unique(mesh.vertices, axis=0, return_inverse=True)
        corners = names.reshape(-1)[mesh.triangles].astype(np.uint64)
        solid = manifold3d.Manifold(manifold3d.Mesh64(points, corners))
        if solid.status() != manifold3d.Error.NoError or solid.volume() <= 0:
            return None
        solids.append(solid)
    return float((solids[0] ^ solids[1]).volume())


def answer(question: dict[str, Any]) -> Opinion:
    """question: `files` and `matrices`, two each; `claim`, `pass` or `alarm`; `tolerance`."""
    matrices: list[Points] = [np.array(matrix, float) for matrix in question["matrices"]]
    a, b = (
        read(path).moved(matrix) for path, matrix in zip(question["files"], matrices, strict=True)
    )
    if question["claim"] == "pass":
        return of_pass(a, b, question["tolerance"])
    return of_alarm(a, b)


def main() -> None:
    for line in sys.stdin:
        try:
            given = answer(json.loads(line))
        except Exception as error:  # noqa: BLE001 whatever a library throws is its answer
            given = Opinion("no answer", f"{type(error).__name__}: {error}")
        sys.stdout.write(json.dumps(asdict(given)) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
