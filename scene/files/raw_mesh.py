"""The result of a reader: plain arrays, their placements, and their number format."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform
from satcheck.scene.errors import Refused

NumberFormat = Literal["written-digits", "float16", "float32", "float64"]
RuleSeverity = Literal["error", "warning", "note"]
if TYPE_CHECKING:
    Block = bytes | memoryview
else:
    Block = memoryview  # the type that msgspec decodes to
NO_SURFACE = "no-surface"  # the code for a mesh with lines or points only


class RawMesh(Struct, frozen=True, tag=True):
    """A mesh as read, in file units, not welded.

    vertices: little-endian float64 x, y, z of each vertex; triangles: little-endian uint32 vertex
    numbers, three a triangle. decimals: the largest number of digits after the point in a
    coordinate without exponent. significant: the largest number of significant digits in a
    coordinate with an exponent. rounding: how far a coordinate may be off because integers or
    packed data hold it, in file units; 0: as the number format says. units: as the file declares
    them, or None. surface_tolerance: how far facets may be off the surfaces for which a reader made
    them, in file units. warnings: (code, message).
    """

    vertices: Block
    triangles: Block
    number_format: NumberFormat
    decimals: int = 0
    significant: int = 0
    units: str | None = None
    warnings: tuple[tuple[str, str], ...] = ()
    surface_tolerance: float = 0.0
    rounding: float = 0.0


class Refusal(Struct, frozen=True, tag=True):
    """Why a mesh or a file cannot be used: the code and the message of a Refused."""

    code: str
    message: str


class RawPart(Struct, frozen=True):
    """One mesh of a file in its own coordinates, an exact shape, or its Refusal. name: unique in
    the file."""

    name: str
    mesh: RawMesh | Primitive | Refusal


class RawNode(Struct, frozen=True):
    """Part number `part` and its placement. path: unique in the file; None: the whole file.

    Of a document only: title, a name for people, the path if None; groups, the names of its groups;
    static: it belongs to the surroundings; link: the rigid body that joints move it with.
    """

    path: str | None
    part: int
    matrix: Transform | None = None
    title: str | None = None
    groups: tuple[str, ...] = ()
    static: bool = False
    link: str | None = None


class RawJoint(Struct, frozen=True):
    """A joint of a document between two links, where the file places them.

    parent, child: links; None: the world. frame: a rigid pose in the world. axis: unit vector in
    the frame; the child turns or moves along it. limits, rest: radians, or metres; rest: the value
    at which the file places the links.
    """

    name: str
    kind: Literal["revolute", "prismatic", "fixed"]
    parent: str | None
    child: str | None
    frame: Transform
    axis: tuple[float, float, float]
    limits: tuple[float, float] | None
    rest: float


class RawRule(Struct, frozen=True):
    """A rule of a document for the pairs of two nodes, or of two groups. reason: a text.

    a, b: paths of nodes, or names of groups. severity: of findings about the pair; None: it may
    overlap, and nothing is computed.
    """

    a: str
    b: str
    reason: str
    of_groups: bool = False
    severity: RuleSeverity | None = None


class RawScene(Struct, frozen=True, tag=True):
    """The meshes of a file and where they are placed; every part is placed at least once.

    warnings: (code, message) that concern no single part. Of a document only: units, of exact
    shapes; rules, of which a later one overrides an earlier one; joints.
    """

    parts: tuple[RawPart, ...]
    nodes: tuple[RawNode, ...]
    warnings: tuple[tuple[str, str], ...] = ()
    units: str | None = None
    rules: tuple[RawRule, ...] = ()
    joints: tuple[RawJoint, ...] = ()

    def check(self) -> None:
        """Refuse what no reader may return, as a reader of another package may. Raises
        Refused. Coordinates and corners are checked where meshes are inspected."""
        if not self.nodes:
            raise Refused("empty-mesh", "empty mesh: the file has no body")
        if len(self.nodes) > 1 and len({node.path for node in self.nodes}) < len(self.nodes):
            raise Refused("reader-failed", "its reader gives two bodies one path")
        if not all(0 <= node.part < len(self.parts) for node in self.nodes):
            raise Refused("reader-failed", "its reader places a mesh that is not there")


def alone(mesh: RawMesh) -> RawScene:
    """A scene of one mesh without a placement."""
    return RawScene((RawPart("", mesh),), (RawNode(None, 0),))


def strip_triangles(strip: Sequence[int]) -> list[int]:
    """Corners of the triangles of a strip. Every other triangle is turned over."""
    corners: list[int] = []
    for k, (a, b, c) in enumerate(zip(strip, strip[1:], strip[2:], strict=False)):
        corners += (b, a, c) if k % 2 else (a, b, c)
    return corners


def fan_triangles(fan: Sequence[int]) -> list[int]:
    corners: list[int] = []
    for b, c in pairwise(fan[1:]):
        corners += (fan[0], b, c)
    return corners
