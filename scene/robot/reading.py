"""Reads a robot: the outermost element says with which reader."""

from __future__ import annotations

from pathlib import Path

from satcheck.scene.issue import Issue, issue
from satcheck.scene.loading.readers import RobotFile, robot_reader, robots
from satcheck.scene.robot.model import Robot
from satcheck.scene.robot.xml_tree import read_tree, refuse_root


def read_robot(path: str, location: Path, file: RobotFile) -> tuple[Robot, tuple[Issue, ...]]:
    """Return the robot, and issues. Raises Refused with the file, the line and the element.

    path: of the file, for messages; location: where it lies. No mesh is opened.
    """
    root = read_tree(path, location)
    reader = robot_reader(root.tag)
    if reader is None:
        refuse_root(root, robots())
    robot, issues = reader.function()(root, file)
    if file.geometry == "visual":
        message = "visual geometry is checked, not collision geometry"
        issues = (*issues, issue("visual-geometry", message, file=path))
    return robot, issues
