"""Decides the kind of an input by its ending; for an unknown ending, by the root of its XML."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from satcheck.core.errors import SatcheckError
from satcheck.scene.files.readers import (
    RobotReader,
    mesh_reader,
    readers,
    robot_reader,
    robots,
    robots_of,
)
from satcheck.scene.opening import size_of
from satcheck.scene.paths import suffix_of

InputKind = Literal["mesh", "document", "scene", "robot", "srdf"]

SCENE_SUFFIXES = frozenset((".json", ".toml"))
_SRDF = ".srdf"
_XACRO = ".xacro"  # expands to a URDF or an SRDF
# Elements of an SRDF that no URDF has. The outermost element of both is <robot>.
_SRDF_ELEMENTS = frozenset(
    ("group", "group_state", "end_effector", "virtual_joint", "passive_joint", "joint_property")
) | {"disable_collisions", "enable_collisions", "disable_default_collisions"}
_HEAD_BYTES = 1 << 20


def kind_of(path: str) -> InputKind:
    """ "mesh" if no other kind fits. Its reader then reports errors."""
    suffix = suffix_of(path).lower()
    if suffix in SCENE_SUFFIXES:
        return "scene"
    if suffix == _SRDF:
        return "srdf"
    reader = mesh_reader(suffix)
    if reader is not None:
        return "document" if reader.kind == "document" else "mesh"
    if robots_of(suffix) and suffix not in readers():
        return "robot"
    root, *below = _first_elements(Path(path))
    if root == "robot":
        return "srdf" if below and below[0] in _SRDF_ELEMENTS else "robot"
    return "robot" if suffix == _XACRO or robot_reader(root) is not None else "mesh"


def robot_endings() -> frozenset[str]:
    """Return the endings of files that are robots, whatever they hold: of no other format."""
    endings = {ending for reader in robots().values() for ending in reader.endings}
    return frozenset(endings - readers().keys())


def is_robot(location: Path) -> bool:
    """Return whether the outermost element is that of a robot."""
    return reader_of_robot(location) is not None


def reader_of_robot(location: Path) -> RobotReader | None:
    """Return the reader of robots with this outermost element; None: it is none of a robot."""
    return robot_reader(_first_elements(location)[0])


def _first_elements(location: Path) -> list[str]:
    """The names of the root and of its first element; [""] if the file is not XML."""
    try:
        size_of(location)
        with location.open("rb") as file:
            head = file.read(_HEAD_BYTES)
    except (SatcheckError, OSError):  # reported when the file is read
        return [""]
    if not head.lstrip().startswith((b"<", b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff")):
        return [""]
    from satcheck.scene.robot.reading import first_tags

    return first_tags(head, 2) or [""]
