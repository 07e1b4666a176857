"""What a finding says, as meshes beside those of the bodies: the way out, and the thickness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from satcheck.cli.formats.picture.geometry import joined
from satcheck.core import Mesh
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Cone, Cylinder, Sphere

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.report.report import Finding
    from satcheck.scene import Body

    Floats = npt.NDArray[np.float64]

SEGMENTS = 32
# Of the radius of both bodies, unless the arrow is short.
_SHAFT, _HEAD = 0.012, 0.12


def arrow_of(finding: Finding, centre: Floats, radius: float) -> Mesh | None:
    """From where the bodies overlap along the way out. centre, radius: of both bodies."""
    if finding.mtv is None or not any(finding.mtv):
        return None
    start = centre
    if finding.ball is not None:
        start = np.array(finding.ball.centre)
    elif finding.witness is not None:
        start = np.array(finding.witness.a)
    return arrow(start, np.array(finding.mtv), radius)


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


def ball_of(finding: Finding) -> Mesh | None:
    if finding.ball is None or not finding.ball.radius > 0.0:
        return None
    ball = mesh_of(Sphere(radius=finding.ball.radius), SEGMENTS)
    return Mesh(np.asarray(ball.vertices) + np.array(finding.ball.centre), ball.triangles)


def sphere_around(bodies: list[Body]) -> tuple[Floats, float]:
    """Of the boxes of bodies: centre and radius."""
    bounds = np.array([body.world_mesh().bounds for body in bodies]).reshape(-1, 2, 3)
    if not len(bounds):
        return np.zeros(3), 1.0
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    return (low + high) / 2, float(np.linalg.norm(high - low)) / 2


def _lifted(mesh: Mesh, height: float) -> Mesh:
    """Shapes stand around the origin."""
    return Mesh(np.add(mesh.vertices, (0.0, 0.0, height)), mesh.triangles)


def _towards(z: Floats) -> Floats:
    """The rotation that takes the z axis there."""
    least = np.eye(3)[np.argmin(np.abs(z))]
    x = np.cross(least, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)
