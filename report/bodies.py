"""The bodies of a report: where each comes from, what was found in its mesh, where it stands."""

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


StatedShape = Box | Sphere | Capsule | Cylinder | Cone | Ellipsoid


class Health(Value, frozen=True, kw_only=True):
    """What was found when the mesh was inspected; edges are counted where triangles meet.

    cracks: places where faces miss each other by the precision of the file; they are closed. holes:
    loops of the boundary that are left. largest_hole: from corner to corner of the box around it,
    file units; 0 without holes. closed: every edge has an even number of triangles, once cracks are
    closed. manifold: exactly two. oriented: all triangles agree on which side is outside. volume:
    signed, file units cubed; None: out of range. inside_out: parts faced inward and were turned.
    double_sided: each face exists in both orientations. flat: all vertices in one plane. solid:
    after repair, inside and outside are defined, and some of it is inside.
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
    volume: float | None
    inside_out: bool
    double_sided: bool
    flat: bool
    solid: bool


class PartError(Value, frozen=True):
    """Proven upper bounds, world units: how far parts stick out of the mesh, and it out of them."""

    outside: Length
    missing: Length


class Place(Value, frozen=True):
    """A line of a file. file: as given."""

    file: str
    line: Annotated[int, Meta(ge=1)]


class BodyReport(Value, frozen=True, kw_only=True):
    """One body. `file` is the path as given; `path` names a node within it (None: the whole file).

    An unreadable body has None everywhere but id, name and file. `sha256` is None, too, where the
    scene was loaded without. `convex` is None where no pair had to know; `parts` is None where
    nothing was decomposed. `resolution` is the precision of the input, and `surface_tolerance` how
    far its surface may be off, in world units. `transform` places it, row-major 4x4, world =
    transform * (x, y, z, 1); None: as in the file. `groups`, `static`: as the scene says. `shape`:
    the primitive that the file states, in its own frame, as a scene file does; None: a mesh file.
    `units`: of its lengths here; None: no input states any. `unit_scale`: what `transform` converts
    lengths of the file by; None: nothing. `stated_at`: the line of the scene file or the robot that
    states the body, where a finding about it is an error, a warning or a note; None otherwise.
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
