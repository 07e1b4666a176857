"""`resolve`: translations after which no pair of a scene fails a check."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import ExitStack

from msgspec.structs import replace

from satcheck.audit.check import check, volume_meter
from satcheck.audit.request.settings import Settings
from satcheck.audit.resolve.layout import Layout, translated
from satcheck.audit.resolve.resolution import Resolution, left_pairs, reasons
from satcheck.audit.resolve.rounds import Progress, Rounds
from satcheck.audit.resolve.walls import ORIGIN
from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.report.resolution import Move
from satcheck.scene import Scene
from satcheck.scene.rules import Selector

ITERATIONS = 50


def resolve(
    scene: Scene,
    settings: Settings | None = None,
    *,
    pins: Sequence[str] = (),
    max_motion: float | None = None,
    iterations: int = ITERATIONS,
    progress: Progress | None = None,
) -> Resolution:
    """Translations, without rotation, that end every overlap of a scene that can be ended.

    `check` with these settings decides what an overlap is: a pair that the scene allows or ignores
    stays, and an overlap within the touch band is a touch. A pair closer than its clearance is
    pushed apart. A body that is moved ends free of all others, without any touch band. The
    translations are short, not the shortest.

    pins: selectors of bodies that stay, as in rules. Static and pinned bodies of the scene and
    links of robots stay too. max_motion: no body is moved farther. iterations: rounds of pushing,
    after which bodies are taken out to free places. progress(done, total) counts pairs.

    Raises SatcheckError: `bad-setting`, `unknown-pin`, and what `check` raises.
    """
    settings = settings or Settings()
    _require_limits(max_motion, iterations)
    scene.require_in_space("resolve moves bodies in space only")
    scene.require_one_unit()
    staying = _staying(scene, pins)
    with ExitStack() as stack:
        meter = stack.enter_context(volume_meter(settings)) if _limits_volume(scene) else None
        layout = Layout(scene, settings, staying, meter)
        before = layout.states(layout.close_pairs())
        kinds = Counter(state.kind for state in before.values())
        longest = max_motion or math.inf
        rounds = Rounds(layout, longest)
        rounds.run(iterations, progress)
        why = reasons(layout, staying, _links(scene), rounds.left)
    translations = _translations(layout)
    moves = _moves(scene, translations)
    report = check(moved_scene(scene, translations), proof_of(settings))
    return Resolution(
        moves=moves,
        pinned=tuple(body.id for body in scene.bodies if body.id in staying),
        overlaps=kinds["overlap"],
        gaps=kinds["near"],
        open=kinds["open"],
        rounds=rounds.count,
        left=tuple(left_pairs(report, why)),
        report=report,
    )


def _require_limits(max_motion: float | None, iterations: int) -> None:
    if max_motion is not None and not (math.isfinite(max_motion) and max_motion > 0):
        raise SatcheckError("bad-setting", f"max_motion must be positive, not {max_motion!r}")
    if iterations < 0:
        raise SatcheckError("bad-setting", f"iterations must be 0 or more, not {iterations!r}")


def _limits_volume(scene: Scene) -> bool:
    return any(rule.max_volume is not None for rule in scene.rules)


def proof_of(settings: Settings) -> Settings:
    """The settings for the check of the moved scene: the same, without figures for overlaps."""
    return replace(
        settings,
        depth=False,
        contacts=False,
        components=False,
        volume=False,
        cross_check=False,
        certificate=False,
    )


def _links(scene: Scene) -> frozenset[str]:
    """The bodies of robots, which are placed by joints."""
    robots = (robot for robot in scene.robots if not robot.loose)
    return frozenset(part.id for robot in robots for part in robot.bodies)


def _staying(scene: Scene, pins: Sequence[str]) -> frozenset[str]:
    links = _links(scene)
    pinned: set[str] = set()
    for selector in map(Selector, pins):
        chosen = selector.select(scene.in_order())
        if not chosen:
            raise SatcheckError("unknown-pin", f"no body is called {selector.text!r}")
        pinned.update(body.id for body in chosen)
    return frozenset(
        body.id
        for body in scene.bodies
        if body.static or body.pinned or body.id in links or body.id in pinned
    )


def _translations(layout: Layout) -> dict[str, Vector]:
    """Of the bodies that moved."""
    offsets = zip(layout.home, layout.offsets, strict=True)
    return {body.id: offset for body, offset in offsets if offset != ORIGIN}


def _moves(scene: Scene, translations: Mapping[str, Vector]) -> tuple[Move, ...]:
    """In the order of the scene."""
    return tuple(
        Move(body.id, offset, math.hypot(*offset))
        for body in scene.bodies
        if (offset := translations.get(body.id, ORIGIN)) != ORIGIN
    )


def moved_scene(scene: Scene, translations: dict[str, Vector]) -> Scene:
    """The scene with these bodies, by id, moved in the world."""
    return replace(
        scene,
        bodies=tuple(
            translated(body, translations[body.id]) if body.id in translations else body
            for body in scene.bodies
        ),
    )
