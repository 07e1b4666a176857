"""The XML files of BCF about topics and the project."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING
from uuid import NAMESPACE_URL, uuid5
from xml.etree.ElementTree import Element

from satcheck.cli.formats.bcf.archive import date
from satcheck.cli.formats.bcf.text import Version, below, document
from satcheck.cli.formats.bcf.topics import PRIORITIES, STATUSES, TYPES, PairView, Topic

if TYPE_CHECKING:
    from satcheck.scene import Scene

AUTHOR = "satcheck"


def version_file(version: Version) -> bytes:
    root = Element("Version", VersionId=version)
    if version == "2.1":
        below(root, "DetailedVersion", version)
    return document(root)


def project(scene: Scene, version: Version) -> bytes:
    root = Element("ProjectInfo" if version == "3.0" else "ProjectExtension")
    number = str(uuid5(NAMESPACE_URL, f"satcheck:{scene.name}"))
    below(below(root, "Project", ProjectId=number), "Name", scene.name)
    if version == "2.1":
        below(root, "ExtensionSchema", "")
    return document(root)


def extensions(topics: Sequence[Topic]) -> bytes:
    """The words that topics of BCF 3.0 may use."""
    root = Element("Extensions")
    labels = sorted({label for topic in topics for label in topic.labels})
    lists = (
        ("TopicTypes", "TopicType", sorted(set(TYPES.values()))),
        ("TopicStatuses", "TopicStatus", STATUSES),
        ("Priorities", "Priority", PRIORITIES.values()),
        ("TopicLabels", "TopicLabel", labels),
        ("Users", "User", [AUTHOR]),
    )
    for name, item, values in lists:
        parent = below(root, name)
        for value in values:
            below(parent, item, value)
    below(root, "SnippetTypes")
    below(root, "Stages")
    return document(root)


def markup(topic: Topic, views: Sequence[PairView], version: Version) -> bytes:
    """views: of the topic, with a picture."""
    root = Element("Markup")
    _header(root, topic, version)
    element = below(root, "Topic", Guid=topic.guid, TopicType=topic.kind, TopicStatus=topic.status)
    below(element, "Title", topic.title)
    below(element, "Priority", topic.priority)
    below(element, "Index", str(topic.index))
    _labels(element, topic, version)
    below(element, "CreationDate", date())
    below(element, "CreationAuthor", AUTHOR)
    below(element, "Description", topic.description)
    parent, tag = root, "Viewpoints"
    if views and version == "3.0":
        parent, tag = below(element, "Viewpoints"), "ViewPoint"
    for index, view in enumerate(views):
        _view(below(parent, tag, Guid=view.guid), view, index)
    return document(root)


def _header(root: Element, topic: Topic, version: Version) -> None:
    """The files of the bodies."""
    parent = below(root, "Header")
    attribute = "isExternal"
    if version == "3.0":
        parent, attribute = below(parent, "Files"), "IsExternal"
    members = [member for view in topic.views for member in view.members]
    for file, project in dict.fromkeys((member.file, member.project) for member in members):
        known = {} if project is None else {"IfcProject": project}
        below(
            below(parent, "File", **known, **{attribute: "true"}), "Filename", PurePath(file).name
        )


def _labels(element: Element, topic: Topic, version: Version) -> None:
    parent = below(element, "Labels") if version == "3.0" and topic.labels else element
    for label in topic.labels:
        below(parent, "Label" if version == "3.0" else "Labels", label)


def _view(parent: Element, view: PairView, index: int) -> None:
    below(parent, "Viewpoint", f"{view.guid}.bcfv")
    below(parent, "Snapshot", f"{view.guid}.png")
    below(parent, "Index", str(index))
