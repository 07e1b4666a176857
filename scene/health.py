"""The health of a mesh: its topology, what was repaired, and what to warn about."""

from __future__ import annotations

import math
from collections.abc import Callable

from msgspec import Struct

from satcheck.core import Inspection, Mesh, Topology, inspect, inspect_bytes, with_cracks_closed
from satcheck.scene.errors import Refused


class MeshHealth(Struct, frozen=True):
    """The mesh as read, welded. Edges are counted where triangles meet.

    closed: every edge has an even number of triangles, once cracks are closed. manifold: exactly
    two. oriented: all triangles agree on which side is outside. cracks: gaps between neighbouring
    faces no wider than the precision of the file; they are closed. holes: boundary loops that
    remain after the repair. Loops of flat parts do not count, because these are sheets.
    largest_hole: the extent of the largest hole, file units, 0.0 without holes. volume: signed,
    file units cubed, 0.0 unless closed and oriented.
    inside_out: some parts faced inward and were turned. double_sided: each face exists in both
    orientations. flat: all vertices in one plane. solid: after the repair, inside and outside are
    defined, and the inside is not empty.
    """

    vertices: int
    triangles: int
    components: int
    boundary_edges: int
    nonmanifold_edges: int
    misoriented_edges: int
    degenerate_triangles: int
    duplicate_triangles: int
    cracks: int
    holes: int
    largest_hole: float
    closed: bool
    manifold: bool
    oriented: bool
    volume: float
    inside_out: bool
    double_sided: bool
    flat: bool
    solid: bool


class Examined(Struct, frozen=True):
    """A welded mesh and its health. The mesh is wound outward if its orientation can be decided.

    topology: before the repair. warnings: (code, message).
    """

    mesh: Mesh
    topology: Topology
    health: MeshHealth
    warnings: tuple[tuple[str, str], ...]


# Open pieces that block more than this share of all directions may be meant to enclose their
# inside. Seen from the middle, a corner of a room blocks half of all directions, and a box without
# a lid blocks 5/6.
MOST_AROUND = 0.75
# Two copies of a point are at most this many precisions apart if each coordinate of both is off
# by at most the precision of the file.
CRACK_WIDTH = 2 * math.sqrt(3)
Resolution = Callable[[Mesh], float]


def _exact(_: Mesh) -> float:
    return 0.0


def examine(mesh: Mesh, *, orient: bool = True, resolution: Resolution = _exact) -> Examined:
    """Welds and inspects a mesh. It also orients the mesh, unless its winding is intended.

    Vertices and triangles are sorted, so that no answer depends on their order in the file.
    resolution: computes the precision of the coordinates; called only if the mesh has a boundary.
    Raises Refused (without a file name) when no triangle has an area.
    """
    return _judged(_sealed(inspect(mesh, orient), orient, resolution))


def examine_bytes(
    vertices: bytes | memoryview,
    triangles: bytes | memoryview,
    resolution: Resolution = _exact,
) -> Examined:
    """Same as examine(Mesh.from_bytes(vertices, triangles)), but builds no temporary mesh."""
    return _judged(_sealed(inspect_bytes(vertices, triangles, True), True, resolution))


def _sealed(inspection: Inspection, orient: bool, resolution: Resolution) -> Inspection:
    after = inspection.repaired
    if after.closed and after.oriented:
        return inspection
    return with_cracks_closed(inspection, orient, CRACK_WIDTH * resolution(inspection.mesh))


def _judged(inspection: Inspection) -> Examined:
    topology, after, turned = inspection.topology, inspection.repaired, inspection.turned
    if topology.degenerate_triangles == topology.triangles:
        raise Refused(
            "only-degenerate",
            f"only degenerate triangles: all {topology.triangles} have area 0",
        )
    # If every edge has an even number of triangles, all faces come in pairs, and nothing is
    # enclosed, the mesh is the front and back of a sheet. A solid whose faces come twice encloses
    # its volume twice.
    in_pairs = topology.closed and 2 * topology.duplicate_triangles >= topology.triangles
    double_sided = in_pairs and topology.volume == 0 and not inspection.hole_count
    copies_dropped = after.triangles < topology.triangles  # orienting does that, too
    hole, cracks = inspection.largest_hole, inspection.cracks
    health = MeshHealth(
        vertices=topology.vertices,
        triangles=topology.triangles,
        components=topology.components,
        boundary_edges=topology.boundary_edges,
        nonmanifold_edges=topology.nonmanifold_edges,
        misoriented_edges=topology.misoriented_edges,
        degenerate_triangles=topology.degenerate_triangles,
        duplicate_triangles=topology.duplicate_triangles,
        cracks=cracks,
        holes=inspection.hole_count,
        largest_hole=hole[1] if hole else 0.0,
        closed=after.closed if cracks else topology.closed,
        manifold=topology.manifold,
        oriented=topology.oriented,
        volume=after.volume if cracks else topology.volume,
        inside_out=turned and topology.oriented and not copies_dropped,
        double_sided=double_sided,
        flat=not after.solid and inspection.mesh.is_flat(),
        solid=after.solid,
    )
    return Examined(inspection.mesh, topology, health, tuple(_warnings(health, turned)))


def _warnings(health: MeshHealth, turned: bool) -> list[tuple[str, str]]:
    warnings = []
    sheet = "a sheet, which has no inside"
    if health.cracks:
        cracks = _count(health.cracks, "crack")
        warnings.append(("cracks", f"{cracks} no wider than the precision of the file: closed"))
    if health.holes:
        holes, size = _count(health.holes, "hole"), f"{health.largest_hole:.3g}"
        largest = "" if health.holes == 1 else "the largest "
        extent = f"{largest}in a box {size} from corner to corner"
        beside = "next to a hole nothing is inside or outside"
        warnings.append(("not-closed", f"{holes}, {extent}: {beside}"))
    elif health.boundary_edges and not health.closed:
        edges = _count(health.boundary_edges, "boundary edge")
        warnings.append(("not-closed", f"{edges}, all of flat parts: sheets, which have no inside"))
    if health.double_sided:
        warnings.append(("double-sided", f"every face exists in both orientations: {sheet}"))
    elif health.nonmanifold_edges:
        edges = _count(health.nonmanifold_edges, "edge")
        verb = "has" if health.nonmanifold_edges == 1 else "have"
        warnings.append(("not-manifold", f"{edges} {verb} more than two triangles"))
    if health.misoriented_edges:
        edges = _count(health.misoriented_edges, "misoriented edge")
        outcome = "repaired" if turned and health.solid else "not repaired"
        warnings.append(("misoriented", f"inconsistent face orientation ({edges}): {outcome}"))
    if health.inside_out:
        what = "the mesh" if health.components == 1 else "at least one part of the mesh"
        volume = f" (volume {health.volume:g})" if health.volume else ""
        warnings.append(("inside-out", f"{what} faced inward{volume}: turned"))
    if health.flat:
        warnings.append(("flat", f"all triangles lie in one plane: {sheet}"))
    elif health.closed and not (health.solid or health.double_sided or health.holes):
        warnings.append(("no-volume", f"closed, with no volume: {sheet}"))
    if health.degenerate_triangles:
        triangles = _count(health.degenerate_triangles, "triangle")
        warnings.append(("degenerate-triangles", f"{triangles} of area 0"))
    if health.duplicate_triangles and not health.double_sided:
        triangles = _count(health.duplicate_triangles, "triangle")
        verb = "repeats" if health.duplicate_triangles == 1 else "repeat"
        warnings.append(("duplicate-triangles", f"{triangles} {verb} an earlier one"))
    return warnings


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
