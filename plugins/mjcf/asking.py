"""Asks the child process in which MuJoCo reads MJCF files."""

from __future__ import annotations

from pathlib import Path

from satcheck.plugins.mjcf.messages import Model
from satcheck.plugins.mjcf.readers import ENDING
from satcheck.plugins.mjcf.reading import robot_of_model
from satcheck.scene.errors import Refused
from satcheck.scene.issue import Issue
from satcheck.scene.loading.readers import File, RobotFile
from satcheck.scene.loading.reading_children import read_in_child
from satcheck.scene.robot.model import Robot
from satcheck.scene.robot.xml_tree import Element

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
        permitted=allowed.permitted,
        path=path,
        packages={name: str(place) for name, place in robot.packages.items()},
    )
    model = read_in_child(file, _MODEL, Model, robot.children, allowed)
    return robot_of_model(path, model, robot.geometry, hulls=bool(allowed.options.mesh_hulls))
