"""Findings as topics for coordination programs: BCF 3.0 (buildingSMART, BCF-XML).

One topic for each group of findings, with a view of each pair. The order of XML elements is that of
the schemas at tag v3.0 of buildingSMART/BCF-XML.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.formats.picture.data import require_drawable
from satcheck.plugins.ifc.bcf.archive import archive
from satcheck.plugins.ifc.bcf.markup import extensions, markup, project, version_file
from satcheck.plugins.ifc.bcf.topics import topics_of
from satcheck.plugins.ifc.bcf.viewpoint import Snapshots, visualization

if TYPE_CHECKING:
    from satcheck.report.report import Report
    from satcheck.scene import Scene


def render(report: Report, scene: Scene) -> bytes:
    """The zip archive."""
    require_drawable(scene)
    topics = topics_of(report, scene)
    files = {
        "bcf.version": version_file(),
        "project.bcfp": project(scene),
        "extensions.xml": extensions(topics),
    }
    snapshots = Snapshots(scene)
    for topic in topics:
        seen = {view.guid: snapshot for view in topic.views if (snapshot := snapshots.of(view))}
        views = [view for view in topic.views if view.guid in seen]
        files[f"{topic.guid}/markup.bcf"] = markup(topic, views)
        for view in views:
            name = f"{topic.guid}/{view.guid}"
            files[f"{name}.bcfv"] = visualization(view, seen[view.guid])
            files[f"{name}.png"] = seen[view.guid].image
    return archive(files)
