"""The motions of a scene file, with the bodies that they move."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from msgspec import UNSET

from satcheck.core.errors import SatcheckError
from satcheck.core.transform import Quaternion
from satcheck.scene.format import document
from satcheck.scene.format.entries import BodyEntry
from satcheck.scene.format.form import Wrong, shown
from satcheck.scene.format.placement import quaternion, quaternion_of_euler
from satcheck.scene.motion import (
    NO_TURN,
    Motion,
    Path,
    PosePath,
    Rotation,
    Translation,
    Waypoint,
)
from satcheck.scene.rules import Selector

_HALF_TURN = 180.0
_ORIGIN = (0.0, 0.0, 0.0)


def selector(text: str, *keys: str | int) -> Selector:
    """keys: to the text, for the error. Raises Wrong."""
    try:
        return Selector(text)
    except SatcheckError as error:
        raise Wrong(error.message, *keys, code=error.code) from None


def motion_of(
    table: document.Motion, number: int, bodies: Sequence[BodyEntry] | None, moved: dict[str, int]
) -> list[Motion]:
    """The motion, if the bodies of the scene are known. Raises Wrong and SatcheckError.

    moved: id of each moving body -> number of its motion; this call adds to it.
    """
    path = _path(table)
    if isinstance(table.bodies, str):
        choices = [selector(table.bodies, "bodies")]
    else:
        choices = [selector(text, "bodies", k) for k, text in enumerate(table.bodies)]
    if bodies is None:
        return []
    ids: dict[str, None] = {}
    for choice in choices:
        chosen = choice.select(bodies)
        if not chosen:
            raise _refused(f"no body matches {shown(choice.text)}")
        for body in chosen:
            if body.static:
                raise _refused(f"body {shown(body.id)} is static")
            ids[body.id] = None
    for id_ in ids:
        if (other := moved.setdefault(id_, number)) != number:
            raise _refused(f"body {shown(id_)} is moved by motion[{other}] already")
    return [Motion(tuple(ids), path, table.clear)]


def _refused(message: str) -> Wrong:
    return Wrong(message, "bodies", code="bad-motion")


def _path(table: document.Motion) -> Path:
    if table.translation is not UNSET:
        return Translation(table.translation)
    if (turn := table.rotation) is not UNSET:
        return Rotation(turn.point, turn.axis, turn.degrees)
    points = table.path or ()
    for k, (before, after) in enumerate(pairwise(points), 1):
        if before.quaternion is after.quaternion is UNSET and _turns_far(before, after):
            message = "more than half a turn from the pose before: give a pose between"
            raise Wrong(message, "path", k, "euler")
    return PosePath(
        tuple(Waypoint(p.time, p.position, _orientation(p, k)) for k, p in enumerate(points))
    )


def _turns_far(before: document.Waypoint, after: document.Waypoint) -> bool:
    """Whether an angle changes by more than half a turn: a body takes the shortest turn, which may
    differ from what the angles mean."""
    start, end = before.euler or _ORIGIN, after.euler or _ORIGIN
    return any(abs(b - a) > _HALF_TURN for a, b in zip(start, end, strict=True))


def _orientation(point: document.Waypoint, number: int) -> Quaternion:
    if point.quaternion is not UNSET:
        return quaternion(point.quaternion, "path", number)
    return NO_TURN if point.euler is UNSET else quaternion_of_euler(point.euler)
