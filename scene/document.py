"""What an input states, whatever its format: bodies, and what is said about them.

Every reader leads to a `Document`. A robot is a document with joints; a scene file is one whose
items name other files (`scene_file.joined.SceneFile`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from satcheck.core.transform import Transform
from satcheck.scene.bodies import Entry, MeshFile
from satcheck.scene.errors import Refused
from satcheck.scene.files.raw_mesh import RawJoint, RawRule
from satcheck.scene.issue import Issue
from satcheck.scene.planar.outline import Shape

if TYPE_CHECKING:
    from satcheck.scene.robot.model import Robot

# "scene": it places bodies. "rules": a scene file without bodies.
Kind = Literal["mesh", "scene", "robot", "rules"]


class FilePart(Struct, frozen=True):
    """A mesh file that another file names. path: in messages and reports. location: on disk. part:
    the path of a node in it, see `MeshFiles.item`; None: all of the file."""

    path: str
    location: str
    part: str | None = None


class Item(Struct, frozen=True):
    """A body as a file states it.

    path: of a node of this file, unique; it ends in "#3" for the third component. None: all of it,
    or no node. id: that is wanted for the body; "": it follows from the path. shape: a mesh
    of the file, which items may share; where another file has it; an exact one or an outline; or
    why it cannot be used. transform: as in Body, in units of the file; of a
    robot in the frame of the link. title: a name for people; None: the id. groups: as the file
    names them. static, pinned: as in Body. link: the rigid body that joints move it with. units: of
    the mesh; they override those that its own file states. surface_tolerance: as in Body, in units
    of the document. entry: where it is stated.
    """

    shape: MeshFile | FilePart | Shape | Refused
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


class Document(Struct, frozen=True, kw_only=True):
    """One input of a check.

    units: as it declares them. issues: that concern no single item. pairs: rules for two items, or
    for two groups, of which a later one overrides an earlier one. joints: as the file places their
    links. robot: its links and joints, if it is the file of a robot.
    """

    path: str
    name: str
    kind: Kind
    units: str | None = None
    items: tuple[Item, ...]
    issues: tuple[Issue, ...] = ()
    pairs: tuple[RawRule, ...] = ()
    joints: tuple[RawJoint, ...] = ()
    robot: Robot | None = None
