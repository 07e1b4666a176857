"""Issues of the inputs, each with a code, a place and a sentence, and the catalogue of codes.

`error`: the file or the scene cannot be used. `warning`: it is used, but the user should know.
Warnings that block a pass are about what may make, move or hide a body.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

Severity = Literal["error", "warning", "note"]
UNUSED_OPTION = "unused-option"


class Code(Struct, frozen=True):
    """One kind of problem with an input. blocks: bodies may be missing, or stand elsewhere, so that
    a check does not pass until the issue is accepted."""

    name: str
    severity: Severity
    meaning: str
    blocks: bool = False


_ALL = (
    # The file as a file.
    Code("file-not-found", "error", "There is no file at this path."),
    Code("not-a-file", "error", "The path names a directory, a pipe or a device."),
    Code("unreadable-file", "error", "The operating system refused to read the file."),
    Code("unsupported-format", "error", "The name's suffix belongs to no format that is read."),
    Code("format-mismatch", "error", "The content is of another format than the suffix says."),
    Code("not-this-format", "error", "The content is not of the format that the suffix says."),
    Code("too-large", "error", "The file, or what it unpacks to, exceeds a size limit."),
    Code("reader-timeout", "error", "Reading the file took longer than the time limit."),
    Code("reader-out-of-memory", "error", "Reading the file took more memory than the limit."),
    Code("reader-failed", "error", "The reader of this format failed on the file."),
    # Of `satcheck batch`: the other files and pairs of the scene are checked.
    Code("worker-crashed", "warning", "The process that worked on it died, time and again."),
    Code("worker-timeout", "warning", "Work on it took longer than the time limit of a scene."),
    Code("worker-out-of-memory", "warning", "Work on it took more memory than the limit."),
    Code("unread-file", "warning", "No reader knows the format of a file.", blocks=True),
    # Its records.
    Code("truncated", "error", "The file ends before its declared end."),
    Code("trailing-data", "error", "The file continues after its declared end."),
    Code("count-mismatch", "error", "A declared number of records does not match the content."),
    Code("bad-record", "error", "A record is not what the format prescribes."),
    Code("bad-encoding", "error", "Text is not in an encoding the format allows."),
    Code("unsupported-feature", "error", "The geometry needs a feature that is not read."),
    Code("index-out-of-range", "error", "A face or a reference names a missing item."),
    Code("misspelt", "error", "A name resembles one that is read, and is none."),
    Code("reference-cycle", "error", "Nodes or components refer to each other in a cycle."),
    Code("missing-resource", "error", "A file that this file refers to is missing."),
    Code(
        "outside-path",
        "error",
        "A file that this file refers to lies outside of the permitted folders.",
    ),
    Code("unknown-part", "error", "The file has no part of this name."),
    Code("missing-extra", "error", "The library that reads the format is not installed."),
    Code("entity-declaration", "error", "XML entity declarations are refused."),
    # Its geometry.
    Code("non-finite", "error", "A coordinate is infinite or not a number."),
    Code("out-of-range", "error", "The coordinates are too large or too small to be exact."),
    Code("empty-mesh", "error", "The mesh has no triangles."),
    Code("no-body", "error", "The file has no geometry that is checked."),
    Code("only-degenerate", "error", "Every triangle of the mesh has area 0."),
    Code("too-many-steps", "error", "Inspecting the mesh takes more steps than a mesh may."),
    Code("singular-transform", "error", "A transform flattens the body, or is not affine."),
    Code("short-face", "warning", "A face with fewer than 3 vertices was ignored."),
    Code("unknown-statement", "warning", "A line without geometry is unknown to the format."),
    Code("unread", "warning", "What may hold, move or hide a body is not read.", blocks=True),
    Code("incomplete", "warning", "Its reader may leave something out, unsaid.", blocks=True),
    Code("ignored-geometry", "warning", "Geometry that is not made of triangles was ignored."),
    Code("no-surface", "warning", "A mesh has only lines or points: its pairs are not checked."),
    Code("not-a-body", "note", "Hidden geometry, or geometry of another purpose, has no body."),
    Code("control-cage", "warning", "A subdivision surface is checked as its control cage."),
    Code("time-sampled", "note", "The file is animated: bodies stand as at one time."),
    Code("assumed-units", "note", "The file states no unit: the default of its format counts."),
    Code("ignored-opinion", "warning", "A part of the file that moves no body was ignored."),
    Code("rest-shape", "warning", "A deformable mesh is checked in its stored shape."),
    Code("left-out", "note", "What is no body of a document was left out, or is not applied."),
    Code("far-vertex", "note", "A vertex far from most others makes the precision coarse."),
    Code("faceted", "note", "Curved surfaces are checked as the facets that replace them."),
    Code("cracks", "warning", "Faces miss each other by the precision of the file; closed."),
    Code(
        "not-closed",
        "warning",
        "The surface has holes, so inside and outside are undefined near them.",
    ),
    Code("not-manifold", "warning", "An edge has more than two triangles."),
    Code("misoriented", "warning", "Neighbouring triangles disagree on which side is outside."),
    Code("inside-out", "warning", "The mesh, or a part of it, faced inward and was turned."),
    Code(
        "doubtful-cavity",
        "warning",
        "What faces outward in a part that faces inward, or cavities that cross, may be solid.",
    ),
    Code("double-sided", "warning", "Each face exists in both orientations: the mesh is a sheet."),
    Code("flat", "warning", "All triangles lie in one plane: the mesh has no volume."),
    Code("no-volume", "warning", "The mesh is closed and encloses no volume: it is a sheet."),
    Code("degenerate-triangles", "warning", "Some triangles have area 0."),
    Code("duplicate-triangles", "warning", "Some triangles occur more than once."),
    # The robot: URDF, SRDF, SDFormat, MJCF and the values of joints.
    Code("bad-robot", "error", "The file of a robot is not what its format prescribes."),
    Code("xacro", "error", "The file has macros (xacro, ERB) and has to be expanded first."),
    Code("other-robot", "warning", "The SRDF names another robot than the one that is given."),
    Code("unknown-element", "warning", "An element is unknown to the format.", blocks=True),
    Code("unknown-attribute", "warning", "An attribute is unknown to the format.", blocks=True),
    Code("no-shape", "warning", "An element of size 0, or without geometry, has no body."),
    Code("no-limits", "warning", "A joint has no usable limits and is treated as unlimited."),
    Code("no-leader", "warning", "A joint mimics a missing joint and moves independently."),
    Code("no-collision-geometry", "note", "Links with only visual geometry have no body."),
    Code("visual-geometry", "note", "Visual geometry is checked, not collision geometry."),
    Code("simplified-mesh", "warning", "A simulator replaces the mesh that is checked."),
    Code("mesh-or-hull", "note", "A simulator replaces meshes by hulls: which is checked."),
    Code("constraint-not-solved", "warning", "What connects bodies beside joints is not solved."),
    Code("keyframe-not-read", "warning", "Keyframes of the file are no states."),
    Code("joint-not-moved", "warning", "A joint of this kind, or of a loop, is not moved."),
    Code("stored-state", "warning", "A stored state is not applied.", blocks=True),
    Code("neighbours-checked", "note", "Links that a joint connects are checked as well."),
    Code("beyond-limits", "warning", "A joint stands beyond its limits."),
    Code("not-at-zero", "note", "0 is beyond the limits of a joint without a value in the pose."),
    Code("mimic-differs", "warning", "A pose contradicts the joint that a mimic joint follows."),
    # Flat bodies.
    Code("no-outline", "error", "The body has no extent in the plane of the check."),
    Code("open-outline", "error", "The outline of the body depends on how its holes are filled."),
    Code("planar-only", "error", "An outline is flat: it is checked in a plane only."),
    Code("planar-volume", "error", "A rule with a max_volume is not checked in a plane."),
    Code("planar-motion", "error", "A scene with motions is not checked in a plane."),
    # The scene file.
    Code("bad-scene", "error", "The scene file is not what its form prescribes."),
    Code("duplicate-id", "error", "Two bodies of a scene have the same id."),
    Code("bad-rule", "error", "A rule of a scene is malformed or has no effect."),
    Code("bad-motion", "error", "A motion of a scene is malformed, or moves a body twice."),
    Code("unknown-key", "warning", "A key at the top of the scene is unknown.", blocks=True),
    Code(UNUSED_OPTION, "note", "No reader of the files has an option that is given."),
    Code("up-axis", "note", "The file says which axis points up: that turns nothing."),
    Code(
        "axes-unclear",
        "warning",
        "A file that says which axis points up stands beside one that does not.",
        blocks=True,
    ),
    Code("units-converted", "note", "Files in other units were converted to units of the check."),
    Code("units-unknown", "warning", "Only some bodies have a stated unit of length."),
    Code("unknown-units", "warning", "The declared units are not a known unit of length."),
    Code("unknown-group", "warning", "An ignored group has no body in the scene."),
    Code("unknown-body", "warning", "An allowed pair names a body that the scene lacks."),
)

CODES: dict[str, Code] = {code.name: code for code in _ALL}
BLOCKING = tuple(code.name for code in _ALL if code.blocks)


class Issue(Struct, frozen=True):
    """A problem with an input. `code` is one of CODES and decides the severity.

    body: id of the body concerned; file: path as given. Either may be None.
    """

    code: str
    severity: Severity
    body: str | None
    file: str | None
    message: str


def issue(code: str, message: str, *, body: str | None = None, file: str | None = None) -> Issue:
    """An Issue with the severity that the catalogue gives its code."""
    return Issue(code, CODES[code].severity, body, file, message)
