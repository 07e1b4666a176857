"""MuJoCo: two mesh geoms, mj_geomDistance; a distance of 0 or less is an overlap.

It stores vertices in float32, about their centre. A `ccd_tolerance` of 1e-15 and 1000 iterations
let it go as far as it can.
"""

from __future__ import annotations

import mujoco
import numpy as np

from bench.peers.protocol import Answer, Body, Unsupported, serve


def ask(a: Body, b: Body) -> Answer:
    if min(len(a.vertices), len(b.vertices)) < 4 or not (len(a.triangles) and len(b.triangles)):
        raise Unsupported
    spec = mujoco.MjSpec()
    spec.option.ccd_tolerance = 1e-15
    spec.option.ccd_iterations = 1000
    for name, body in (("a", a), ("b", b)):
        mesh = spec.add_mesh(name=name)
        mesh.uservert = body.vertices.ravel()
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name)
    try:
        model = spec.compile()
    except ValueError as error:
        raise Unsupported from error
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    ends = np.zeros(6)
    distance = float(mujoco.mj_geomDistance(model, data, 0, 1, 1e30, ends))
    between = ends[3:] - ends[:3]
    length = float(np.linalg.norm(between))
    x, y, z = between / (length * np.sign(distance)) if length > 0 and distance else (np.nan,) * 3
    return Answer("ok", distance <= 0, distance, (float(x), float(y), float(z)))


if __name__ == "__main__":
    serve(ask)
