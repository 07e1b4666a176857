"""The bodies of a report: their origin, the health of their meshes, and their placement."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from satcheck.report.values import Count, Length, Sha256, Size, Sizes, Value


class Box(Value, frozen=True, tag_field="type", tag="box"):
    size: Sizes


class Sphere(Value, frozen=True, tag_field="type", tag="sphere"):
    radius: Size


class Capsule(Value, frozen=True, tag_field="type", tag="capsule"):
    radius: Size
    length: Size


class Cylinder(Value, frozen=True, tag_field="type", tag="cylinder"):
    radius: Size
    height: Size


class Cone(Value, frozen=True, tag_field="type", tag="cone"):
    radius: Size
    height: Size


class Ellipsoid(Value, frozen=True, tag_field="type", tag="ellipsoid"):
    radii: Sizes


class HalfSpace(Value, frozen=True, tag_field="type", tag="half-space"):
    """All points with z <= 0. It is checked as the block |x|, |y| <= reach, -reach <= z <= 0, which
    is the same to every body within 3/8 of the reach of the origin."""

    reach: Size


class Outline(Value, frozen=True, tag_field="type", tag="outline"):
    """A polygon. points: its corners, counter-clockwise from the least one."""

    points: Annotated[tuple[tuple[float, float], ...], Meta(min_length=3)]


StatedShape = Box | Sphere | Capsule | Cylinder | Cone | Ellipsoid | HalfSpace | Outline


class Health(Value, frozen=True, kw_only=True):
    """The result of the inspection of a mesh. Edges are counted where triangles meet.

    cracks: gaps between faces no wider than the precision of the file; they are closed. holes:
    loops of the boundary that remain. largest_hole: diagonal of the box around the largest hole,
    file units; 0 without holes. closed: every edge has an even number of triangles, once cracks are
    closed. manifold: exactly two. oriented: all triangles agree on which side is outside. volume:
    signed, file units cubed. inside_out: some parts faced inward and were
    turned. double_sided: each face exists in both orientations. flat: all vertices in one plane.
    solid: after the repair, inside and outside are defined, and the inside is not empty.
    """

    vertices: Count
    triangles: Count
    components: Count
    boundary_edges: Count
    nonmanifold_edges: Count
    misoriented_edges: Count
    degenerate_triangles: Count
    duplicate_triangles: Count
    cracks: Count
    holes: Count
    largest_hole: Length
    closed: bool
    manifold: bool
    oriented: bool
    volume: float
    inside_out: bool
    double_sided: bool
    flat: bool
    solid: bool


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
    if a finding about it is an error, a warning or a note; else None.
    """

    id: str
    name: str
    file: str
    sha256: Sha256 | None
    path: str | None
    shape: StatedShape | None = None
    transform: Annotated[tuple[float, ...], Meta(min_length=16, max_length=16)] | None
    units: Annotated[str, Meta(pattern="^(um|mm|cm|m|in|ft)$")] | None = None
    unit_scale: Size | None = None
    groups: tuple[str, ...]
    static: bool
    triangles: Count | None
    health: Health | None
    resolution: Length | None
    surface_tolerance: Length | None = None
    convex: bool | None
    parts: Annotated[int, Meta(ge=1)] | None
    part_error: PartError | None
    stated_at: Place | None = None
