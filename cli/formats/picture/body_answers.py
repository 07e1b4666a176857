"""What answers about single bodies show in a picture: which bodies fail, the contact forces, and
how bodies that fall start to move."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from msgspec.structs import replace

from satcheck.cli.formats.picture.moments import sphere_around
from satcheck.report.verdict import is_unmet

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.report.report import Report
    from satcheck.report.statics import Statics
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]

MOST_ARROWS = 2000  # the largest forces
LONGEST = 0.2  # of the radius of all bodies: the arrow of the largest force
# Of the radius of a body: the arrow of its fall.
FALL = 1.0


class Arrow(NamedTuple):
    """In the world. force: on a body, at a contact. fall: from the middle of a body."""

    start: Floats
    way: Floats
    kind: Literal["force", "fall"]


def without_regions(scene: Scene) -> Scene:
    """Regions have no material and would hide what lies in them."""
    if not any(rule.region for rule in scene.body_rules):
        return scene
    from satcheck.scene.statics import terms_of

    spaces = terms_of(scene.bodies, scene.body_rules)
    bodies = zip(scene.bodies, spaces, strict=True)
    return replace(scene, bodies=tuple(body for body, own in bodies if not own.value("region")))


def states_of(report: Report) -> dict[str, str]:
    """body -> error, if a question about it fails the check, or warning, if it is open."""
    states: dict[str, str] = {}
    for answer in report.answers:
        if is_unmet(answer, report.settings.fail_on):
            states[answer.body] = "error"
        elif answer.answer == "open":
            states.setdefault(answer.body, "warning")
    return states


def arrows_of(report: Report, scene: Scene) -> list[Arrow]:
    """Forces on bodies that stand, and falls of those that do not."""
    statics = report.support
    if statics is None or not scene.bodies:
        return []
    return [*_falls(statics, scene.bodies), *_forces(statics, sphere_around(scene.bodies)[1])]


def _forces(statics: Statics, radius: float) -> list[Arrow]:
    """Of the two forces of a contact the one against gravity."""
    down = np.array(statics.gravity)
    acting = [
        (np.array(point.at), np.array(point.force))
        for contact in statics.contacts
        for point in contact.points
        if point.force is not None and any(point.force)
    ]
    forces = [(at, -force if force @ down > 0 else force) for at, force in acting]
    forces.sort(key=lambda force: -float(np.linalg.norm(force[1])))
    largest = float(np.linalg.norm(forces[0][1])) if forces else 1.0
    scale = LONGEST * radius / largest
    return [Arrow(at, force * scale, "force") for at, force in forces[:MOST_ARROWS]]


def _falls(statics: Statics, bodies: tuple[Body, ...]) -> list[Arrow]:
    by_id = {body.id: body for body in bodies}
    arrows = []
    for stated in statics.bodies:
        body = by_id.get(stated.id)
        velocity = (0.0, 0.0, 0.0) if stated.motion is None else stated.motion.velocity
        way = np.array(statics.gravity if stated.floating == "yes" else velocity)
        if body is not None and way.any():
            centre, radius = sphere_around([body])
            arrows.append(Arrow(centre, way * (FALL * radius / np.linalg.norm(way)), "fall"))
    return arrows
