"""What a finding says, as meshes beside those of the bodies: arrows, rods, points, and balls; and
the rim of the hole that leaves a pair undecided."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from satcheck import core
from satcheck.core import Mesh
from satcheck.core.mesh_arrays import joined
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Cone, Cylinder, Sphere

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from satcheck.report.report import Finding
    from satcheck.scene import Body

    Floats = npt.NDArray[np.float64]

SEGMENTS = 32
# Of the radius of both bodies, unless the arrow is short.
_SHAFT, _HEAD = 0.012, 0.12
_DOT = 0.02
_BY_HOLES = ("relation", "inside")


def arrow(start: Floats, way: Floats, radius: float) -> Mesh:
    """radius: of the bodies beside it, which decides how thick it is."""
    length = float(np.linalg.norm(way))
    shaft, head = min(_SHAFT * radius, 0.1 * length), min(_HEAD * radius, 0.4 * length)
    neck = length - head
    rod = mesh_of(Cylinder(radius=shaft, height=neck), SEGMENTS)
    cone = mesh_of(Cone(radius=2.5 * shaft, height=head), SEGMENTS)
    upright = joined([_lifted(rod, neck / 2), _lifted(cone, neck + head / 2)])
    turn = _towards(way / length)
    return Mesh(np.asarray(upright.vertices) @ turn.T + start, upright.triangles)


def rod(start: Floats, end: Floats, radius: float) -> Mesh:
    """radius: of the bodies beside it, which decides how thick it is."""
    way = end - start
    length = float(np.linalg.norm(way))
    upright = _lifted(
        mesh_of(Cylinder(radius=_SHAFT * radius / 2, height=length), SEGMENTS), length / 2
    )
    return Mesh(np.asarray(upright.vertices) @ _towards(way / length).T + start, upright.triangles)


def dot(centre: Floats, radius: float) -> Mesh:
    """A point that is seen beside bodies of this radius."""
    return _sphere(centre, _DOT * radius)


def ball_of(finding: Finding) -> Mesh | None:
    if finding.ball is None or not finding.ball.radius > 0.0:
        return None
    return _sphere(np.array(finding.ball.centre), finding.ball.radius)


def _sphere(centre: Floats, radius: float) -> Mesh:
    ball = mesh_of(Sphere(radius=radius), SEGMENTS)
    return Mesh(np.asarray(ball.vertices) + centre, ball.triangles)


def _lifted(mesh: Mesh, height: float) -> Mesh:
    """Shapes stand around the origin."""
    return Mesh(np.add(mesh.vertices, (0.0, 0.0, height)), mesh.triangles)


def _towards(z: Floats) -> Floats:
    """The rotation that takes the z axis there."""
    least = np.eye(3)[np.argmin(np.abs(z))]
    x = np.cross(least, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


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
    if hole is None or hole.doubtful:
        return None
    body = pair[0 if hole.of_a else 1]
    which = "the hole" if hole.count == 1 else f"hole {hole.number + 1} of {hole.count}"
    points = np.asarray(body.world_mesh().vertices)
    loops = surface(body).rims()[hole.number]
    return Rim(body.id, which, hole.diameter, [points[[*loop, loop[0]]] for loop in loops])
