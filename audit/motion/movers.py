"""The moving bodies of a scene, the pairs to sweep, and the boxes around their motions."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import convert, to_builtins

from satcheck import core
from satcheck.audit.bodies.boxes import Box
from satcheck.audit.bodies.pair import Paths
from satcheck.audit.motion.swept import SweptBoxes, may_meet
from satcheck.audit.motion.track import STANDS, track_of
from satcheck.report.motions import StatedMotion
from satcheck.report.report import Issue
from satcheck.scene.motion import Motion, PosePath, Rotation, Translation

# How a report calls the kinds of paths.
KINDS = {Translation: "translation", Rotation: "rotation", PosePath: "path"}


class Movers:
    def __init__(self, motions: Sequence[Motion]) -> None:
        self._motions = tuple(motions)
        self._motion = {body: motion for motion in motions for body in motion.bodies}
        self._tracks = {id(motion): track_of(motion.path) for motion in motions}
        self._boxes: dict[str, SweptBoxes] = {}

    def paths(self, a: str, b: str) -> Paths | None:
        """The paths of a pair; None: the bodies do not move relative to each other."""
        motion_a, motion_b = self._motion.get(a), self._motion.get(b)
        if motion_a is motion_b:
            return None
        motions = (motion_a, motion_b)
        path_a, path_b = (None if motion is None else motion.path for motion in motions)
        return Paths(path_a, path_b, any(motion and motion.clear for motion in motions))

    def sweep(self, close: Sequence[tuple[int, int]]) -> None:
        """Nothing: each pair is swept when it is examined."""

    def bounds(self, body: str, placed: Box) -> Box:
        """The world box of a body over its whole motion, the placement included."""
        low, high = self._swept(body, placed).over(0.0, 1.0)
        return (
            (min(low[0], placed[0][0]), min(low[1], placed[0][1]), min(low[2], placed[0][2])),
            (max(high[0], placed[1][0]), max(high[1], placed[1][1]), max(high[2], placed[1][2])),
        )

    def may_meet(self, a: str, box_a: Box, b: str, box_b: Box, limit: float) -> bool:
        """Whether the bodies may be as close as the limit, as placed or at some t. Boxes as
        placed."""
        if self._motion.get(a) is self._motion.get(b):
            return core.box_gap(box_a, box_b) <= limit
        return may_meet(self._swept(a, box_a), self._swept(b, box_b), limit)

    def _swept(self, body: str, placed: Box) -> SweptBoxes:
        if body not in self._boxes:
            motion = self._motion.get(body)
            track = STANDS if motion is None else self._tracks[id(motion)]
            self._boxes[body] = SweptBoxes(placed, track)
        return self._boxes[body]

    def stated(self) -> tuple[StatedMotion, ...]:
        """The motions as a report states them."""
        return tuple(
            convert(
                {
                    "kind": KINDS[type(motion.path)],
                    "bodies": motion.bodies,
                    "clear": motion.clear,
                    **to_builtins(motion.path),
                },
                StatedMotion,
            )
            for motion in self._motions
        )

    def issues(self, bodies: Sequence[str]) -> list[Issue]:
        """Warnings about motions of bodies that do not exist."""
        lost = self._motion.keys() - set(bodies)
        return [
            Issue(
                "unknown-body",
                "warning",
                None,
                None,
                f"a motion names {body!r}, and no body has this id",
            )
            for body in sorted(lost)
        ]
