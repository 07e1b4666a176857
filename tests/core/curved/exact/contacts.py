"""Contacts of curved shapes that are exact in float64, in any orientation.

An integer quaternion turns by a matrix of integers, |q|^2 times a rotation: bodies are scaled by
that too. In the frame that is turned so a contact is set up with coordinates of few bits. One body
is then moved off or into the other by one unit in the last place of one coordinate.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, Ellipsoid, Primitive, Sphere
from satcheck.scene import Body
from tests.core.curved.bodies import shape

Vector = tuple[float, float, float]
Columns = tuple[Vector, Vector, Vector]

UPRIGHT: Columns = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
UPSIDE_DOWN: Columns = ((1, 0, 0), (0, -1, 0), (0, 0, -1))
LYING: Columns = ((0, 0, -1), (0, 1, 0), (1, 0, 0))  # its axis along x
ACROSS: Columns = ((1, 0, 0), (0, 0, 1), (0, -1, 0))  # its axis along -y


@dataclass(frozen=True, slots=True)
class Placed:
    primitive: Primitive
    columns: Columns
    origin: Vector


@dataclass(frozen=True, slots=True)
class Contact:
    """In the frame that is turned: B touches A, and leaves it along the normal. at_edge: moved
    across it by anything, they may miss each other."""

    name: str
    a: Placed
    b: Placed
    normal: Vector
    at_edge: bool = False


TABLE = Placed(Box((8.0, 6.0, 2.0)), UPRIGHT, (0.0, 0.0, -1.0))
# Shapes on the plane z = 0: how they are turned, and how high their centre is.
STANDING: tuple[tuple[str, Primitive, Columns, float], ...] = (
    ("can", Cylinder(0.5, 1.0), UPRIGHT, 0.5),
    ("lying can", Cylinder(0.5, 1.0), LYING, 0.5),
    ("cone", Cone(0.5, 1.5), UPRIGHT, 0.75),
    ("cone on its tip", Cone(0.5, 1.5), UPSIDE_DOWN, 0.75),
    ("egg", Ellipsoid((0.5, 1.0, 0.25)), UPRIGHT, 0.25),
    ("egg on its side", Ellipsoid((0.5, 1.0, 0.25)), LYING, 0.5),
    ("capsule", Capsule(0.25, 1.0), UPRIGHT, 0.75),
    ("lying capsule", Capsule(0.25, 1.0), ACROSS, 0.25),
    ("ball", Sphere(0.375), UPRIGHT, 0.375),
)
# Where they stand: the middle of the table, off the middle, with its edge or its corner below them.
PLACES = ((0.0, 0.0), (1.25, -0.5), (4.0, 0.5), (4.0, 3.0))


def on_a_table() -> Iterator[Contact]:
    for name, primitive, columns, height in STANDING:
        for x, y in PLACES:
            body = Placed(primitive, columns, (x, y, height))
            at_edge = x == 4.0 and name not in ("can", "cone")
            yield Contact(f"{name} at {x}, {y}", TABLE, body, (0, 0, 1), at_edge)
    wide = Placed(Cylinder(16.0, 1.0), UPRIGHT, (1.0, 0.5, 0.5))
    yield Contact("a disc wider than the table", TABLE, wide, (0, 0, 1))
    long = Placed(Cylinder(0.5, 32.0), LYING, (0.5, 0.25, 0.5))
    yield Contact("a log longer than the table", TABLE, long, (0, 0, 1))
    edge = Placed(Cylinder(1.25, 2.0), LYING, (0.5, 3.0 + 0.75, 1.0))
    yield Contact("a log along the edge", TABLE, edge, (0, 3, 4))
    askew = Placed(Capsule(1.25, 2.0), LYING, (0.5, 3.0 + 0.75, 1.0))
    yield Contact("a capsule along the edge", TABLE, askew, (0, 3, 4))


def on_each_other() -> Iterator[Contact]:
    """Stacked along z, of those whose top is known."""
    for name, lower, columns, height in STANDING:
        if "tip" in name or name.startswith(("lying", "egg on")):
            continue
        turned = UPSIDE_DOWN if name == "cone" else columns
        below = Placed(lower, turned, (0.5, 0.25, -height))
        for other, upper, columns_b, height_b in STANDING:
            if "tip" in name and "tip" in other:
                continue
            above = Placed(upper, columns_b, (0.5, 0.25, height_b))
            yield Contact(f"{other} on {name}", below, above, (0, 0, 1))


def side_by_side() -> Iterator[Contact]:
    """Across parallel axes, along a Pythagorean triple; crossed ones; balls along a quadruple."""
    upright: list[Primitive] = [Cylinder(1.25, 2.0), Capsule(1.25, 2.0)]
    for one in upright:
        for other in (Cylinder(1.25, 3.0), Capsule(1.25, 3.0), Sphere(1.25)):
            b = Placed(other, UPRIGHT, (1.5, 2.0, 0.5))
            yield Contact(
                f"{type(other).__name__} beside {type(one).__name__}",
                Placed(one, UPRIGHT, (0.0, 0.0, 0.0)),
                b,
                (3, 4, 0),
            )
    yield Contact(
        "crossed cans",
        Placed(Cylinder(0.75, 4.0), LYING, (0.25, 0.5, 0.0)),
        Placed(Cylinder(0.5, 4.0), ACROSS, (0.5, 0.25, 1.25)),
        (0, 0, 1),
    )
    yield Contact(
        "balls",
        Placed(Sphere(1.5), UPRIGHT, (0.5, 0.25, 0.0)),
        Placed(Sphere(2.0), UPRIGHT, (1.5, 1.75, 3.0)),
        (2, 3, 6),
    )
    yield Contact(
        "cans rim to rim",
        Placed(Cylinder(1.25, 2.0), UPRIGHT, (0.0, 0.0, -1.0)),
        Placed(Cylinder(1.25, 2.0), UPRIGHT, (1.5, 2.0, 1.0)),
        (0, 0, 1),
        at_edge=True,
    )


def all_contacts() -> list[Contact]:
    return [*on_a_table(), *on_each_other(), *side_by_side()]


def turn(quaternion: tuple[int, int, int, int]) -> Columns:
    """|q|^2 times the rotation."""
    w, x, y, z = quaternion
    return (
        (w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z),
    )


def times(m: Columns, v: Vector) -> Vector:
    x, y, z = (sum(m[k][i] * v[k] for k in range(3)) for i in range(3))
    return x, y, z


def bodies(contact: Contact, frame: Columns, ulps: int, scale: float = 1.0) -> tuple[Body, Body]:
    """ulps: by so many B is moved off A, or into it, where the normal is longest."""
    m: Columns = tuple(tuple(scale * c for c in column) for column in frame)  # type: ignore[assignment]
    placed = []
    for id_, one in (("a", contact.a), ("b", contact.b)):
        columns = [times(m, column) for column in one.columns]
        origin = list(times(m, one.origin))
        if id_ == "b":
            _nudge(origin, times(frame, contact.normal), ulps)
        rows = [[*(columns[k][i] for k in range(3)), origin[i]] for i in range(3)]
        transform = (*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0)
        placed.append(shape(id_, one.primitive, tuple(map(float, transform))))
    return placed[0], placed[1]


def _nudge(origin: list[float], normal: Vector, ulps: int) -> None:
    axis = max(range(3), key=lambda k: abs(normal[k]))
    for _ in range(abs(ulps)):
        origin[axis] = math.nextafter(origin[axis], math.copysign(math.inf, ulps * normal[axis]))
