"""Two mesh files through trimesh's CollisionManager (python-fcl), in a process of its own.

    python bench/peers/ask_trimesh_pair.py A B

Do their surfaces collide, and if not, how far apart are they? Prints one JSON line. A body inside
another is apart to it.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import trimesh
import trimesh.collision


def manager_of(path: str) -> Any:
    manager: Any = trimesh.collision.CollisionManager()
    manager.add_object(path, trimesh.load(path, force="mesh"))
    return manager


def main() -> None:
    a, b = (manager_of(path) for path in sys.argv[1:3])
    collides = bool(a.in_collision_other(b))
    distance = None if collides else float(a.min_distance_other(b))
    sys.stdout.write(json.dumps({"collides": collides, "distance": distance}) + "\n")


if __name__ == "__main__":
    main()
