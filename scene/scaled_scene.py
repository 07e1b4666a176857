"""Scales a scene beyond the range of the core into that range, by a power of two."""

from __future__ import annotations

from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.power_of_two import (
    exponent_into_range,
    exponent_of,
    limit_times_power,
    times_power,
)
from satcheck.core.shapes import Primitive, sizes_of, times_power_of_two
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, Body, Scene, Unreadable
from satcheck.scene.issue import issue
from satcheck.scene.motion import scaled_motion
from satcheck.scene.rules import LENGTHS, Rule
from satcheck.scene.shape_file import shape_file


def exponent_for(scene: Scene) -> int:
    """The k for which lengths times 2**k are in the range of the core."""
    spans = [span for body in scene.bodies if (span := _span(body)) is not None]
    if not spans:
        return 0
    return exponent_into_range(min(low for low, _ in spans), max(high for _, high in spans))


def require_in_range(scene: Scene) -> None:
    """Raises SatcheckError (`out-of-range`) if the scene needs to be scaled."""
    if exponent_for(scene):
        message = (
            "coordinates beyond 1e45, or a size below 1e-45: only `satcheck check` supports them; "
            "scale them for other commands"
        )
        raise SatcheckError("out-of-range", message)


def scaled_scene(scene: Scene, exponent: int) -> Scene:
    """The scene with its lengths times 2**exponent. A body that would lose digits becomes
    unreadable."""
    scaled = [_scaled(body, exponent) for body in scene.bodies]
    lost = tuple(body for body in scaled if isinstance(body, Unreadable))
    return replace(
        scene,
        bodies=tuple(body for body in scaled if isinstance(body, Body)),
        unreadable=(*scene.unreadable, *lost),
        rules=tuple(_scaled_rule(rule, exponent) for rule in scene.rules),
        motions=tuple(scaled_motion(motion, 2.0**exponent) for motion in scene.motions),
        issues=(*scene.issues, *(body.issue for body in lost)),
        order=tuple(body.id for body in scene.in_order()),
    )


def _span(body: Body) -> tuple[int, int] | None:
    """Exponents of the size and of the largest coordinate of the body; None: it is a point."""
    rows = body.transform or IDENTITY
    low, high = body.file.mesh.bounds
    sides = [h - c for c, h in zip(low, high, strict=True)]
    if not any(sides):
        return None
    least = min(sizes_of(body.shape)) if isinstance(body.shape, Primitive) else max(sides)
    largest = max(map(abs, (*low, *high)))
    stretch = max(map(abs, (*rows[0:3], *rows[4:7], *rows[8:11])))
    offset = max(map(abs, rows[3:12:4]))
    return (
        exponent_of(stretch) + exponent_of(least),
        # Three products and the offset are summed: no more than four times the largest.
        2 + max(exponent_of(stretch) + exponent_of(largest), exponent_of(offset)),
    )


def _scaled(body: Body, exponent: int) -> Body | Unreadable:
    scaled = _scaled_shape(body, exponent) or _scaled_placement(body, exponent)
    if scaled is not None:
        own = body.surface_tolerance
        off = None if own is None else limit_times_power(own, exponent)
        return replace(scaled, surface_tolerance=off)
    message = "beyond the range of numbers: its coordinates would lose digits"
    path = body.file.path
    reason = issue("out-of-range", message, body=body.id, file=path)
    return Unreadable(body.id, path, reason, body.groups, body.path, body.static)


def _scaled_placement(body: Body, exponent: int) -> Body | None:
    rows = body.transform or IDENTITY
    scaled = times_power(rows[:12], exponent)
    return None if scaled is None else _placed(body, (*scaled, *rows[12:]))


def _scaled_shape(body: Body, exponent: int) -> Body | None:
    """Scales the sizes of a primitive, so that its transform stays rigid."""
    if not isinstance(body.shape, Primitive):
        return None
    own = body.file.exponent + exponent
    shape = times_power_of_two(body.shape, own)
    rows = body.transform or IDENTITY
    entries = [
        times_power((entry,), exponent if k % 4 == 3 else -body.file.exponent)
        for k, entry in enumerate(rows[:12])
    ]
    if shape is None or None in entries:
        return None
    file = shape_file(shape, body.file.path)
    if file.exponent:
        return None
    transform = (*(entry[0] for entry in entries if entry), *rows[12:])
    return replace(_placed(body, transform), file=file, shape=shape)


def _scaled_rule(rule: Rule, exponent: int) -> Rule:
    dimensions = {**dict.fromkeys(LENGTHS, 1), "max_volume": 3}
    limits = {name: getattr(rule, name) for name in dimensions}
    return replace(
        rule,
        **{
            name: limit_times_power(limit, dimensions[name] * exponent)
            for name, limit in limits.items()
            if limit is not None
        },
    )


def _placed(body: Body, transform: Transform) -> Body:
    return replace(body, transform=None if transform == IDENTITY else transform)
