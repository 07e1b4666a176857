"""The moving bodies of a scene, the pairs to sweep, and the boxes around their motions."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import convert, to_builtins

from satcheck.audit.bodies.boxes import Box
from satcheck.audit.bodies.pair import Paths
from satcheck.audit.motion.swept import swept_box
from satcheck.audit.motion.track import track_of
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
        motion = self._motion.get(body)
        return placed if motion is None else swept_box(placed, self._tracks[id(motion)])

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
