"""The BCF file of a report: the same bytes for the same findings and date."""

from __future__ import annotations

import io
import os
import time
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import PurePath
from typing import TYPE_CHECKING, Any
from uuid import NAMESPACE_URL, uuid5

from bcf.v3 import model as bcf
from xsdata.formats.dataclass.serializers import XmlSerializer
from xsdata.formats.dataclass.serializers.writers import XmlEventWriter
from xsdata.models.datatype import XmlDateTime

from satcheck.cli.formats.picture.data import require_drawable
from satcheck.cli.output import harmless
from satcheck.plugins.ifc.bcf import topics
from satcheck.plugins.ifc.bcf.viewpoint import Snapshots

if TYPE_CHECKING:
    from satcheck.plugins.ifc.bcf.topics import Pair
    from satcheck.report.report import Report
    from satcheck.scene import Scene

AUTHOR = "satcheck"


def render(report: Report, scene: Scene) -> bytes:
    """The zip archive."""
    require_drawable(scene)
    found = topics.topics_of(report, scene)
    number = str(uuid5(NAMESPACE_URL, f"satcheck:{harmless(scene.name)}"))
    files: dict[str, Any] = {
        "bcf.version": bcf.Version(version_id="3.0"),
        "project.bcfp": bcf.ProjectInfo(project=bcf.Project(name=scene.name, project_id=number)),
        "extensions.xml": _extensions(found.values()),
    }
    snapshots = Snapshots(scene)
    for index, (guid, pairs) in enumerate(found.items()):
        views: list[Any] = []
        for pair in topics.shown(pairs):
            if snapshot := snapshots.of(pair):
                name = f"{guid}/{pair.guid}"
                files[f"{name}.bcfv"], files[f"{name}.png"] = snapshot
                views.append(_view(pair.guid, len(views)))
        topic = _topic(guid, index, pairs, views)
        files[f"{guid}/markup.bcf"] = bcf.Markup(header=_header(topics.shown(pairs)), topic=topic)
    return _archive(files)


def _extensions(found: Iterable[Sequence[Pair]]) -> Any:
    """The words that topics may use."""
    labels = sorted({label for first, *_ in found for label in first.labels})
    return bcf.Extensions(
        topic_types=bcf.ExtensionsTopicTypes(topic_type=sorted(set(topics.TYPES.values()))),
        topic_statuses=bcf.ExtensionsTopicStatuses(topic_status=list(topics.STATUSES)),
        priorities=bcf.ExtensionsPriorities(priority=list(topics.PRIORITIES.values())),
        topic_labels=bcf.ExtensionsTopicLabels(topic_label=labels),
        users=bcf.ExtensionsUsers(user=[AUTHOR]),
    )


def _topic(guid: str, index: int, pairs: Sequence[Pair], views: list[Any]) -> Any:
    first = pairs[0]
    return bcf.Topic(
        guid=guid,
        index=index,
        topic_type=first.kind,
        topic_status=topics.status(pairs),
        priority=first.priority,
        title=topics.title(pairs),
        description=topics.description(pairs),
        labels=bcf.TopicLabels(label=list(first.labels)) if first.labels else None,
        creation_date=_date(),
        creation_author=AUTHOR,
        viewpoints=bcf.TopicViewpoints(view_point=views),
    )


def _view(guid: str, index: int) -> Any:
    files = {"viewpoint": f"{guid}.bcfv", "snapshot": f"{guid}.png"}
    return bcf.ViewPoint(guid=guid, index=index, **files)


def _header(pairs: Iterable[Pair]) -> Any:
    """The files of the bodies."""
    members = [member for pair in pairs for member in pair.members]
    files = dict.fromkeys((member.file, member.project) for member in members)
    named = [bcf.File(filename=PurePath(file).name, ifc_project=project) for file, project in files]
    return bcf.Header(files=bcf.HeaderFiles(file=named))


def _date() -> Any:
    """Return the date of topics: now, or SOURCE_DATE_EPOCH (https://reproducible-builds.org), in
    UTC."""
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    return XmlDateTime.from_datetime(datetime.fromtimestamp(seconds, UTC))


def _archive(files: Mapping[str, Any]) -> bytes:
    """files: name -> a picture, or what is an XML file."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as packed:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)  # its date is the earliest of zip
            written = data if isinstance(data, bytes) else _xml(data)
            packed.writestr(entry, written, zipfile.ZIP_DEFLATED)
    return content.getvalue()


def _xml(element: Any) -> str:
    """Names may hold characters that XML cannot hold. The writer is named, since the one by default
    depends on whether lxml is installed."""
    text = XmlSerializer(writer=XmlEventWriter).render(element)
    return "\n".join(map(harmless, text.split("\n")))
