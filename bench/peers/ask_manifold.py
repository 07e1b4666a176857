"""manifold3d: has the Boolean intersection a volume? Vertices in float64."""

from __future__ import annotations

import manifold3d
import numpy as np

from bench.peers.protocol import Answer, Body, Unsupported, serve


def solid(body: Body) -> manifold3d.Manifold:
    mesh = manifold3d.Mesh64(body.vertices, body.triangles.astype(np.uint64))
    made = manifold3d.Manifold(mesh)
    if made.status() != manifold3d.Error.NoError:
        raise Unsupported
    return made


def ask(a: Body, b: Body) -> Answer:
    return Answer("ok", (solid(a) ^ solid(b)).volume() > 0)


if __name__ == "__main__":
    serve(ask)
