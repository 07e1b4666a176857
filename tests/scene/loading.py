"""One file of given bytes through `load_scene`, as the tests need it."""

from __future__ import annotations

from pathlib import Path

from satcheck.scene import MeshFile, Scene, load_scene


def load(folder: Path, name: str, content: bytes) -> Scene:
    path = folder / name
    path.write_bytes(content)
    return load_scene([path], split="none")


def loaded(folder: Path, name: str, content: bytes) -> MeshFile:
    scene = load(folder, name, content)
    assert not scene.unreadable, scene.issues
    return scene.bodies[0].file


def refusal(folder: Path, name: str, content: bytes) -> tuple[str, str]:
    """(code, message) of a file that must be refused."""
    scene = load(folder, name, content)
    assert not scene.bodies
    (issue,) = scene.issues
    assert issue is scene.unreadable[0].issue
    assert issue.severity == "error"
    assert name in issue.message
    assert "\n" not in issue.message
    return issue.code, issue.message


def warnings(file: MeshFile) -> dict[str, str]:
    assert all(issue.severity == "warning" for issue in file.issues)
    return {issue.code: issue.message for issue in file.issues}
