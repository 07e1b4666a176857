"""The name that a ROS package gives itself: <package><name> in its package.xml."""

from __future__ import annotations

from pathlib import Path

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.xml_guard import guarded_parser, parse_xml

_PACKAGE_XML = "package.xml"
MANIFESTS = (_PACKAGE_XML, "model.config")  # what marks the root of a package, of a Gazebo model
_MAX_BYTES = 1 << 20


def name_in_manifest(folder: Path) -> str | None:
    """None where there is no readable package.xml: then the name of the folder counts."""
    try:
        with (folder / _PACKAGE_XML).open("rb") as file:
            return _name(file.read(_MAX_BYTES))
    except (OSError, MeshFileError):
        return None


def _name(data: bytes) -> str | None:
    parser = guarded_parser(namespaces=False)
    around: list[str] = []
    found: list[str] = []

    def text(words: str) -> None:
        if around == ["package", "name"]:
            found.append(words)

    parser.StartElementHandler = lambda tag, _: around.append(tag)
    parser.EndElementHandler = lambda _: around.pop()
    parser.CharacterDataHandler = text
    parse_xml(lambda: parser.Parse(data, True))
    return "".join(found).strip() or None
