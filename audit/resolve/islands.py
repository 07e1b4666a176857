"""Groups of walls that have nothing to do with each other."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from satcheck.audit.resolve.wall import Wall


def islands(walls: Sequence[Wall], movable: Collection[int]) -> list[list[Wall]]:
    """The walls by connected component; bodies that stay connect nothing. In the order of their
    first walls, each with its walls in the order given. Union-find with path halving."""
    parent = {body: body for wall in walls for body in (wall.a, wall.b) if body in movable}

    def root(body: int) -> int:
        while parent[body] != body:
            parent[body] = parent[parent[body]]
            body = parent[body]
        return body

    for wall in walls:
        if wall.a in parent and wall.b in parent:
            parent[root(wall.b)] = root(wall.a)
    found: dict[int, list[Wall]] = {}
    for wall in walls:
        found.setdefault(root(wall.a if wall.a in parent else wall.b), []).append(wall)
    return list(found.values())
