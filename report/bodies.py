"""The bodies of a report: their origin, the health of their meshes, and their placement."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from satcheck.core.mesh_health import MeshHealth
from satcheck.core.shapes import Primitive
from satcheck.report.values import Count, Length, Sha256, Size, Value


class Outline(Value, frozen=True, tag_field="type", tag="outline"):
    """A polygon. points: its corners, counter-clockwise from the least one."""

    points: Annotated[tuple[tuple[float, float], ...], Meta(min_length=3)]


StatedShape = Primitive | Outline


class PartError(Value, frozen=True):
    """Proven upper bounds, world units. outside: how far the parts stick out of the mesh. missing:
    how far the mesh sticks out of the parts."""

    outside: Length
    missing: Length


class Place(Value, frozen=True):
    """A line of a file. file: as given."""

    file: str
    line: Annotated[int, Meta(ge=1)]


class BodyReport(Value, frozen=True, kw_only=True):
    """One body. `file` is the path as given; `path` names a node within it (None: the whole file).

    An unreadable body has None everywhere but id, name and file. `sha256` is also None if the files
    were not hashed. `convex` is None if no pair needed it; `parts` is None if the body was not
    decomposed. `resolution` is the precision of the world coordinates, and `surface_tolerance` how
    far the surface may be off, both in world units. `transform` places it, row-major 4x4, world =
    transform * (x, y, z, 1); None: as in the file. `groups`, `static`: from the scene. `shape`: the
    shape that the file states, in its own frame; None: a mesh file. `units`: of its lengths
    here; None: no input states any. `unit_scale`: the factor of unit conversion in `transform`;
    None: no conversion. `stated_at`: the line of the scene file or the robot that states the body,
    if a finding about it is an error, a warning or a note; else None. `open`: its mesh is meant to
    be open.
    """

    id: str
    name: str
    file: str
    sha256: Sha256 | None = None
    path: str | None = None
    shape: StatedShape | None = None
    transform: Annotated[tuple[float, ...], Meta(min_length=16, max_length=16)] | None = None
    units: Annotated[str, Meta(pattern="^(um|mm|cm|m|in|ft)$")] | None = None
    unit_scale: Size | None = None
    groups: tuple[str, ...]
    static: bool
    open: bool = False
    triangles: Count | None = None
    health: MeshHealth | None = None
    resolution: Length | None = None
    surface_tolerance: Length | None = None
    convex: bool | None = None
    parts: Annotated[int, Meta(ge=1)] | None = None
    part_error: PartError | None = None
    stated_at: Place | None = None
