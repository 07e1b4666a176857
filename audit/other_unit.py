"""Checks in another unit of length: settings are scaled on the way in, reports on the way out.

The scale is a power of two (`scene/other_unit.py`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from msgspec import convert
from msgspec.structs import replace

from satcheck.audit.asked.settings import Settings
from satcheck.audit.summary import rule_reports, stated_health, stated_shape
from satcheck.core.power_of_two import held_times_power, limit_times_power
from satcheck.report.certificate import Certificate
from satcheck.report.contacts import Contacts
from satcheck.report.report import BodyReport, Finding, Issue, Report, Stage, Witness, plain
from satcheck.report.sweep import Place, Sweep, WorstPose
from satcheck.report.values import Interval, Vector
from satcheck.scene import Scene
from satcheck.scene.mesh_units import placing_file, shape_of_file

# The first stage of each trace.
STAGE = "unit"
# What states lengths in a certificate; all else are directions, weights and numbers of vertices.
POINTS_OF_CERTIFICATES = frozenset({"both", "a_alone", "b_alone", "move", "point"})


class OtherUnit:
    """Lengths of the scene times 2**exponent are in the other unit."""

    def __init__(self, exponent: int) -> None:
        self._exponent = exponent

    def settings(self, given: Settings) -> Settings:
        """In the other unit."""
        lengths = {name: getattr(given, name) for name in ("clearance", "tolerance")}
        known = {name: length for name, length in lengths.items() if length is not None}
        return replace(
            given,
            **{name: limit_times_power(length, self._exponent) for name, length in known.items()},
        )

    def report(self, found: Report, scene: Scene, given: Settings) -> Report:
        """In the unit of the scene as given, but for lengths in words, which say so."""
        from satcheck.audit.motion.movers import Movers

        return replace(
            found,
            settings=given.stated(depth=found.settings.depth),
            bodies=tuple(self._bodies(found.bodies, scene)),
            findings=tuple(map(self._finding, found.findings)),
            rules=rule_reports(scene.rules),
            motions=Movers(scene.motions).stated() if scene.motions else (),
            issues=tuple(self._issue(issue, scene) for issue in found.issues),
        )

    def _issue(self, found: Issue, scene: Scene) -> Issue:
        given = (found.code, found.body, found.message)
        if any(given == (issue.code, issue.body, issue.message) for issue in scene.issues):
            return found
        return replace(found, message=self._words(found.message))

    def _bodies(self, found: Iterable[BodyReport], scene: Scene) -> Iterable[BodyReport]:
        given = {body.id: body for body in scene.bodies}
        for body in found:
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
                resolution=self._length(body.resolution),
            )

    def _finding(self, found: Finding) -> Finding:
        contacts = found.contacts and self._contacts(found.contacts)
        volume = self._volume(found.volume)
        lost = {
            "contacts": found.contacts is not None and contacts is None,
            "volume": found.volume is not None and volume is None,
        }
        left_out = [
            Stage(name, "left out", 0.0, "float64 cannot hold it in the unit of the files")
            for name, is_lost in lost.items()
            if is_lost
        ]
        return replace(
            found,
            tolerance=self._length(found.tolerance),
            distance=self._length(found.distance),
            depth=self._length(found.depth),
            distance_bounds=self._interval(found.distance_bounds),
            depth_bounds=self._interval(found.depth_bounds),
            mtv=found.mtv and self._vector(found.mtv),
            witness=found.witness and self._witness(found.witness),
            volume=volume,
            volume_error=self._volume(found.volume_error),
            contacts=contacts,
            reason=found.reason and self._words(found.reason),
            motion=found.motion and self._sweep(found.motion),
            certificate=found.certificate
            and convert(self._certificate(plain(found.certificate)), Certificate),
            plan=(self._stage(), *found.plan, *left_out),
        )

    def _stage(self) -> Stage:
        detail = self._words("coordinates are beyond the range of products")
        return Stage(STAGE, f"2^{-self._exponent}", 0.0, detail)

    def _words(self, text: str) -> str:
        """With a remark on the lengths that it may state."""
        return f"{text} (lengths here are times 2^{self._exponent})"

    def _length(self, length: float | None) -> float | None:
        return None if length is None else math.ldexp(length, -self._exponent)

    def _volume(self, volume: float | None) -> float | None:
        """None, too, where float64 cannot hold it."""
        return None if volume is None else self._held(volume, 3)

    def _held(self, value: float, dimension: int) -> float | None:
        held = held_times_power(value, -dimension * self._exponent)
        return held if math.isfinite(held) else None

    def _interval(self, interval: Interval | None) -> Interval | None:
        if interval is None:
            return None
        low, high = interval
        return math.ldexp(low, -self._exponent), math.ldexp(high, -self._exponent)

    def _vector(self, vector: Vector) -> Vector:
        x, y, z = (math.ldexp(c, -self._exponent) for c in vector)
        return x, y, z

    def _witness(self, witness: Witness) -> Witness:
        return Witness(self._vector(witness.a), self._vector(witness.b))

    def _certificate(self, part: Any) -> Any:
        if not isinstance(part, Mapping):
            return part
        return {
            key: [self._exact(c) for c in member]
            if key in POINTS_OF_CERTIFICATES and isinstance(member, list)
            else self._certificate(member)
            for key, member in part.items()
        }

    def _exact(self, number: float | str) -> str:
        scaled = Fraction(number) * Fraction(2) ** -self._exponent
        return str(scaled)

    def _contacts(self, contacts: Contacts) -> Contacts | None:
        """None where float64 cannot hold an area of them."""
        areas = [self._held(patch.area, 2) for patch in contacts.patches]
        totals = contacts.totals
        area = self._held(totals.area, 2)
        if area is None or None in areas:
            return None
        return replace(
            contacts,
            curves=tuple(
                replace(
                    curve,
                    points=tuple(map(self._vector, curve.points)),
                    length=math.ldexp(curve.length, -self._exponent),
                )
                for curve in contacts.curves
            ),
            patches=tuple(
                replace(
                    patch,
                    outlines=tuple(tuple(map(self._vector, line)) for line in patch.outlines),
                    area=own,
                )
                for patch, own in zip(contacts.patches, areas, strict=True)
            ),
            points=tuple(map(self._vector, contacts.points)),
            totals=replace(totals, length=math.ldexp(totals.length, -self._exponent), area=area),
        )

    def _sweep(self, sweep: Sweep) -> Sweep:
        return replace(
            sweep,
            tolerance=math.ldexp(sweep.tolerance, -self._exponent),
            at=tuple(map(self._place, sweep.at)),
            worst=sweep.worst and self._worst(sweep.worst),
            reason=sweep.reason and self._words(sweep.reason),
        )

    def _worst(self, worst: WorstPose) -> WorstPose:
        return replace(
            worst,
            at=tuple(map(self._place, worst.at)),
            distance=self._interval(worst.distance),
            depth=self._interval(worst.depth),
        )

    def _place(self, place: Place) -> Place:
        if place.term != "length":
            return place
        return replace(place, value=math.ldexp(place.value, -self._exponent))
