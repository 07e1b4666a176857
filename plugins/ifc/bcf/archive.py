"""The BCF file of a report: the same bytes for the same findings and date.

The camera and the picture of a pair show the same: a parallel projection of the pair.
"""

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

import numpy as np
from bcf.v3 import model as bcf
from xsdata.formats.dataclass.serializers import XmlSerializer
from xsdata.formats.dataclass.serializers.writers import XmlEventWriter
from xsdata.models.datatype import XmlDateTime

from satcheck.cli.formats.picture import require_drawable, up_of
from satcheck.cli.formats.picture.moments import Moments
from satcheck.cli.formats.picture.png import View, image_file, image_of, image_of_bodies, view_of
from satcheck.cli.formats.picture.shown import Shows
from satcheck.cli.formats.picture.viewpoint import of_all
from satcheck.cli.output import harmless
from satcheck.plugins.ifc.bcf import topics
from satcheck.scene.units import ratio, stated_unit

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.plugins.ifc.bcf.topics import Pair
    from satcheck.report.report import Report
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]

AUTHOR = "satcheck"


SIZE = (800, 600)  # of a picture, in pixels
COLOURS = ("2970D6", "E68C1A")  # of A and B, as in the pictures: red, green, blue
_UNIT = "m"  # of BCF
# From y up to z up, the axes of BCF: (x, y, z) becomes (x, -z, y).
_Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


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
    snapshots = Snapshots(report, scene)
    for index, (guid, pairs) in enumerate(found.items()):
        views: list[Any] = []
        for pair in topics.shown(pairs):
            if snapshot := snapshots.of(pair):
                name = f"{guid}/{pair.guid}"
                files[f"{name}.bcfv"], files[f"{name}.png"] = snapshot
                pictured = {"viewpoint": f"{pair.guid}.bcfv", "snapshot": f"{pair.guid}.png"}
                views.append(bcf.ViewPoint(guid=pair.guid, index=len(views), **pictured))
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
    # https://reproducible-builds.org
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    return bcf.Topic(
        guid=guid,
        index=index,
        topic_type=first.kind,
        topic_status=topics.status(pairs),
        priority=first.priority,
        title=topics.title(pairs),
        description=topics.description(pairs),
        labels=bcf.TopicLabels(label=list(first.labels)) if first.labels else None,
        creation_date=XmlDateTime.from_datetime(datetime.fromtimestamp(seconds, UTC)),
        creation_author=AUTHOR,
        viewpoints=bcf.TopicViewpoints(view_point=views),
    )


def _header(pairs: Iterable[Pair]) -> Any:
    """The files of the bodies."""
    members = [member for pair in pairs for member in pair.members]
    files = dict.fromkeys((member.file, member.project) for member in members)
    named = [bcf.File(filename=PurePath(file).name, ifc_project=project) for file, project in files]
    return bcf.Header(files=bcf.HeaderFiles(file=named))


def _archive(files: Mapping[str, Any]) -> bytes:
    """files: name -> a picture, or what is an XML file. Names may hold characters that XML cannot
    hold. The writer is named, since the one by default depends on whether lxml is installed."""
    xml = XmlSerializer(writer=XmlEventWriter)
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as packed:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)  # its date is the earliest of zip
            if isinstance(data, bytes):
                written: bytes | str = data
            else:
                written = "\n".join(map(harmless, xml.render(data).split("\n")))
            packed.writestr(entry, written, zipfile.ZIP_DEFLATED)
    return content.getvalue()


class Snapshots:
    """Pictures of the pairs of a scene."""

    def __init__(self, report: Report, scene: Scene) -> None:
        self._scene = scene
        self._up = up_of(scene)
        self._shows = Shows(report, scene, Moments(), self._up)
        self._axes = _Z_UP if self._up == "y" else np.eye(3)
        unit = stated_unit(scene.units)
        self._metres = 1.0 if unit is None else ratio(unit, _UNIT)
        self._bodies = {body.id: body for body in scene.bodies}
        boxes = [body.world_mesh().bounds for body in scene.bodies]
        self._boxes: Floats = np.array(boxes).reshape(-1, 2, 3)

    def of(self, shown: Pair) -> tuple[Any, bytes] | None:
        """The viewpoint and its picture (PNG); None: no body of the pair can be drawn."""
        pair = [self._bodies[m.id] for m in shown.members if m.id in self._bodies]
        if not pair:
            return None
        if shown.finding is None or len(pair) < 2:
            view = view_of(of_all(pair, self._up), pair, self._up, SIZE)
            image = image_of_bodies(pair, view, SIZE)
        else:
            seen = self._shows.of(shown.finding)
            view = view_of(seen.view, pair, self._up, SIZE, seen.marks.points())
            image = image_of(self._near(view), seen, view, SIZE)
        camera = self._camera(view, pair)
        visible = bcf.VisualizationInfo(
            guid=shown.guid, components=_components(shown), orthogonal_camera=camera
        )
        return visible, image_file(image)

    def _near(self, view: View) -> list[Body]:
        """The bodies that may be in the image."""
        reach = np.hypot(*SIZE) / 2 / view.scale
        low, high = self._boxes[:, 0], self._boxes[:, 1]
        near = ((low <= view.target + reach) & (high >= view.target - reach)).all(axis=1)
        return [self._scene.bodies[k] for k in np.flatnonzero(near)]

    def _camera(self, view: View, pair: Sequence[Body]) -> Any:
        """The eye stands before the bodies, so that no wall is between. Metres, z up."""
        _, up, towards = view.rows
        points = np.concatenate([np.asarray(body.world_mesh().bounds) for body in pair])
        height = SIZE[1] / view.scale
        corners = np.array(np.meshgrid(*zip(points.min(axis=0), points.max(axis=0), strict=True)))
        ahead = ((corners.reshape(3, -1).T - view.target) @ towards).max()
        eye = view.target + towards * (ahead + height)
        return bcf.OrthogonalCamera(
            camera_view_point=bcf.Point(**self._placed(eye * self._metres)),
            camera_direction=bcf.Direction(**self._placed(-towards)),
            camera_up_vector=bcf.Direction(**self._placed(up)),
            view_to_world_scale=float(height * self._metres),
            aspect_ratio=SIZE[0] / SIZE[1],
        )

    def _placed(self, vector: Floats) -> dict[str, float]:
        """In the axes of BCF."""
        return dict(zip("xyz", map(float, self._axes @ vector + 0.0), strict=True))


def _components(pair: Pair) -> Any:
    """Both bodies, selected and coloured."""
    # Programs find an element by its GlobalId only.
    both = [
        bcf.Component(ifc_guid=member.guid)
        if member.guid is not None
        else bcf.Component(authoring_tool_id=member.id)
        for member in pair.members
    ]
    colours = [
        bcf.ComponentColoringColor(
            color=colour, components=bcf.ComponentColoringColorComponents(component=[each])
        )
        for each, colour in zip(both, COLOURS, strict=True)
    ]
    hints = bcf.ViewSetupHints()  # no spaces, no openings
    return bcf.Components(
        selection=bcf.ComponentSelection(component=both),
        visibility=bcf.ComponentVisibility(view_setup_hints=hints, default_visibility=True),
        coloring=bcf.ComponentColoring(color=colours),
    )
