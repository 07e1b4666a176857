"""python-fcl on triangle soups, as trimesh's CollisionManager asks it: do the surfaces collide?"""

from __future__ import annotations

from typing import Any

import fcl

from bench.peers.protocol import Answer, Body, serve


def soup(vertices: Any, triangles: Any) -> fcl.CollisionObject:
    """vertices (n, 3), triangles (m, 3) as indices."""
    bvh = fcl.BVHModel()
    bvh.beginModel(len(vertices), len(triangles))
    bvh.addSubModel(vertices, triangles)
    bvh.endModel()
    return fcl.CollisionObject(bvh)


def ask(a: Body, b: Body) -> Answer:
    soups = (soup(body.vertices, body.triangles) for body in (a, b))
    found = fcl.collide(*soups, fcl.CollisionRequest(), fcl.CollisionResult())
    return Answer("ok", found > 0)


if __name__ == "__main__":
    serve(ask)
