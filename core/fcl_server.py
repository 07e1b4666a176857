"""The python-fcl server for core.worker: the only module that imports it, only in a child process.

Jia Pan, Sachin Chitta, Dinesh Manocha, "FCL: A General Purpose Library for Collision and Proximity
Queries" (2012). It decides whether triangles meet, in float64 without exact predicates. Only its
number of contacts is used. It does not detect a body inside another.
"""

from __future__ import annotations

import msgspec


def serve(request: bytes) -> bytes:
    """request: two meshes as four blocks. Returns b"meet" or b"apart" for their surfaces."""
    import fcl
    import numpy as np

    blocks = msgspec.msgpack.decode(request, type=list[bytes])
    bodies = []
    for points, corners in zip(blocks[0::2], blocks[1::2], strict=True):
        vertices = np.frombuffer(points, dtype="<f8").reshape(-1, 3)
        triangles = np.frombuffer(corners, dtype="<u4").reshape(-1, 3).astype(np.int64)
        model = fcl.BVHModel()
        model.beginModel(len(vertices), len(triangles))
        model.addSubModel(vertices, triangles)
        model.endModel()
        bodies.append(fcl.CollisionObject(model, fcl.Transform()))
    met = fcl.collide(bodies[0], bodies[1], fcl.CollisionRequest(), fcl.CollisionResult())
    return b"meet" if met else b"apart"
