"""Where bodies stand at the moments that a picture can show: along their motions, or in poses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from msgspec.structs import replace

from satcheck.audit.words import is_hit
from satcheck.report.report import OVERLAPS
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.report.report import Finding, Report
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]

STEPS = 60  # of a motion
AS_PLACED = "as placed"


class Moments(NamedTuple):
    """names: of the moments, in their order. placed: body -> its placement at each, (moments, 4,
    4), of the bodies that move. of: id -> the moment that a finding is about; all others are about
    the first. Without names the bodies stay as they are placed. note: words for the title."""

    names: tuple[str, ...] = ()
    placed: Mapping[str, Floats] = {}
    of: Mapping[str, int] = {}
    note: str = ""

    def scene_at(self, scene: Scene, number: int) -> Scene:
        """The scene with its bodies as they stand then."""
        then = {id_: tuple(own[number].reshape(-1).tolist()) for id_, own in self.placed.items()}
        bodies = (replace(b, transform=then[b.id]) if b.id in then else b for b in scene.bodies)
        return replace(scene, bodies=tuple(bodies))


def moments_of(report: Report, scene: Scene) -> Moments:
    """The moments of the motions of a scene: evenly, and when bodies hit or come closest."""
    if scene.joint_path is None and not scene.motions:
        return Moments()
    about = {finding.id: t for finding in report.findings if (t := _time_of(finding)) is not None}
    times: Floats = np.unique([*np.linspace(0.0, 1.0, STEPS + 1), *about.values()])
    placed = _rigid(scene, times) if scene.joint_path is None else _of_joints(scene, times)
    bodies = {body.id: matrix_of(body) for body in scene.bodies}
    placed = {id_: own for id_, own in placed.items() if not (own == bodies[id_]).all()}
    names = [f"t = {time:.3g}" for time in times]
    first = [own[0] for own in placed.values()]
    if any((one != bodies[id_]).any() for id_, one in zip(placed, first, strict=True)):
        # A path of poses may start elsewhere.
        placed = {id_: np.concatenate([bodies[id_][None], own]) for id_, own in placed.items()}
        names = [AS_PLACED, *names]
    before = len(names) - len(times)
    numbers = {id_: before + int(np.searchsorted(times, time)) for id_, time in about.items()}
    return Moments(tuple(names), placed, numbers)


def _time_of(finding: Finding) -> float | None:
    """When bodies hit, or come closest; None: the finding is about the bodies as placed."""
    swept = finding.motion
    if swept is None or finding.at_rest in OVERLAPS:
        return None
    if is_hit(finding) and swept.time_of_impact is not None:
        return swept.time_of_impact[1]
    worst = swept.worst
    if worst is None or worst.distance is None:
        return None
    nearer = finding.distance is None or worst.distance[1] < finding.distance
    return worst.time if nearer else None


def _rigid(scene: Scene, times: Floats) -> dict[str, Floats]:
    from satcheck.audit.motion.track import track_of

    placed: dict[str, Floats] = {}
    bodies = {body.id: body for body in scene.bodies}
    for motion in scene.motions:
        track = track_of(motion.path)
        moves = np.array([track.pose_at(time) for time in times.tolist()]).reshape(-1, 4, 4)
        placed |= {id_: moves @ matrix_of(bodies[id_]) for id_ in motion.bodies if id_ in bodies}
    return placed


def _of_joints(scene: Scene, times: Floats) -> dict[str, Floats]:
    from satcheck.scene.robot.kinematics import link_frames, placements

    assert scene.joint_path is not None
    rows = placements(scene, link_frames(scene, scene.joint_path.at(times)), len(times))
    whole = np.zeros((*rows.shape[:2], 4, 4))
    whole[:, :, :3] = rows.reshape(*rows.shape[:2], 3, 4)
    whole[:, :, 3, 3] = 1.0
    return {body.id: whole[:, number] for number, body in enumerate(scene.bodies)}


def matrix_of(body: Body) -> Floats:
    """Its placement, 4 x 4."""
    return np.array(body.transform or IDENTITY).reshape(4, 4)


def boxes_of(bodies: Iterable[Body]) -> Floats:
    """Least and greatest corner of each in the world, (n, 2, 3)."""
    return np.array([body.world_mesh().bounds for body in bodies]).reshape(-1, 2, 3)


def sphere_around(bodies: Iterable[Body]) -> tuple[Floats, float]:
    """Of the boxes of bodies: centre and radius."""
    boxes = boxes_of(bodies)
    if not len(boxes):
        return np.zeros(3), 1.0
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    return (low + high) / 2, float(np.linalg.norm(high - low)) / 2
