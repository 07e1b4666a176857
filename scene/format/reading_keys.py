"""The table `reading`: the options with which the mesh files of a scene are read."""

from __future__ import annotations

from typing import Any, get_args

from satcheck.scene.format.problems import Wrong
from satcheck.scene.format.table import Table
from satcheck.scene.format.values import Reader, list_of, number, one_of, shown
from satcheck.scene.read_options import GeometryKind, Purpose

_purposes = list_of("purposes", one_of(get_args(Purpose)))


def _some_purposes(value: Any) -> tuple[str, ...]:
    if not (purposes := _purposes(value)):
        raise Wrong("a purpose at least expected")
    return tuple(purposes)


def _positive(value: Any) -> float:
    if (length := number(value)) <= 0:
        raise Wrong(f"a number above 0 expected, not {shown(value)}")
    return length


# Lengths in millimetres, angles in radians, as in `ReadOptions`.
_READERS: dict[str, Reader[Any]] = {
    "time": number,
    "geometry": one_of(get_args(GeometryKind)),
    "purpose": _some_purposes,
    "chord_tolerance": _positive,
    "angular_tolerance": _positive,
}


def read_reading(table: Table) -> dict[str, Any]:
    """The options that it states; errors are collected by the table."""
    table.only(frozenset(_READERS))
    return {key: table.read(key, read, None) for key, read in _READERS.items() if key in table}
