"""Asks the child process in which MuJoCo reads MJCF files."""

from __future__ import annotations

from pathlib import Path

from msgspec import Struct
from msgspec.structs import replace

from satcheck.plugins.mjcf.readers import ENDING
from satcheck.scene.errors import Refused
from satcheck.scene.issue import Issue
from satcheck.scene.loading.readers import File, RobotFile
from satcheck.scene.loading.reading_children import read_in_child
from satcheck.scene.loading.xml_tree import Element
from satcheck.scene.robot.model import Robot


class Answer(Struct, frozen=True, tag=True):
    """What the child process answers."""

    robot: Robot
    issues: tuple[Issue, ...]


_MODEL = "satcheck.plugins.mjcf.child:model"


def read_mjcf(root: Element, robot: RobotFile) -> tuple[Robot, tuple[Issue, ...]]:
    """Return the robot of a file, in its pose qpos0, and issues. Raises Refused."""
    path, allowed = root.file, robot.allowed
    location = Path(path)
    if location.suffix.lower() != ENDING:
        message = f"MuJoCo reads files that end in {ENDING}: rename it"
        raise Refused("unsupported-format", message, file=path)
    file = File(
        "mjcf",
        str(location.parent),
        location.name,
        b"",
        0,
        replace(allowed.options, geometry=robot.geometry),
        permitted=allowed.permitted,
        path=path,
        packages={name: str(place) for name, place in robot.packages.items()},
    )
    answer = read_in_child(file, _MODEL, Answer, robot.children, allowed)
    return answer.robot, answer.issues
