"""A table of `motion` -> Motion."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from satcheck.core.errors import SatcheckError
from satcheck.core.transform import Quaternion
from satcheck.scene.format.entries import BodyEntry
from satcheck.scene.format.placement import quaternion, quaternion_of_euler
from satcheck.scene.format.problems import Wrong, dotted
from satcheck.scene.format.rule_keys import selector
from satcheck.scene.format.table import Table
from satcheck.scene.format.values import boolean, items, number, shown, triple
from satcheck.scene.motion import Motion, Path, PosePath, Rotation, Translation, Waypoint
from satcheck.scene.rules import Selector

PATHS = ("translation", "rotation", "path")
_KNOWN = frozenset(("bodies", "clear", *PATHS))
_ROTATION_KEYS = frozenset(("axis", "point", "degrees"))
_WAYPOINT_KEYS = frozenset(("time", "position", "quaternion", "euler"))
_ORIGIN = (0.0, 0.0, 0.0)
_Z = (0.0, 0.0, 1.0)
_HALF_TURN = 180.0
_NO_TURN: Quaternion = (0.0, 0.0, 0.0, 1.0)


def read_motion(
    table: Table, bodies: Sequence[BodyEntry] | None, moved: dict[str, str]
) -> Motion | None:
    """Reads one motion; None if it has errors, which the table collects.

    bodies: of the scene; None if they are not known. moved: id of each moving body -> its motion;
    this call adds to it.
    """
    found_before = table.problem_count
    table.only(_KNOWN)
    selectors: list[Selector] = table.required("bodies", _selectors, [])
    ids = () if bodies is None else _ids(table, selectors, bodies, moved)
    if sum(key in table for key in PATHS) != 1:
        table.wrong(f"exactly one of {', '.join(PATHS)} is required")
        return None
    clear = table.read("clear", boolean, False)
    try:
        path = _path(table)
        return None if not ids or table.problem_count > found_before else Motion(ids, path, clear)
    except SatcheckError as error:
        if table.problem_count == found_before:
            table.wrong(error.message, code=error.code)
        return None


def _ids(
    table: Table,
    selectors: Sequence[Selector],
    bodies: Sequence[BodyEntry],
    moved: dict[str, str],
) -> tuple[str, ...]:
    ids: dict[str, None] = {}
    for choice in selectors:
        chosen = choice.select(bodies)
        if not chosen:
            table.wrong(f"no body matches {shown(choice.text)}", "bodies", code="bad-motion")
        fixed = next((body for body in chosen if body.static), None)
        if fixed is not None:
            table.wrong(f"body {shown(fixed.id)} is static", "bodies", code="bad-motion")
        ids |= dict.fromkeys(body.id for body in chosen)
    here = dotted(table.keys)
    for id_ in ids:
        if (other := moved.setdefault(id_, here)) != here:
            message = f"body {shown(id_)} is moved by {other} already"
            table.wrong(message, "bodies", code="bad-motion")
    return tuple(ids)


def _selectors(value: Any) -> list[Selector]:
    if value == []:
        raise Wrong("a selector expected, not an empty list")
    return items(value, selector) if isinstance(value, list) else [selector(value)]


def _path(table: Table) -> Path:
    if "path" in table:
        table.read("path", _two_at_least, None)
        waypoints = list(table.tables("path"))
        for before, after in pairwise(waypoints):
            _refuse_long_turns(before, after)
        return PosePath(tuple(_waypoint(inner) for inner in waypoints))
    rotation = table.table("rotation")
    if rotation is None:
        return Translation(table.read("translation", triple, _ORIGIN))
    rotation.only(_ROTATION_KEYS)
    return Rotation(
        point=rotation.read("point", triple, _ORIGIN),
        axis=rotation.required("axis", triple, _Z),
        degrees=rotation.required("degrees", number, 0.0),
    )


def _waypoint(table: Table) -> Waypoint:
    table.only(_WAYPOINT_KEYS)
    if "quaternion" in table and "euler" in table:
        table.wrong("the quaternion already sets the rotation: remove this key", "euler")
    return Waypoint(
        time=table.required("time", _time, 0.0),
        position=table.required("position", triple, _ORIGIN),
        orientation=table.read("quaternion", quaternion, None)
        or table.read("euler", _euler, _NO_TURN),
    )


def _refuse_long_turns(before: Table, after: Table) -> None:
    """Refuses more than half a turn between two poses: a body takes the shortest turn, which may
    differ from what the angles mean."""
    if "quaternion" in before or "quaternion" in after:
        return
    start, end = (table.read("euler", triple, _ORIGIN) for table in (before, after))
    if any(abs(b - a) > _HALF_TURN for a, b in zip(start, end, strict=True)):
        after.wrong("more than half a turn from the pose before: give a pose between", "euler")


def _two_at_least(value: Any) -> None:
    if isinstance(value, list) and len(value) < 2:
        raise Wrong(f"two waypoints at least expected, not {len(value)}")


def _time(value: Any) -> float:
    time = number(value)
    if not 0 <= time <= 1:
        raise Wrong(f"a time from 0 to 1 expected, not {shown(value)}")
    return time


def _euler(value: Any) -> Quaternion:
    return quaternion_of_euler(triple(value))
