"""What an input states, whatever its format: bodies, and what is said about them.

Every reader leads to a `Document`. A reader of meshes returns the meshes as they are in the file,
and items that number them; these can be sent by a child process. A robot is a document with joints;
a scene file is one whose items name other files (`scene_file.joined.SceneFile`).
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias

from msgspec import Struct

from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform
from satcheck.scene.errors import Refused
from satcheck.scene.issue import Issue
from satcheck.scene.opening import Block as Block
from satcheck.scene.opening import name_of

# "scene": it places bodies. "rules": a scene file without bodies.
Kind = Literal["mesh", "scene", "robot", "rules"]
NumberFormat = Literal["written-digits", "float16", "float32", "float64"]
RuleSeverity = Literal["error", "warning", "note"]
NO_SURFACE = "no-surface"  # the code for a mesh with lines or points only
HULL_MARK = "#hull"  # after the path of a node, or alone: the convex hull of the mesh
COMPONENT_MARK = "#"  # between the path of a node and a component number; never in names

if TYPE_CHECKING:
    from satcheck.scene.bodies import Entry, MeshFile
    from satcheck.scene.planar.outline import Shape
    from satcheck.scene.robot.model import Robot

    Held: TypeAlias = "int | MeshFile | FilePart | Shape | Refused"
else:
    # What msgspec decodes: a child process numbers its meshes, and has nothing of the others.
    Held = int
    Entry = Robot = Any


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


class FilePart(Struct, frozen=True):
    """A mesh file that another file names. path: in messages and reports. location: on disk. part:
    the path of a node in it, see `MeshFiles.item`; None: all of the file."""

    path: str
    location: str
    part: str | None = None


class Item(Struct, frozen=True):
    """A body as a file states it.

    shape: as a reader returns it the number of a part of the document, which items may share; else
    a mesh that is inspected, where another file has it, an exact one or an outline, or why it
    cannot be used. path: of a node of this file, unique; it ends in "#3" for the third component.
    None: all of it, or no node. transform: as in Body, in units of the file; of a robot in the
    frame of the link. title: a name for people; None: the id. groups: as the file names them.
    static, pinned: as in Body. link: the rigid body that joints move it with. id: that is wanted
    for the body; "": it follows from the path. units: of the mesh; they override those that its own
    file states. surface_tolerance: as in Body, in units of the document. entry: where it is stated.
    """

    shape: Held
    path: str | None = None
    transform: Transform | None = None
    title: str | None = None
    groups: tuple[str, ...] = ()
    static: bool = False
    link: str | None = None
    id: str = ""
    pinned: bool = False
    units: str | None = None
    surface_tolerance: float | None = None
    entry: Entry | None = None

    @property
    def number(self) -> int:
        """Return the number of its part in the document that a reader has returned."""
        assert isinstance(self.shape, int)
        return self.shape


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
    """A rule of a document for the pairs of two nodes or links, or of two groups. reason: a text.

    a, b: paths of nodes, links of a robot, or names of groups. severity: of findings about the
    pair; None: it may overlap, and nothing is computed, unless it is `checked` nevertheless.
    """

    a: str
    b: str
    reason: str
    of_groups: bool = False
    severity: RuleSeverity | None = None
    checked: bool = False

    @classmethod
    def within(cls, group: str, reason: str) -> RawRule:
        """Return that for the members of one group, which may overlap."""
        return cls(group, group, reason, of_groups=True)


class Document(Struct, frozen=True, tag=True):
    """One input of a check. A reader of meshes leaves out path, name, kind, issues and robot.

    parts: the meshes, each the shape of at least one item. warnings: (code, message) that concern
    no single part. units: as it declares them; of a reader: of exact shapes. pairs: rules for two
    items, or for two groups, of which a later one overrides an earlier one. joints: as the file
    places their links. issues: that concern no single item. robot: its links and joints, if it is
    the file of a robot. ignore_within_groups: groups whose bodies are not checked against each
    other. has_own_groups: its groups are none of another document, even if they have one name.
    """

    has_own_groups: ClassVar[bool] = False

    parts: tuple[RawPart, ...] = ()
    items: tuple[Item, ...] = ()
    warnings: tuple[tuple[str, str], ...] = ()
    units: str | None = None
    pairs: tuple[RawRule, ...] = ()
    joints: tuple[RawJoint, ...] = ()
    path: str = ""
    name: str = ""
    kind: Kind = "mesh"
    issues: tuple[Issue, ...] = ()
    robot: Robot | None = None
    ignore_within_groups: frozenset[str] = frozenset()

    @property
    def moves(self) -> bool:
        """Return whether joints may move its links: it is a robot, or like one."""
        return self.robot is not None or any(joint.kind != "fixed" for joint in self.joints)

    @property
    def only_mesh(self) -> RawMesh | None:
        """Return the mesh of a document that holds nothing else, and places it nowhere."""
        first, *others = self.items
        mesh = self.parts[first.number].mesh
        is_alone = first.transform is None and not (others or self.warnings)
        return mesh if isinstance(mesh, RawMesh) and is_alone else None

    def check(self) -> None:
        """Refuse what no reader may return, as a reader of another package may. Raises Refused.
        Coordinates and corners are checked where meshes are inspected."""
        if self.robot is not None:
            return  # items follow from its links
        if not self.items:
            raise Refused("empty-mesh", "empty mesh: nothing that the file places has triangles")
        if len(self.items) > 1 and len({item.path for item in self.items}) < len(self.items):
            raise Refused("reader-failed", "its reader gives two bodies one path")
        numbers = [item.number for item in self.items]
        if min(numbers) < 0 or max(numbers) >= len(self.parts):
            raise Refused("reader-failed", "its reader places a mesh that is not there")


def alone(mesh: RawMesh) -> Document:
    """Return a document of one mesh without a placement."""
    return Document((RawPart("", mesh),), (Item(0),))


class UniqueNames:
    """Makes names unique: repeated names get the suffix -2, -3, ..."""

    def __init__(self) -> None:
        self._given: dict[str, int] = {}

    def unique(self, wanted: str) -> str:
        name = wanted
        while name in self._given:
            self._given[wanted] += 1
            name = f"{wanted}-{self._given[wanted]}"
        self._given[name] = 1
        return name


def plain_ids(paths: Sequence[str]) -> list[str]:
    """One id for each path, in that order. The id is the stem. If different paths share a stem, the
    ids are the shortest ends of the paths that differ ("left/part", "right/part"), with the
    suffixes if only these differ. Paths to the same file get the same id.
    """
    same_stem: dict[str, dict[str, str]] = {}
    here = os.getcwd()  # noqa: PTH109
    places = [os.path.normpath(os.path.join(here, path)) for path in paths]  # noqa: PTH118
    for path, place in zip(paths, places, strict=True):
        same_stem.setdefault(name_of(path)[0] or path, {}).setdefault(place, path)
    ids: dict[str, str] = {}
    for stem, distinct in same_stem.items():
        names = [stem] if len(distinct) == 1 else _shortest_ends(distinct.values())
        ids.update(zip(distinct, names, strict=True))
    return [ids[place] for place in places]


def _shortest_ends(given: Iterable[str]) -> list[str]:
    paths = [PurePath(os.path.normpath(path)) for path in given]
    longest = max(len(path.parts) for path in paths)
    for named in ([path.parent / path.stem for path in paths], paths):
        for length in range(1, longest + 1):
            ends = [PurePath(*path.parts[-length:]).as_posix() for path in named]
            if len(set(ends)) == len(ends):
                return ends
    return [path.as_posix() for path in paths]


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
