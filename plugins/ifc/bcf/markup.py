"""The XML files of BCF about topics and the project."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING
from uuid import NAMESPACE_URL, uuid5
from xml.etree.ElementTree import Element

from satcheck.plugins.ifc.bcf.archive import date
from satcheck.plugins.ifc.bcf.text import below, document
from satcheck.plugins.ifc.bcf.topics import PRIORITIES, STATUSES, TYPES, PairView, Topic

if TYPE_CHECKING:
    from satcheck.scene import Scene

AUTHOR = "satcheck"


def version_file() -> bytes:
    return document(Element("Version", VersionId="3.0"))


def project(scene: Scene) -> bytes:
    root = Element("ProjectInfo")
    number = str(uuid5(NAMESPACE_URL, f"satcheck:{scene.name}"))
    below(below(root, "Project", ProjectId=number), "Name", scene.name)
    return document(root)


def extensions(topics: Sequence[Topic]) -> bytes:
    """The words that topics may use."""
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


def markup(topic: Topic, views: Sequence[PairView]) -> bytes:
    """views: of the topic, with a picture."""
    root = Element("Markup")
    _header(root, topic)
    element = below(root, "Topic", Guid=topic.guid, TopicType=topic.kind, TopicStatus=topic.status)
    below(element, "Title", topic.title)
    below(element, "Priority", topic.priority)
    below(element, "Index", str(topic.index))
    _labels(element, topic)
    below(element, "CreationDate", date())
    below(element, "CreationAuthor", AUTHOR)
    below(element, "Description", topic.description)
    if views:
        parent = below(element, "Viewpoints")
        for index, view in enumerate(views):
            _view(below(parent, "ViewPoint", Guid=view.guid), view, index)
    return document(root)


def _header(root: Element, topic: Topic) -> None:
    """The files of the bodies."""
    files = below(below(root, "Header"), "Files")
    members = [member for view in topic.views for member in view.members]
    for file, project in dict.fromkeys((member.file, member.project) for member in members):
        known = {} if project is None else {"IfcProject": project}
        below(below(files, "File", **known, IsExternal="true"), "Filename", PurePath(file).name)


def _labels(element: Element, topic: Topic) -> None:
    if topic.labels:
        labels = below(element, "Labels")
        for label in topic.labels:
            below(labels, "Label", label)


def _view(parent: Element, view: PairView, index: int) -> None:
    below(parent, "Viewpoint", f"{view.guid}.bcfv")
    below(parent, "Snapshot", f"{view.guid}.png")
    below(parent, "Index", str(index))
