"""A scene through trimesh's CollisionManager (python-fcl), in a process of its own.

    python bench/peers/ask_trimesh.py SCENE.json transformed|placed

transformed: each body is a copy of its mesh with the transform applied, which gives the right
answer. placed: the mesh is handed over with the transform beside it, which is cheaper; FCL takes a
transform for rigid, so that a scale or a mirror in it is silently wrong. Prints one JSON line: the
number of pairs that collide, and the most memory the process had, MiB.
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
import trimesh.collision

KIBIBYTES_PER_MEBIBYTE = 1024


def main() -> None:
    scene, way = Path(sys.argv[1]), sys.argv[2]
    document = json.loads(scene.read_text(encoding="utf-8"))
    meshes: dict[str, Any] = {}
    manager: Any = trimesh.collision.CollisionManager()
    for body in document["bodies"]:
        path = body["mesh"]
        if path not in meshes:
            meshes[path] = trimesh.load(scene.parent / path, force="mesh")
        transform = np.array(body.get("transform", np.eye(4)))
        if way == "transformed":
            mesh = meshes[path].copy()
            mesh.apply_transform(transform)
            manager.add_object(body["id"], mesh)
        else:
            manager.add_object(body["id"], meshes[path], transform)
    _, names = manager.in_collision_internal(return_names=True)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // KIBIBYTES_PER_MEBIBYTE
    sys.stdout.write(json.dumps({"pairs": len(names), "mebibytes": memory}) + "\n")


if __name__ == "__main__":
    main()
