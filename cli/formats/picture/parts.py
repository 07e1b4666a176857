"""The convex parts of bodies with findings, for a page that shows what `--accuracy parts` sees."""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING

from satcheck.cli.formats.picture import listed
from satcheck.cli.progress import counting
from satcheck.decompose import Cache, DecompositionError, decompose, user_cache

if TYPE_CHECKING:
    from satcheck.cli.formats.picture.geometry import Parts
    from satcheck.core import Mesh, Polytope
    from satcheck.report.report import Report
    from satcheck.report.settings import StatedSettings
    from satcheck.scene import Scene


def parts_of(report: Report, scene: Scene) -> Parts:
    """Split as the settings of the report say. A body that cannot be split has no parts."""
    met = {id_ for finding in listed(report) for id_ in (finding.a, finding.b)}
    bodies = [body for body in scene.bodies if body.id in met]
    once = cache(partial(_parts, settings=report.settings, store=user_cache()))
    split = {body.id: once(body.file.mesh) for body in counting(bodies, "bodies", "splitting")}
    return {id_: parts for id_, parts in split.items() if parts}


def _parts(mesh: Mesh, settings: StatedSettings, store: Cache | None) -> tuple[Polytope, ...]:
    try:
        return decompose(
            mesh,
            threshold=settings.part_threshold,
            seed=settings.part_seed,
            seconds=settings.part_seconds,
            megabytes=settings.part_megabytes,
            cache=store,
        ).parts
    except DecompositionError:
        return ()
