"""Shapes that a scene states by their sizes, instead of a mesh file.

Each is centred at its own origin, with its axis along z, in the scene's units; the apex of a cone
is at +z. All of them are convex.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterator, Sequence

from msgspec import Struct

from satcheck.core import Mesh
from satcheck.core.power_of_two import times_power

Point = tuple[float, float, float]
Values = dict[str, str | float | list[float]]

DEFAULT_SEGMENTS = 64


class Box(Struct, frozen=True):
    """size: its whole extent along x, y and z."""

    size: Point

    def __post_init__(self) -> None:
        _validate(self)


class Sphere(Struct, frozen=True):
    """All points at most `radius` from the origin."""

    radius: float

    def __post_init__(self) -> None:
        _validate(self)


class Capsule(Struct, frozen=True):
    """All points at most `radius` from a segment of `length`, the caps not counted, along z."""

    radius: float
    length: float

    def __post_init__(self) -> None:
        _validate(self)


class Cylinder(Struct, frozen=True):
    """height: from one flat end to the other."""

    radius: float
    height: float

    def __post_init__(self) -> None:
        _validate(self)


class Cone(Struct, frozen=True):
    """radius: of its base, at z = -height / 2; the apex is at z = height / 2."""

    radius: float
    height: float

    def __post_init__(self) -> None:
        _validate(self)


class Ellipsoid(Struct, frozen=True):
    """radii: along x, y and z."""

    radii: Point

    def __post_init__(self) -> None:
        _validate(self)


Primitive = Box | Sphere | Capsule | Cylinder | Cone | Ellipsoid
PRIMITIVES: dict[str, type[Primitive]] = {
    "box": Box,
    "sphere": Sphere,
    "capsule": Capsule,
    "cylinder": Cylinder,
    "cone": Cone,
    "ellipsoid": Ellipsoid,
}
_TRIPLES = frozenset(("size", "radii"))
_NUMBERS = frozenset((int, float))


def is_curved(shape: Primitive) -> bool:
    """Whether its mesh only approximates it."""
    return not isinstance(shape, Box)


def values_of(shape: Primitive) -> Values:
    """{"type": "box", "size": [x, y, z]} and the like: as a scene file states the shape."""
    values: Values = {"type": type(shape).__name__.lower()}
    for name in shape.__struct_fields__:
        size = getattr(shape, name)
        values[name] = list(map(float, size)) if name in _TRIPLES else float(size)
    return values


def sizes_of(shape: Primitive) -> tuple[float, ...]:
    sizes = (getattr(shape, name) for name in shape.__struct_fields__)
    return tuple(s for size in sizes for s in (size if isinstance(size, tuple) else (size,)))


def times_power_of_two(shape: Primitive, exponent: int) -> Primitive | None:
    """The shape with its sizes times 2**exponent; None where one of them is not that exactly."""
    sizes = times_power(sizes_of(shape), exponent)
    if sizes is None:
        return None
    values: tuple[object, ...] = (sizes,) if shape.__struct_fields__[0] in _TRIPLES else sizes
    form: Callable[..., Primitive] = type(shape)
    return form(*values)


def primitive_of(values: object) -> Primitive:
    """The inverse of `values_of`; ValueError for what states no shape."""
    if not isinstance(values, dict):
        raise ValueError("not a shape: an object with a type and its sizes expected")
    kind = values.get("type")
    form = PRIMITIVES.get(kind) if isinstance(kind, str) else None
    if form is None:
        raise ValueError(f"type should be one of {', '.join(PRIMITIVES)}, not {kind!r}")
    sizes = {key: value for key, value in values.items() if key != "type"}
    wanted = form.__struct_fields__
    if sorted(sizes) != sorted(wanted):
        raise ValueError(
            f"a {kind} has {' and '.join(wanted)}, not {', '.join(sizes) or 'nothing'}"
        )
    numbers = {
        key: tuple(value) if isinstance(value, list | tuple) else value
        for key, value in sizes.items()
    }
    return form(**numbers)  # type: ignore[arg-type]  # each shape validates its sizes


def mesh_of(shape: Primitive, segments: int = DEFAULT_SEGMENTS) -> Mesh:
    """The hull of points on the surface: closed, wound outward, and exactly convex.

    A box is exact, with 8 vertices and 12 triangles. A curved shape has `segments` points on each
    of its circles, a multiple of 4 from 8 on, those on its axes among them; half as many bands
    from pole to pole. Each coordinate is rounded to float64, so that a vertex lies on the surface
    up to that rounding. Raises OverflowError for sizes beyond what is decided exactly.
    """
    if segments < 8 or segments % 4:
        raise ValueError(f"segments should be a multiple of 4 from 8 on, not {segments}")
    points = array("d", (c for point in _surface_points(shape, segments) for c in point))
    return (
        Mesh.from_bytes(points.tobytes(), array("I", (0, 1, 2)).tobytes()).convex_hull().to_mesh()
    )


def sag_of(shape: Primitive, segments: int) -> float:
    """No point of the shape is farther than this from `mesh_of` it with so many segments.

    A facet between two rings and two meridians of the unit ball is no nearer to its centre than
    cos(pi / segments) squared; the other shapes are stretched or drawn out from balls and discs.
    """
    match shape:
        case Box():
            return 0.0
        case Ellipsoid(radii):
            radius = max(radii)
        case _:
            radius = shape.radius
    return radius * (math.cos(math.pi / segments) ** -2 - 1.0)


def _surface_points(shape: Primitive, segments: int) -> Iterator[Point]:
    match shape:
        case Box(size):
            x, y, z = (c / 2 for c in size)
            return ((i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1))
        case Sphere(radius):
            return _ball((radius, radius, radius), segments)
        case Ellipsoid(radii):
            return _ball(radii, segments)
        case Capsule(radius, length):
            return _ball((radius, radius, radius), segments, length / 2)
        case Cylinder(radius, height):
            ring = [(radius * x, radius * y) for x, y in _circle(segments)]
            return ((x, y, z) for z in (-height / 2, height / 2) for x, y in ring)
        case Cone(radius, height):
            ring = [(radius * x, radius * y) for x, y in _circle(segments)]
            return iter([(0.0, 0.0, height / 2), *((x, y, -height / 2) for x, y in ring)])


def _ball(radii: Point, segments: int, half_length: float = 0.0) -> Iterator[Point]:
    """Rings around z from either pole to the equator, each half moved out by `half_length`."""
    rx, ry, rz = radii
    circle = _circle(segments)
    for cosine, sine in circle[: segments // 4 + 1]:  # of the angle to the axis
        z = rz * cosine + half_length
        for x, y in circle if sine else circle[:1]:
            yield rx * sine * x, ry * sine * y, z
            yield rx * sine * x, ry * sine * y, -z


def _circle(segments: int) -> list[tuple[float, float]]:
    """Points of the unit circle from (1, 0) on; a quarter turn maps them exactly to themselves."""
    steps = [math.tau * k / segments for k in range(1, segments // 4)]
    first = [(1.0, 0.0), *((math.cos(angle), math.sin(angle)) for angle in steps)]
    second = [(-y, x) for x, y in first]
    return [*first, *second, *((-x, -y) for x, y in first), *((-x, -y) for x, y in second)]


def _validate(shape: Primitive) -> None:
    for name in shape.__struct_fields__:
        value = getattr(shape, name)
        wanted = 3 if name in _TRIPLES else 1
        numbers = value if isinstance(value, tuple) else (value,)
        if isinstance(value, tuple) != (wanted == 3) or len(numbers) != wanted:
            what = "three numbers" if wanted == 3 else "a number"
            raise ValueError(f"{name} should be {what}")
        if not _NUMBERS.issuperset(map(type, numbers)):
            raise ValueError(f"{name} holds something else than numbers")
        if not _are_positive(numbers):
            raise ValueError(f"{name} should be positive and finite")


def _are_positive(numbers: Sequence[float]) -> bool:
    """And finite."""
    try:
        return min(numbers) > 0 and all(map(math.isfinite, numbers))
    except OverflowError:  # an integer beyond float64
        return False
