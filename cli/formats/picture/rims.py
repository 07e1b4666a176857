"""The rim of the hole that leaves a pair undecided."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from satcheck import core

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from satcheck.report.report import Finding
    from satcheck.scene import Body

    Floats = npt.NDArray[np.float64]

_BY_HOLES = ("relation", "inside")


class Rim(NamedTuple):
    """lines: closed, each repeats its start, (n, 3). which: `hole 2 of 3`, or `the hole`."""

    body: str
    which: str
    diameter: float
    lines: list[Floats]

    @property
    def centre(self) -> Floats:
        points = np.concatenate(self.lines)
        middle: Floats = (points.min(axis=0) + points.max(axis=0)) / 2
        return middle

    @property
    def normal(self) -> Floats:
        """Of the largest area that the rim goes around, of any length."""
        turns: Floats = sum(
            (np.cross(line[:-1] - line[0], line[1:] - line[0]).sum(axis=0) for line in self.lines),
            np.zeros(3),
        )
        return turns


def deciding_rim(
    finding: Finding, pair: list[Body], surface: Callable[[Body], core.Surface]
) -> Rim | None:
    """None: no hole decides how the bodies relate. pair: as placed. surface: of one as placed."""
    if finding.undecided not in _BY_HOLES or not any(body.file.health.holes for body in pair):
        return None
    hole = core.mesh_relation(*map(surface, pair)).hole
    if hole is None:
        return None
    body = pair[0 if hole.of_a else 1]
    which = "the hole" if hole.count == 1 else f"hole {hole.number + 1} of {hole.count}"
    points = np.asarray(body.world_mesh().vertices)
    loops = surface(body).rims()[hole.number]
    return Rim(body.id, which, hole.diameter, [points[[*loop, loop[0]]] for loop in loops])
