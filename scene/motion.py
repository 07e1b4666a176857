"""Motions: how bodies move, as data.

A motion moves its bodies as one rigid assembly over a parameter t in [0, 1]. The pose of a body at
t is M(t) * placement, in the world frame, for column vectors, with lengths in the units of the
scene. The classes below define M. All motions of a scene share one t, and a body has at most one
motion.

Rotation interpolated along the shortest arc: Ken Shoemake, "Animating Rotation with Quaternion
Curves" (1985).
"""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.core.transform import Quaternion

NO_TURN: Quaternion = (0.0, 0.0, 0.0, 1.0)


class Translation(Struct, frozen=True):
    """M(t) translates by t * vector. vector: world frame, may be zero."""

    vector: Vector

    def __post_init__(self) -> None:
        _require_finite("the vector of a translation", self.vector, 3)


class Rotation(Struct, frozen=True):
    """M(t) rotates by t * degrees about the line through `point` along `axis`, world frame.

    Right-handed: if the axis points at the viewer, positive degrees turn counter-clockwise.
    degrees: any finite number, also several turns. axis: of any length except zero.
    """

    point: Vector
    axis: Vector
    degrees: float

    def __post_init__(self) -> None:
        _require_finite("the point of a rotation", self.point, 3)
        _require_finite("the axis of a rotation", self.axis, 3)
        _require_finite("the degrees of a rotation", (self.degrees,), 1)
        if not any(self.axis):
            raise _refused("the axis of a rotation must not be zero")


class Waypoint(Struct, frozen=True):
    """A rigid pose: world = rotation(orientation) * p + position, p a point of the placed body.

    time: in [0, 1]. orientation: a quaternion (x, y, z, w) of any length except zero.
    """

    time: float
    position: Vector
    orientation: Quaternion = NO_TURN

    def __post_init__(self) -> None:
        _require_finite("the time of a waypoint", (self.time,), 1)
        _require_finite("the position of a waypoint", self.position, 3)
        _require_finite("the orientation of a waypoint", self.orientation, 4)
        if not any(self.orientation):
            raise _refused("the orientation of a waypoint must not be zero")


class PosePath(Struct, frozen=True):
    """M(t) runs through the waypoints, the first at time 0, the last at time 1.

    Between two of them the position is interpolated along a line and the orientation along the
    shortest arc, each in proportion to time; opposite orientations (half a turn apart) take the arc
    of the quaternions as given. If the first pose is not the identity, the motion does not start at
    the placement.
    """

    waypoints: tuple[Waypoint, ...]

    def __post_init__(self) -> None:
        times = [waypoint.time for waypoint in self.waypoints]
        if len(times) < 2 or times[0] != 0.0 or times[-1] != 1.0:
            raise _refused("the waypoints of a path must start at time 0 and end at time 1")
        if any(later <= earlier for earlier, later in pairwise(times)):
            raise _refused("the times of the waypoints of a path must increase")


Path = Translation | Rotation | PosePath


class Motion(Struct, frozen=True):
    """Bodies that move together, rigidly, along one path. bodies: their ids, each once. clear: the
    way must be free: no body may be touched on it that does not touch them as placed."""

    bodies: tuple[str, ...]
    path: Path
    clear: bool = False

    def __post_init__(self) -> None:
        if not self.bodies:
            raise _refused("a motion must name a body")
        refuse_second_motions((self,))


def scaled_motion(motion: Motion, scale: float) -> Motion:
    """The same motion in another unit: its lengths times `scale`."""
    path = motion.path
    if scale == 1.0:
        return motion
    if isinstance(path, Translation):
        path = Translation(_times(scale, path.vector))
    elif isinstance(path, Rotation):
        path = replace(path, point=_times(scale, path.point))
    else:
        waypoints = (replace(w, position=_times(scale, w.position)) for w in path.waypoints)
        path = PosePath(tuple(waypoints))
    return replace(motion, path=path)


def _times(scale: float, vector: Vector) -> Vector:
    x, y, z = vector
    return scale * x, scale * y, scale * z


def refuse_second_motions(motions: tuple[Motion, ...]) -> None:
    """Raises SatcheckError (`bad-motion`) if two motions move the same body."""
    for body, times in Counter(body for motion in motions for body in motion.bodies).items():
        if times > 1:
            raise SatcheckError("bad-motion", "a body can have one motion only", body=body)


def _require_finite(what: str, numbers: tuple[float, ...], count: int) -> None:
    if len(numbers) != count or not all(math.isfinite(number) for number in numbers):
        raise _refused(f"{what} must be {count} finite number{'s' if count > 1 else ''}")


def _refused(message: str) -> SatcheckError:
    return SatcheckError("bad-motion", message)
