"""python-fcl: collide() for yes or no, distance() with enable_signed_distance for the rest."""

from __future__ import annotations

import fcl
import numpy as np

from bench.peers.protocol import Answer, Body, Unsupported, serve


def shape(body: Body) -> fcl.Convex:
    if len(body.triangles) == 0:
        raise Unsupported
    faces = np.concatenate([[3, *triangle] for triangle in body.triangles])
    return fcl.Convex(body.vertices.copy(), len(body.triangles), faces)


def ask(a: Body, b: Body) -> Answer:
    one, other = (fcl.CollisionObject(shape(body)) for body in (a, b))
    overlap = fcl.collide(one, other, fcl.CollisionRequest(), fcl.CollisionResult()) > 0
    request = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=True)
    result = fcl.DistanceResult()
    distance = float(fcl.distance(one, other, request, result))
    between = np.subtract(result.nearest_points[1], result.nearest_points[0])
    length = float(np.linalg.norm(between))
    x, y, z = between / (length * np.sign(distance)) if length > 0 and distance else (np.nan,) * 3
    return Answer("ok", bool(overlap), distance, (x, y, z))


if __name__ == "__main__":
    serve(ask)
