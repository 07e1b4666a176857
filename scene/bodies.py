"""The bodies of a scene: a mesh, a placement, and the health of the mesh."""

from __future__ import annotations

from collections.abc import Mapping
from math import frexp
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from satcheck.core import Mesh, largest_placed, largest_stretch
from satcheck.core.errors import SatcheckError
from satcheck.core.mesh_health import MeshHealth
from satcheck.core.shapes import HalfSpace
from satcheck.core.transform import Transform
from satcheck.scene.issue import Issue
from satcheck.scene.motion import Motion, refuse_second_motions
from satcheck.scene.planar.outline import Outline, Shape

if TYPE_CHECKING:
    from satcheck.scene.files.readers import ReadOptions
    from satcheck.scene.robot import Posture, SceneRobot
    from satcheck.scene.robot.joint_path import JointPath
    from satcheck.scene.rules import Rule
    from satcheck.scene.statics import BodyRule, StaticsTerms

# Coordinates in float64 are rounded where they are stored and where they were computed, at least by
# a rotation R and a shift t: by u = 2^-53 of each of the products, of both sums of products, and of
# the sum with t. Let c be the largest coordinate. A vertex p of a body that has the origin of its
# own frame within its box is at most r = 2 sqrt(3) c from it. The products move the vertex by
# at most u sqrt(3) r, as the squares of all entries of R sum up to 3, the sums by u (r + r), and
# the last sum by u sqrt(3) c: by less than 16 u c in all.
FLOAT64_STEP = 2.0**-49
UNITS_UNKNOWN = "units-unknown"
IDENTITY: Transform = tuple(float(row == column) for row in range(4) for column in range(4))


class MeshFile(Struct, frozen=True):
    """One mesh file flattened into one mesh, or one mesh of a file. Lengths are in file units.

    path: as given, with "/". sha256: of the file's bytes; None: not needed. format: "obj",
    "stl", "ply", "off", "glb", "gltf", "3mf" or "dae", or "shape": a primitive from the scene file
    at `path`. resolution: the precision of its coordinates, in file units. units: as the file
    declares them. mesh: welded, and wound outward if its orientation can be decided. issues:
    warnings about this file. part: the name of the
    mesh in the file, which then has its own coordinates; None: the whole file, placed as it says.
    outline: the corners, counter-clockwise, of the convex polygon over which the mesh is a prism,
    in a check in a plane. placement_step: the relative precision of its placement in the world, as
    a share of the world coordinates. deviation: in a check in a plane, the largest distance between
    a curve and the polygon within it that replaces it; the resolution includes it.
    surface_tolerance: how far its facets may be off the curved surfaces of the file, because the
    reader made them; 0: the file has facets. prepared: where checks keep what they derive from the
    mesh, for later ones; None: they keep nothing.
    """

    path: str
    sha256: str | None
    format: str
    resolution: float
    units: str | None
    mesh: Mesh
    health: MeshHealth
    issues: tuple[Issue, ...]
    part: str | None = None
    outline: tuple[tuple[float, float], ...] | None = None
    placement_step: float = FLOAT64_STEP
    deviation: float = 0.0
    surface_tolerance: float = 0.0
    prepared: dict[Any, Any] | None = None


class Body(Struct, frozen=True):
    """A mesh file, or a primitive shape, placed in the world.

    transform: row-major 4x4 for column vectors, world = transform * (x, y, z, 1) for a point of the
    mesh, affine and not singular; None: as in the file. groups: bodies of one group may be exempt
    from each other. shape: the shape whose mesh is `file`, in units of the mesh; None: `file` is on
    disk. path: of the node within the file; None: all of the file. static: it belongs to the
    surroundings, see `Scene.check_static`. pinned: `satcheck resolve` does not move it. units: of
    the world coordinates; None: unknown. unit_scale: the factor of unit conversion in the
    transform; None: no conversion. surface_tolerance: how far its surface may be off, world units;
    None: the scene does not say. open: its mesh is meant to be open: sheets, not a solid with
    holes.
    as_given: in a check in a plane, the body whose outline this is. link: the rigid body that the
    file makes it a part of; None: it states none.
    """

    id: str
    name: str
    file: MeshFile
    transform: Transform | None = None
    groups: tuple[str, ...] = ()
    static: bool = False
    shape: Shape | None = None
    path: str | None = None
    pinned: bool = False
    units: str | None = None
    unit_scale: float | None = None
    surface_tolerance: float | None = None
    open: bool = False
    as_given: Body | None = None
    link: str | None = None

    def world_mesh(self) -> Mesh:
        """The mesh in world coordinates, each rounded once. Raises ValueError on overflow."""
        if self.transform is None:
            return self.file.mesh
        return self.file.mesh.transformed(self.transform)

    @property
    def resolution_world(self) -> float:
        """Precision of the world coordinates: the file's resolution, stretched by the transform,
        plus the precision of the placement."""
        stretch = 1.0 if self.transform is None else largest_stretch(self.transform)
        largest = self.file.mesh.largest_coordinate
        return resolution_in_world(self.file, self.transform, largest, stretch)

    @property
    def facet_tolerance(self) -> float:
        """Return how far facets that a reader made may be off the surfaces of the file, world
        units."""
        given = self.as_given or self
        off = given.file.surface_tolerance
        if not off or given.transform is None:
            return off
        return off * largest_stretch(given.transform)


def is_half_space(body: Body) -> bool:
    return isinstance(body.shape, HalfSpace)


class Unreadable(Struct, frozen=True):
    """A body that could not be loaded, and why."""

    id: str
    file: str
    issue: Issue
    groups: tuple[str, ...] = ()
    path: str | None = None
    static: bool = False
    link: str | None = None


class Entry(Struct, frozen=True):
    """Where an input states a body. file: the scene file or the robot, as given. number: of the
    body in the scene file, from 0; None: it is at the line. text: of the scene file."""

    file: str
    number: int | None = None
    line: int | None = None
    text: str = ""


class Accepted(Struct, frozen=True):
    """What a scene file accepts: text: CODE or CODE:NAME. about: the file, the files that it names,
    and its bodies; None: all."""

    text: str
    about: frozenset[str] | None = None


class Scene(Struct, frozen=True):
    """All inputs of a check, in the order given.

    order: the ids of bodies and unreadable ones together, in the order given.
    units: of all lengths, as declared or converted; None if the unit of a body is unknown.
    ignore_within_groups: groups whose bodies are not checked against each other.
    rules: for pairs, in addition to the settings of a check. A later rule overrides an earlier one.
    check_static: whether pairs of two static bodies are checked.
    composed: at least one input is a file that places bodies.
    issues: all of them, those of `unreadable` and of each mesh file included.
    motions: at most one for each body (SatcheckError otherwise). Unknown ids are ignored.
    entries: id -> where a scene file or a robot states the body.
    robots: can be posed with `robot.posed`. posture: their joint values; None without robots.
    reading: the options that were given for reading the files. body_rules: questions about the
    support of single bodies. statics: gravity and friction, as stated; None: not stated.
    joint_path: along which the robots move; they stand in its first pose. accept: issues that block
    no pass.
    """

    name: str
    units: str | None
    bodies: tuple[Body, ...]
    unreadable: tuple[Unreadable, ...] = ()
    ignore_within_groups: frozenset[str] = frozenset()
    rules: tuple[Rule, ...] = ()
    check_static: bool = True
    composed: bool = False
    issues: tuple[Issue, ...] = ()
    order: tuple[str, ...] = ()
    motions: tuple[Motion, ...] = ()
    entries: Mapping[str, Entry] = {}
    robots: tuple[SceneRobot, ...] = ()
    posture: Posture | None = None
    reading: ReadOptions = {}
    body_rules: tuple[BodyRule, ...] = ()
    statics: StaticsTerms | None = None
    joint_path: JointPath | None = None
    accept: tuple[Accepted, ...] = ()

    def __post_init__(self) -> None:
        if self.motions:
            refuse_second_motions(self.motions)

    @property
    def asks_for_support(self) -> bool:
        """Return whether a rule asks if bodies are held."""
        return any(rule.supported or rule.stable for rule in self.body_rules)

    @property
    def asks_for_regions(self) -> bool:
        """Return whether a rule asks if bodies lie in a region."""
        return any(rule.inside is not None for rule in self.body_rules)

    def require_one_unit(self) -> None:
        """Raises SatcheckError (`units-unknown`) if the bodies have no common unit of length."""
        if len({body.units for body in self.bodies}) > 1:
            said = next(issue for issue in self.issues if issue.code == UNITS_UNKNOWN)
            raise SatcheckError(UNITS_UNKNOWN, said.message)

    def require_in_space(self, instead: str) -> None:
        """Raises SatcheckError (`planar-only`) if the shape of a body is an outline. instead: the
        end of the message, which says what to do, or why a command cannot check outlines."""
        flat = next((body for body in self.bodies if isinstance(body.shape, Outline)), None)
        if flat is not None:
            message = f"{flat.file.path}: {flat.id} is an outline, which is flat: {instead}"
            raise SatcheckError("planar-only", message)

    def reaching(self, room: float = 1.0) -> Scene:
        """Return the scene with half spaces that reach beyond its bodies. room: how many times as
        far."""
        if not any(map(is_half_space, self.bodies)):
            return self
        from satcheck.scene.half_spaces import with_reach

        return with_reach(self, room)

    def in_order(self) -> list[Body | Unreadable]:
        """All bodies, readable or not. Bodies that `order` does not name come last."""
        rank = {id_: number for number, id_ in enumerate(self.order)}
        everything: list[Body | Unreadable] = [*self.bodies, *self.unreadable]
        return sorted(everything, key=lambda body: rank.get(body.id, len(rank)))


def resolution_in_world(
    file: MeshFile, transform: Transform | None, largest: float, stretch: float
) -> float:
    """See `Body.resolution_world`. largest: the largest |coordinate| of the file's mesh. stretch:
    how much the transform stretches lengths at most."""
    if transform is None:
        return file.resolution
    if _is_exact_scaling(transform):
        return file.resolution * transform[0]
    step = largest_placed(transform, largest) * file.placement_step
    return file.resolution * stretch + step


def _is_exact_scaling(transform: Transform) -> bool:
    """Return whether the transform scales by a power of two about the origin, which is exact."""
    scale = transform[0]
    if frexp(scale)[0] != 0.5 or any(transform[3:12:4]):
        return False
    return transform == (*(scale * entry for entry in IDENTITY[:12]), *IDENTITY[12:])
