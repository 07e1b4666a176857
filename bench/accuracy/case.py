"""One pair of bodies, what its corpus says about it, and how much is spent on it.

Nothing of satcheck is imported here: a process counts the memory that its parent had as its own, so
what starts the processes whose memory is measured has to be small.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

SCENE_SCHEMA = "satcheck-scene-1"


@dataclass(frozen=True, slots=True)
class Stated:
    """What the corpus says, found by others or by hand; None: nothing, or neither is wrong.

    overlap: whether the bodies have a common interior. way_out: length of a translation that is
    known to end the overlap, so that the depth is no more. depth, distance: of the pair.
    """

    overlap: bool | None = None
    way_out: float | None = None
    depth: float | None = None
    distance: float | None = None


@dataclass(frozen=True, slots=True)
class Case:
    """Two mesh files as they stand, or, where transforms are given, placed by them.

    meshes: absolute paths. transforms: 4x4, row-major. id: unlike that of any other case.
    """

    id: str
    meshes: tuple[str, str]
    transforms: tuple[list[list[float]], list[list[float]]] | None = None
    stated: Stated = Stated()

    def inputs(self, scratch: Path) -> list[Path]:
        """What to give to a check: the meshes, or a scene that is written to this folder."""
        if self.transforms is None:
            return [Path(mesh) for mesh in self.meshes]
        bodies = [
            {"id": side, "mesh": mesh, "transform": transform}
            for side, mesh, transform in zip("ab", self.meshes, self.transforms, strict=True)
        ]
        path = scratch / "pair.scene.json"
        content = {"schema": SCENE_SCHEMA, "name": self.id, "bodies": bodies}
        path.write_text(json.dumps(content), encoding="utf-8")
        return [path]

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


def case_of(content: dict[str, Any]) -> Case:
    """The inverse of to_dict."""
    a, b = content["meshes"]
    placed = content["transforms"]
    transforms = None if placed is None else (placed[0], placed[1])
    return Case(content["id"], (a, b), transforms, Stated(**content["stated"]))


@dataclass(frozen=True, slots=True)
class Effort:
    """repeat: runs of everything. rung_seconds: for all runs of one rung on one pair; pair_seconds:
    of all rungs. part_triangles: pairs with more are not split into convex parts. What does not fit
    is left away, and said."""

    repeat: int
    rung_seconds: float
    pair_seconds: float
    part_triangles: int
