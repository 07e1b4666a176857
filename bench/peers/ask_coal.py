"""coal: collide() for yes or no, distance() with enable_signed_distance for the rest."""

from __future__ import annotations

import coal

from bench.peers.protocol import Answer, Body, Unsupported, serve


def shape(body: Body) -> coal.Convex:
    if len(body.triangles) == 0:
        raise Unsupported
    points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for p in body.vertices:
        points.append(p)
    for i, j, k in body.triangles.tolist():
        faces.append(coal.Triangle(i, j, k))
    return coal.Convex(points, faces)


def ask(a: Body, b: Body) -> Answer:
    one, other, here = shape(a), shape(b), coal.Transform3s()
    collision = coal.CollisionResult()
    coal.collide(one, here, other, here, coal.CollisionRequest(), collision)
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    request.enable_signed_distance = True
    distance = float(coal.distance(one, here, other, here, request, result))
    x, y, z = (float(c) for c in result.normal)
    return Answer("ok", collision.isCollision(), distance, (x, y, z))


if __name__ == "__main__":
    serve(ask)
