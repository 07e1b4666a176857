"""The motions of bodies in a report, and the result of a sweep of two moving bodies: plain data.

t runs from 0 to 1; lengths are in the units of the files. clear: the way must be free, of touches
too.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.values import Count, Interval, Length, Share, Value, Vector

# The value of a joint is a number, or a list of numbers.
Joints = dict[str, float | list[float]]
SweptRelation = Literal["separated", "near", "touching", "penetrating", "indeterminate"]
Bodies = Annotated[tuple[str, ...], Meta(min_length=1)]


class Place(Value, frozen=True):
    """The progress of a body along its motion: degrees of a rotation, length of a translation, or t
    on a path of poses."""

    body: str
    term: Literal["degrees", "length", "t"]
    value: float


class WorstPose(Value, frozen=True):
    """The deepest pose of bodies that overlap, else the nearest pose. distance, depth: proven
    bounds of the least distance, or the greatest depth, over the whole motion. The worse end is a
    bound; the other is reached at `time`. One of the two is None. joints: as in `Sweep`."""

    time: Share
    at: tuple[Place, ...]
    joints: Joints | None = None
    distance: Interval | None = None
    depth: Interval | None = None


class Sweep(Value, frozen=True, kw_only=True):
    """A pair over its whole motion.

    relation: the worst relation of the motion. `separated`: no common point at any t. `near`:
    closer than the clearance at some t. `touching`: they come as close as the tolerance, or this
    could not be excluded, and at no t they overlap by more than it. `penetrating`: they overlap by
    more at some t. tolerance: the touch band of the sweep. time_of_impact: no such overlap before
    its lower end; at its upper end, a check of the bodies, posed and rounded to float64, finds one.
    at: the pose there. point: in the world, common to both bodies in that pose, up to rounding; of
    curved shapes, up to the tolerance and the way of the bodies during time_of_impact. None: there
    is no proven hit, or no such point is known. joints: on a path of joints, their values there.
    poses: the numbers, from 1, of the poses of that path before and after it. contact: no common
    point before this t. reached: no such overlap up to this t. worst: only if the depth is asked,
    or the clearance, the tolerance or a limit needs it.
    distance_at_least: a lower bound of the distance at every t, where `worst` is None. reason: why
    the answer is `indeterminate`, or what the sweep of surfaces left open. steps: the cost. proven:
    False: only boxes or hulls show the hit, at an accuracy below exact.
    """

    relation: SweptRelation
    time_of_impact: Interval | None = None
    at: tuple[Place, ...] = ()
    point: Vector | None = None
    joints: Joints | None = None
    poses: tuple[Count, Count] | None = None
    contact: Share | None = None
    reached: Share
    worst: WorstPose | None = None
    distance_at_least: Length | None = None
    tolerance: Length
    steps: Count = 0
    proven: bool = True
    reason: str | None = None


class Translation(Value, frozen=True, tag_field="kind", tag="translation"):
    """Bodies that move by t * vector."""

    bodies: Bodies
    clear: bool
    vector: Vector


class Rotation(Value, frozen=True, tag_field="kind", tag="rotation"):
    """Bodies that rotate by t * degrees about an axis through a point."""

    bodies: Bodies
    clear: bool
    point: Vector
    axis: Vector
    degrees: float


class Waypoint(Value, frozen=True):
    """A rigid pose. orientation: quaternion x, y, z, w."""

    time: Share
    position: Vector
    orientation: tuple[float, float, float, float]


class PosePath(Value, frozen=True, tag_field="kind", tag="path"):
    """Bodies that pass rigid poses at given times. In between, positions follow lines and rotations
    shortest arcs."""

    bodies: Bodies
    clear: bool
    waypoints: Annotated[tuple[Waypoint, ...], Meta(min_length=2)]


class JointWaypoint(Value, frozen=True):
    """A pose of robots. joints: the value of each joint that moves or stands."""

    time: Share
    joints: dict[str, float | list[float]]


class JointPath(Value, frozen=True, tag_field="kind", tag="joints"):
    """Bodies of robots whose joints pass poses at given times. In between, each joint moves
    steadily."""

    bodies: Bodies
    clear: bool
    waypoints: Annotated[tuple[JointWaypoint, ...], Meta(min_length=2)]


StatedMotion = Translation | Rotation | PosePath | JointPath
