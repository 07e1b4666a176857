"""The motions of bodies in a report. t runs from 0 to 1. clear: the way must be free, of touches
too."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from satcheck.report.values import Share, Value, Vector

Bodies = Annotated[tuple[str, ...], Meta(min_length=1)]


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
