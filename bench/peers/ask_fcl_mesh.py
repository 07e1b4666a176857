"""python-fcl on triangle soups, as trimesh's CollisionManager asks it: do the surfaces collide?"""

from __future__ import annotations

import fcl

from bench.peers.protocol import Answer, Body, serve


def model(body: Body) -> fcl.CollisionObject:
    bvh = fcl.BVHModel()
    bvh.beginModel(len(body.vertices), len(body.triangles))
    bvh.addSubModel(body.vertices, body.triangles)
    bvh.endModel()
    return fcl.CollisionObject(bvh)


def ask(a: Body, b: Body) -> Answer:
    found = fcl.collide(model(a), model(b), fcl.CollisionRequest(), fcl.CollisionResult())
    return Answer("ok", found > 0)


if __name__ == "__main__":
    serve(ask)
