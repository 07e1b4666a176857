"""The check of a scaled scene (`scene/scaled_scene.py`): its settings are scaled too, and its
report is scaled back. The factor is a power of two."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from msgspec import UNSET, Struct, convert
from msgspec.structs import replace

from satcheck.audit.request.settings import Settings
from satcheck.audit.summary import rule_reports, stated_health, stated_shape
from satcheck.core.power_of_two import held_times_power, limit_times_power
from satcheck.report.certificate import Cells, Certificate, Excuse, Face, Plane
from satcheck.report.report import BodyReport, Finding, Issue, Report, Stage, plain
from satcheck.report.sweep import Place, Sweep
from satcheck.scene import Scene
from satcheck.scene.mesh_units import placing_file, shape_of_file

# The first stage of each trace.
STAGE = "unit"
# The keys of a certificate that state lengths. Others state directions, weights and vertex numbers.
POINTS_OF_CERTIFICATES = frozenset({"both", "a_alone", "b_alone", "move", "point"})
# The fields of a finding and its parts that state lengths and areas. _finding scales volumes.
DIMENSIONS = {
    **dict.fromkeys(("tolerance", "distance", "distance_bounds", "depth", "depth_bounds"), 1),
    "distance_at_least": 1,
    **dict.fromkeys(("thickness", "thickness_bounds", "ball"), 1),
    **dict.fromkeys(("mtv", "witness", "points", "outlines", "length"), 1),
    **dict.fromkeys(("bounds", "point", "thickness_bounds", "curve_length"), 1),
    "area": 2,
    **dict.fromkeys(("volume", "volume_error"), 3),
}


class Scaling:
    """Lengths of the scaled scene are 2**exponent times those of the scene."""

    def __init__(self, exponent: int) -> None:
        self._exponent = exponent

    def settings(self, given: Settings) -> Settings:
        """Settings for the scaled scene."""
        lengths = {
            name: getattr(given, name) for name in ("clearance", "tolerance", "surface_tolerance")
        }
        known = {name: length for name, length in lengths.items() if length is not None}
        return replace(
            given,
            **{name: limit_times_power(length, self._exponent) for name, length in known.items()},
        )

    def report(self, report: Report, scene: Scene, given: Settings) -> Report:
        """The report in the unit of the given scene. Lengths within texts stay scaled, and a remark
        says so."""
        from satcheck.audit.motion.movers import Movers

        return replace(
            report,
            settings=given.stated(depth=report.settings.depth, thickness=report.settings.thickness),
            bodies=tuple(self._bodies(report.bodies, scene)),
            findings=tuple(map(self._finding, report.findings)),
            rules=rule_reports(scene.rules),
            motions=Movers(scene.motions).stated() if scene.motions else (),
            issues=tuple(self._issue(issue, scene) for issue in report.issues),
        )

    def _issue(self, issue: Issue, scene: Scene) -> Issue:
        given = (issue.code, issue.body, issue.message)
        if any(given == (issue.code, issue.body, issue.message) for issue in scene.issues):
            return issue
        return replace(issue, message=self._words(issue.message))

    def _bodies(self, bodies: Iterable[BodyReport], scene: Scene) -> Iterable[BodyReport]:
        given = {body.id: body for body in scene.bodies}
        for body in bodies:
            if body.health is None:
                yield body
                continue
            own = given[body.id]
            shape = shape_of_file(own.file, own.shape)
            yield replace(
                body,
                sha256=own.file.sha256,
                transform=placing_file(own.file, own.transform),
                health=stated_health(own.file.health),
                shape=stated_shape(shape),
                resolution=self._scaled(body.resolution, 1),
                surface_tolerance=self._scaled(body.surface_tolerance, 1),
            )

    def _finding(self, finding: Finding) -> Finding:
        motion = finding.motion
        figures = {
            "contacts": finding.contacts and self._held(finding.contacts),
            "components": finding.components and self._held(finding.components),
            "volume": self._held(finding.volume, 3),
            "volume_error": self._held(finding.volume_error, 3),
        }
        left_out = [
            Stage(name, "left out", 0.0, "float64 cannot hold it in the unit of the files")
            for name in ("contacts", "components", "volume")
            if getattr(finding, name) is not None and figures[name] is None
        ]
        scaled: Finding = self._scaled(replace(finding, certificate=None, **dict.fromkeys(figures)))
        return replace(
            scaled,
            **figures,
            reason=finding.reason and self._words(finding.reason),
            motion=motion and self._scaled(self._sweep(motion)),
            certificate=finding.certificate and self._evidence(finding.certificate),
            plan=(self._stage(), *finding.plan, *left_out),
        )

    def _sweep(self, sweep: Sweep) -> Sweep:
        return replace(sweep, reason=sweep.reason and self._words(sweep.reason))

    def _scaled(self, value: Any, dimension: int = 0) -> Any:
        """Converts lengths and areas in a part of a finding to the unit of the files.

        dimension: of the numbers in it. Raises OverflowError if a number is beyond float64.
        """
        if isinstance(value, float) and dimension:
            return self._number(value, dimension)
        if isinstance(value, tuple):
            return tuple(self._scaled(member, dimension) for member in value)
        if isinstance(value, Place) and value.term == "length":
            return replace(value, value=self._number(value.value, 1))
        if isinstance(value, Struct):
            names = value.__struct_fields__
            members = ((name, dimension or DIMENSIONS.get(name, 0)) for name in names)
            return replace(value, **{n: self._scaled(getattr(value, n), d) for n, d in members})
        return value

    def _number(self, value: float, dimension: int) -> float:
        if dimension == 1:
            return math.ldexp(value, -self._exponent)
        held = held_times_power(value, -dimension * self._exponent)
        if not math.isfinite(held):
            raise OverflowError
        return held

    def _held(self, value: Any, dimension: int = 0) -> Any:
        """`_scaled`; None if a number is beyond float64."""
        try:
            return self._scaled(value, dimension)
        except OverflowError:
            return None

    def _stage(self) -> Stage:
        detail = self._words("coordinates are beyond the range of products")
        return Stage(STAGE, f"2^{-self._exponent}", 0.0, detail)

    def _words(self, text: str) -> str:
        """Adds a remark on the lengths that the text may state."""
        return f"{text} (lengths here are times 2^{self._exponent})"

    def _evidence(self, certificate: Certificate) -> Certificate:
        scaled = convert(self._certificate(plain(certificate)), Certificate)
        if (cells := certificate.thickness) is not UNSET:
            scaled = replace(scaled, thickness=self._cells(cells))
        if scaled.band is not UNSET and scaled.band.excuse is not UNSET:
            excuse = self._excuse(scaled.band.excuse)
            scaled = replace(scaled, band=replace(scaled.band, excuse=excuse))
        return scaled

    def _excuse(self, excuse: Excuse) -> Excuse:
        a, b = self._scaled(excuse.a, 1), self._scaled(excuse.b, 1)
        return replace(excuse, a=a, b=b, cells=self._cells(excuse.cells))

    def _certificate(self, part: Any) -> Any:
        if not isinstance(part, Mapping):
            return part
        return {
            key: [self._exact(c) for c in member]
            if key in POINTS_OF_CERTIFICATES and isinstance(member, list)
            else self._certificate(member)
            for key, member in part.items()
        }

    def _cells(self, cells: Cells) -> Cells:
        """Scales all numbers except normals and weights."""
        return replace(
            cells,
            **{
                name: self._scaled(getattr(cells, name), 1)
                for name in ("origin", "low", "high", "at")
            },
            patches=tuple(map(self._patch, cells.patches)),
            cuts=tuple((normal, self._number(height, 1)) for normal, height in cells.cuts),
        )

    def _patch(self, patch: Face | Plane) -> Face | Plane:
        if isinstance(patch, Face):
            return patch
        reach = patch.reach if patch.reach is UNSET else self._number(patch.reach, 1)
        return replace(patch, height=self._number(patch.height, 1), reach=reach)

    def _exact(self, number: float | str) -> str:
        scaled = Fraction(number) * Fraction(2) ** -self._exponent
        return str(scaled)
