"""Asks the child process in which MuJoCo reads MJCF files."""

from __future__ import annotations

from pathlib import Path

import msgspec

from satcheck.core.worker import WorkerError
from satcheck.plugins.mjcf.messages import Answer, Model, Request
from satcheck.plugins.mjcf.readers import ENDING
from satcheck.plugins.mjcf.reading import robot_of_model
from satcheck.scene.errors import MeshFileError
from satcheck.scene.files_read import note, note_lost_reader
from satcheck.scene.issue import CODES, Issue
from satcheck.scene.loading.child_formats import refused_by_worker
from satcheck.scene.loading.raw_mesh import Refusal
from satcheck.scene.loading.readers import RobotFile
from satcheck.scene.loading.xml_tree import Element
from satcheck.scene.robot.model import Robot

_CHILD = "satcheck.plugins.mjcf.child"


def read_mjcf(root: Element, file: RobotFile) -> tuple[Robot, tuple[Issue, ...]]:
    """Return the robot of a file, in its pose qpos0, and issues. Raises MeshFileError."""
    path = root.file
    if Path(path).suffix.lower() != ENDING:
        message = f"MuJoCo reads files that end in {ENDING}: rename it"
        raise MeshFileError("unsupported-format", message, file=path)
    packages = {name: str(place) for name, place in file.packages.items()}
    model = _asked(Request(path, packages, file.allowed.permitted), file)
    return robot_of_model(path, model, file.geometry, hulls=file.hulls)


def _asked(request: Request, robot: RobotFile) -> Model:
    file, allowed = request.path, robot.allowed
    try:
        sent = msgspec.msgpack.encode(request)
        reply = robot.children.ask(_CHILD, sent, seconds=allowed.seconds)
        answer = msgspec.msgpack.decode(reply, type=Answer)
    except WorkerError as error:
        note_lost_reader()
        raise refused_by_worker(error, "mjcf", file, allowed.megabytes) from error
    except msgspec.DecodeError:
        raise MeshFileError("reader-failed", "the reader's answer is damaged", file=file) from None
    for name in answer.files:
        note(name)
    content = answer.content
    if isinstance(content, Refusal):
        code = content.code if content.code in CODES else "reader-failed"
        raise MeshFileError(code, content.message, file=file)
    return content
