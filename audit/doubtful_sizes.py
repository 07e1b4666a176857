"""Warnings about sizes that make an answer doubtful, for example after a wrong unit of length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from satcheck.audit.bodies.placed_bodies import PlacedBodies
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.core import largest_stretch
from satcheck.core.conventions import Plane, axes_of
from satcheck.report.report import SIZES_DIFFER, TOLERANCE_LARGE, Finding, Issue

# Two bodies of about one size, one in millimetres and one in metres, are about 1000-fold apart.
UNLIKE = 500.0
_SHOWN = 5  # bodies in one message


def doubtful_sizes(
    bodies: PlacedBodies, findings: Sequence[Finding], plane: Plane | None
) -> Iterator[Issue]:
    """Bodies smaller than the tolerance of one of their pairs, and bodies of very different
    sizes."""
    sizes = {bodies.ids[k]: size_of(body, plane) for k, body in bodies.placed.items()}
    yield from _tolerances(sizes, findings)
    endless = {body.id for body in bodies.placed.values() if body.endless}
    sizes = {id_: size for id_, size in sizes.items() if id_ not in endless}
    for unit in dict.fromkeys(bodies.units.values()):
        alike = {
            id_: sizes[id_]
            for id_ in (bodies.ids[k] for k, u in bodies.units.items() if u == unit)
            if id_ in sizes
        }
        yield from _unlike(alike)


def size_of(body: PlacedBody, plane: Plane | None) -> float:
    """The longest side of its own box, world units: the same in every pose."""
    low, high = body.body.file.mesh.bounds
    axes = (0, 1, 2) if plane is None else axes_of(plane)
    transform = body.body.transform
    stretch = 1.0 if transform is None else largest_stretch(transform)
    return stretch * max(high[axis] - low[axis] for axis in axes)


def _tolerances(sizes: dict[str, float], findings: Sequence[Finding]) -> Iterator[Issue]:
    largest: dict[str, float] = {}
    for finding in findings:
        for id_ in (finding.a, finding.b):
            largest[id_] = max(largest.get(id_, 0.0), finding.tolerance or 0.0)
    small = [id_ for id_, size in sizes.items() if size < largest.get(id_, 0.0)]
    if not small:
        return
    tolerance = max(largest[id_] for id_ in small)
    verb = "is" if len(small) == 1 else "are"
    more = f" and {len(small) - _SHOWN} more" if len(small) > _SHOWN else ""
    message = (
        f"{', '.join(small[:_SHOWN])}{more} {verb} smaller than the tolerance {tolerance:.3g}, "
        "within which an overlap counts as touching"
    )
    yield Issue(TOLERANCE_LARGE, "warning", small[0] if len(small) == 1 else None, None, message)


def _unlike(sizes: dict[str, float]) -> Iterator[Issue]:
    if len(sizes) < 2:
        return
    smallest, largest = (pick(sizes, key=sizes.__getitem__) for pick in (min, max))
    low, high = sizes[smallest], sizes[largest]
    if low * UNLIKE > high:
        return
    message = (
        f"{smallest} is {low:.3g} in size and {largest} {high:.3g}: is one of them in another unit?"
    )
    yield Issue(SIZES_DIFFER, "warning", None, None, message)
