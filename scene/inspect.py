"""Makes a MeshFile: of a mesh as read, of a shape, or of a new mesh for a file. Each mesh is
inspected here, once: its topology, what is repaired and what to warn about, and its resolution, how
far the rounding of its coordinates may move a vertex.

The resolution follows from the number format in which the file stores coordinates. The default
tolerance is the sum of the resolutions of both bodies, so that rounding alone is no overlap of
bodies that fit.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import (
    Inspection,
    Mesh,
    TooManySteps,
    inspect,
    inspect_bytes,
    with_cracks_closed,
)
from satcheck.core.conventions import LARGEST_LENGTH, SMALLEST_SIZE
from satcheck.core.errors import SatcheckError
from satcheck.core.mesh_health import MeshHealth
from satcheck.core.shape_mesh import DEFAULT_SEGMENTS, mesh_of
from satcheck.core.shapes import Primitive, sizes_of, values_of
from satcheck.core.steps import not_for_lack_of_memory
from satcheck.scene.bodies import FLOAT64_STEP, MeshFile
from satcheck.scene.document import NumberFormat, RawMesh
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import File
from satcheck.scene.issue import issue
from satcheck.scene.planar.outline import Outline, Shape
from satcheck.scene.words import told_apart

SHAPE_FORMAT = "shape"


@contextmanager
def errors_of(path: str) -> Iterator[None]:
    """Raise what goes wrong with a file meanwhile as Refused with its name, also what no reader
    checks."""
    try:
        yield
    except SatcheckError as error:
        message = error.with_line if isinstance(error, Refused) else error.message
        raise Refused(error.code, message, file=path) from error.__cause__
    except TooManySteps as error:
        message = "a mesh takes too many steps to inspect: simplify it, or split it"
        raise Refused("too-many-steps", message, file=path) from error
    except MemoryError as error:
        not_for_lack_of_memory(error)
        raise Refused("reader-out-of-memory", "out of memory", file=path) from error
    except (OverflowError, ValueError) as error:
        code = "out-of-range" if isinstance(error, OverflowError) else "bad-record"
        raise Refused(code, str(error), file=path) from error


def mesh_file(
    file: File,
    raw: RawMesh,
    mesh: Mesh | None = None,
    part: str | None = None,
    *,
    placed: bool = False,
) -> MeshFile:
    """Inspect a mesh of a file.

    raw: the mesh as read. mesh: a piece of it, or all of it, in place of its bytes; None: all.
    part: its name in the file. placed: the file itself places it. Raises what `errors_of` takes.
    """
    if not (raw.triangles if mesh is None else mesh.triangle_count):
        vertices = len(raw.vertices) // 24
        has = f"{vertices} vertices but" if vertices else "no vertices and"
        raise Refused("empty-mesh", f"empty mesh: {has} no triangles")
    if mesh is None:  # none is built only to be inspected
        inspection = inspect_bytes(raw.vertices, raw.triangles, True)
    else:
        inspection = inspect(mesh, True)
    examined = _examined(inspection, lambda mesh: file_resolution(raw, mesh.largest_coordinate))
    largest = examined.mesh.largest_coordinate
    precision = file_resolution(raw, largest)
    far = far_vertex(raw, examined.mesh, largest, precision)
    said = [*raw.warnings, *examined.warnings, *([("far-vertex", far)] if far else [])]
    return MeshFile(
        path=file.path,
        sha256=file.sha256,
        format=file.format,
        resolution=precision,
        units=raw.units,
        mesh=examined.mesh,
        health=examined.health,
        issues=tuple(issue(code, message, file=file.path) for code, message in said),
        part=part,
        placement_step=placement_step(raw, by_file=placed),
        surface_tolerance=raw.surface_tolerance,
    )


def shape_file(shape: Shape, path: str) -> MeshFile:
    """The mesh of the shape. path: the scene file that states it.

    sha256: of the values of the shape and the number of segments. The sizes are exact float64
    numbers, so the resolution is float64 rounding. Raises Refused (`out-of-range`).
    The mesh of a curved shape lies within the shape.
    """
    try:
        if isinstance(shape, Outline):
            examined = examine(shape.mesh(), orient=False)
        else:
            _require_in_range(shape, path)
            examined = examine(mesh_of(shape))
    except OverflowError as error:
        raise Refused("out-of-range", str(error), file=path) from None
    canonical = json.dumps([values_of(shape), DEFAULT_SEGMENTS], sort_keys=True)
    return MeshFile(
        path=path,
        sha256=hashlib.sha256(canonical.encode()).hexdigest(),
        format=SHAPE_FORMAT,
        resolution=examined.mesh.largest_coordinate * FLOAT64_STEP,
        units=None,
        mesh=examined.mesh,
        health=examined.health,
        issues=(),
    )


def _require_in_range(shape: Primitive, path: str) -> None:
    for size in sizes_of(shape):
        if not SMALLEST_SIZE <= size <= LARGEST_LENGTH:
            limit = SMALLEST_SIZE if size < SMALLEST_SIZE else LARGEST_LENGTH
            message = (
                f"the {type(shape).__name__.lower()} has a size of {told_apart(size, limit)[0]}, "
                f"out of range: sizes may be from {SMALLEST_SIZE:g} to {LARGEST_LENGTH:g}; use "
                "another unit of length"
            )
            raise Refused("out-of-range", message, file=path)


def remeshed(file: MeshFile, mesh: Mesh) -> MeshFile:
    """The file with this mesh instead, inspected and repaired as after reading.

    sha256: of the mesh, so that cached results for the mesh of the file are not used for this one.
    Raises Refused when no triangle has an area.
    """
    examined = examine(mesh, resolution=lambda _: file.resolution)
    return replace(
        file,
        sha256=hashlib.sha256(b"".join(mesh.to_bytes())).hexdigest(),
        mesh=examined.mesh,
        health=examined.health,
    )


class Examined(Struct, frozen=True):
    """A welded mesh and its health. The mesh is wound outward if its orientation can be decided.

    warnings: (code, message).
    """

    mesh: Mesh
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
    return _examined(inspect(mesh, orient), resolution, orient=orient)


def _examined(inspection: Inspection, resolution: Resolution, *, orient: bool = True) -> Examined:
    after = inspection.repaired
    if not (after.closed and after.oriented):
        width = CRACK_WIDTH * resolution(inspection.mesh)
        inspection = with_cracks_closed(inspection, orient, width)
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
    return Examined(inspection.mesh, health, tuple(_warnings(health, inspection)))


def _warnings(health: MeshHealth, inspection: Inspection) -> list[tuple[str, str]]:
    warnings = []
    turned, doubtful = inspection.turned, inspection.doubtful
    sheet = "a sheet, which has no inside"
    if health.cracks:
        cracks = _count(health.cracks, "crack")
        warnings.append(("cracks", f"{cracks} no wider than the precision of the file: closed"))
    if doubtful and not health.doubtful:
        edges = _count(health.boundary_edges, "boundary edge")
        warnings.append(("not-closed", f"open mesh ({edges})"))
    elif health.holes and not doubtful:
        holes, size = _count(health.holes, "hole"), f"{health.largest_hole:.3g}"
        largest = "" if health.holes == 1 else "largest "
        warnings.append(("not-closed", f"open mesh ({holes}, {largest}{size} across)"))
    elif health.boundary_edges and not health.closed:
        edges = _count(health.boundary_edges, "boundary edge")
        sheets = f"open mesh ({edges}, all of flat parts: sheets, which have no inside)"
        warnings.append(("not-closed", sheets))
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
    if doubtful:
        parts = "what faces outward in a part that faces inward, or two cavities that cross"
        warnings.append(("doubtful-cavity", f"{parts}, may be solid or a cavity"))
    elif health.inside_out:
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


FLOAT16_STEP = 2.0**-10  # spacing of float16 numbers relative to their power of two
FLOAT32_STEP = 2.0**-23  # the same of float32
VERTEX = math.sqrt(3)  # a vertex moves this much if each coordinate moves by 1
# A vertex is far if its largest coordinate is more than this many times the median of all vertices.
# It costs most of them four bits of precision.
FAR = 16
STEPS: dict[NumberFormat, float] = {
    "float16": FLOAT16_STEP,
    "float32": FLOAT32_STEP,
    "float64": FLOAT64_STEP,
}


def placement_step(raw: RawMesh, *, by_file: bool) -> float:
    """The relative precision of a placement, as a share of the placed coordinates.

    by_file: the file itself places its mesh. A program that stores coordinates as float32 is
    assumed to store placements no finer. All other placements are taken as written.
    """
    return FLOAT32_STEP if by_file and raw.number_format == "float32" else FLOAT64_STEP


def file_resolution(raw: RawMesh, max_coordinate: float) -> float:
    """The precision of the coordinates, in file units.

    max_coordinate: largest |coordinate| of the mesh. float16, float32: the spacing of these numbers
    at max_coordinate, which is more than half of the diagonal of a cube of that size. float64: what
    a placement rounds. Written digits: that, and half the diagonal of a cube of one unit of the
    last digit of the most precise number, but no more than for float32. The digits of a number with
    an exponent are relative to its own size, so they are counted down from the largest coordinate:
    many files write -4.4e-08 for 0, which does not promise eight decimals. Integers and packed
    data: half the diagonal of a cube of their step, if that is more.
    """
    return max(_of_the_format(raw, max_coordinate), VERTEX * raw.rounding)


def far_vertex(raw: RawMesh, mesh: Mesh, largest: float, resolution: float) -> str | None:
    """Names the vertex that sets the precision of a mesh, if most of the others would be known far
    more finely; None: no vertex does. A step of digits, integers or packed data, which is the same
    everywhere, has no such vertex. That of float64 is too fine to matter. largest: |coordinate|.
    resolution: of the file."""
    if raw.number_format == "float64" or resolution < largest * FLOAT32_STEP:
        return None
    if resolution <= VERTEX * raw.rounding:
        return None
    (x, y, z), median = mesh.far_vertex()
    if largest <= FAR * median:
        return None
    return (
        f"the vertex ({x:.6g}, {y:.6g}, {z:.6g}) makes the precision {resolution:.3g}: half of the "
        f"vertices have no coordinate beyond {median:.6g}"
    )


def _of_the_format(raw: RawMesh, max_coordinate: float) -> float:
    if raw.number_format in STEPS:
        return max_coordinate * STEPS[raw.number_format]
    float32 = max_coordinate * FLOAT32_STEP
    float64 = max_coordinate * FLOAT64_STEP
    decimals = raw.decimals
    if raw.significant > 0 and max_coordinate > 0.0:
        leading = math.floor(math.log10(max_coordinate))
        decimals = max(decimals, raw.significant - 1 - leading)
    return min(float32, float64 + VERTEX * 0.5 * 10.0**-decimals)
