"""Shortens the translations of bodies that are free of each other, and keeps them free.

Each step puts walls between the bodies at their current places and computes the least motion that
keeps all walls. The bodies go there, or half of the way, or a quarter, if concave bodies would
meet. So every step decreases the sum of squares. The result is a local minimum. No body ends
farther from home than allowed, because a straight line between two allowed places stays allowed.
"""

from __future__ import annotations

import math
from collections.abc import Collection

from satcheck.audit.bodies.boxes import Box, largest_coordinate
from satcheck.audit.finding import examine
from satcheck.audit.request.trace import Trace
from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.pair_state import may_overlap, separation
from satcheck.audit.resolve.walls import ORIGIN, BodyPair, Wall, connected, least_motion
from satcheck.audit.vectors import added, dot, scaled, unit
from satcheck.core.conventions import Vector
from satcheck.core.rounding import rounding_pad

STEPS = 8
HALVINGS = 2
# The steps end when one decreases the sum of squares by less than this share.
LEAST_GAIN = 1e-3
# The same if few bodies overlap. Then touching bodies get walls, too, from a trial step back home
# by this share of the way.
CAREFUL_STEPS, CAREFUL_HALVINGS, CAREFUL_GAIN = 24, 6, 1e-5
STEP_BACK = 1e-2
BISECTIONS = 30

Offsets = dict[int, Vector]


def pull_back(layout: Layout, left: Collection[BodyPair], longest: float) -> None:
    """Decrease the sum of the squared translations. No translation is longer than `longest`, before
    or after.

    left: pairs that may overlap; no others do.
    """
    for _ in range(CAREFUL_STEPS if layout.careful else STEPS):
        start, before = dict(enumerate(layout.offsets)), layout.squares()
        if before == 0:
            return
        _step(layout, left, longest)
        if before - layout.squares() < _least_gain(layout) * before:
            layout.move(start)
            return


def walled(layout: Layout, pair: BodyPair) -> Wall | None:
    """The wall between two bodies at their current places. It leaves them the room by which they
    may approach or overlap. None: no direction is known."""
    placed = layout.pair(pair)
    apart = separation(placed)
    if apart is None:
        return _wall_of_contact(layout, pair) if layout.careful else None
    normal, gap = apart
    room = max(0.0, gap - layout.clearance(pair) + may_overlap(placed))
    return Wall(*pair, normal, dot(normal, layout.offset(pair)) - room)


def _wall_of_contact(layout: Layout, pair: BodyPair) -> Wall | None:
    """The wall between touching bodies, whose nearest points give no direction: from the overlap or
    the gap after a small step back home."""
    there = layout.offset(pair)
    if not any(there):
        return None
    back = layout.pair_after(pair, scaled(there, -STEP_BACK))
    way = examine(back, Trace()).finding.mtv
    if way is not None and any(way):
        normal, gap = unit(way), -math.hypot(*way)
    else:
        apart = separation(back)
        if apart is None:
            return None
        normal, gap = apart
    along = dot(normal, there)
    return Wall(*pair, normal, min(along, along * (1 - STEP_BACK) - gap))


def swept(start: Box, end: Box) -> Box:
    """The box around both boxes, and so around every box between them."""
    low = tuple(min(a, b) for a, b in zip(start[0], end[0], strict=True))
    high = tuple(max(a, b) for a, b in zip(start[1], end[1], strict=True))
    return low, high  # type: ignore[return-value]


def _least_gain(layout: Layout) -> float:
    return CAREFUL_GAIN if layout.careful else LEAST_GAIN


def _step(layout: Layout, left: Collection[BodyPair], longest: float) -> None:
    start = dict(enumerate(layout.offsets))
    groups = _groups(layout, left, longest)
    member = {body: number for number, group in enumerate(groups) for body in group}
    share = [1.0] * len(groups)
    halvings = CAREFUL_HALVINGS if layout.careful else HALVINGS
    while True:
        layout.move(
            {
                body: _between(start[body], end, share[number])
                for number, group in enumerate(groups)
                for body, end in group.items()
            }
        )
        met = {
            member[body]
            for pair, state in layout.states(layout.close_pairs()).items()
            if state.kind != "free" and pair not in left
            for body in pair
            if body in member and share[member[body]] > 0
        }
        if not met:
            return
        for number in met:
            share[number] = share[number] / 2 if share[number] > 0.5**halvings else 0.0


def _between(start: Vector, end: Vector, share: float) -> Vector:
    if share in (0.0, 1.0):
        return end if share else start
    return added(scaled(start, 1 - share), scaled(end, share))


def _groups(layout: Layout, left: Collection[BodyPair], longest: float) -> list[Offsets]:
    """The goals of the bodies, in groups that share walls; only groups that gain enough."""
    walls, held = _walls(layout, left)
    free = layout.movable - held.keys()
    goals: list[Offsets] = []
    for group in connected(walls, free):
        moved = least_motion(group, held)
        if not moved.broken:
            goals.append(moved.offsets)
    walled_in = {body for wall in walls for body in (wall.a, wall.b)}
    goals += [{body: ORIGIN} for body in sorted(free - walled_in)]
    goals = [_within(longest, layout, group) for group in goals]
    return [group for group in goals if _is_worth_it(layout, group)]


def _within(longest: float, layout: Layout, group: Offsets) -> Offsets:
    """The group as far on its way as none of it gets farther from home than that."""
    share = min(_share_within(longest, layout.offsets[body], end) for body, end in group.items())
    if share == 1.0:
        return group
    return {body: _between(layout.offsets[body], end, share) for body, end in group.items()}


def _share_within(longest: float, start: Vector, end: Vector) -> float:
    """The share of the way from start to end that stays within `longest` of the origin. start is
    within it. Found by bisection, and only shares that were tested are returned."""
    share, beyond = 1.0, 1.0
    if math.hypot(*end) <= longest:
        return share
    share = 0.0
    for _ in range(BISECTIONS):
        middle = (share + beyond) / 2
        if math.hypot(*_between(start, end, middle)) <= longest:
            share = middle
        else:
            beyond = middle
    return share


def _is_worth_it(layout: Layout, group: Offsets) -> bool:
    before = layout.squares(group)
    return math.fsum(dot(t, t) for t in group.values()) < (1 - _least_gain(layout)) * before


def _walls(layout: Layout, left: Collection[BodyPair]) -> tuple[list[Wall], Offsets]:
    """Between all bodies that might meet on their ways home; and the bodies that are held: those
    that stay, and those of pairs without a wall."""
    ways = [swept(a.bounds, b.bounds) for a, b in zip(layout.home, layout.placed, strict=True)]
    walls, held = (
        [],
        {i: ORIGIN for i in range(len(layout.home)) if i not in layout.movable},
    )
    for pair in layout.close_pairs(ways):
        if all(layout.offsets[body] == ORIGIN for body in pair) or pair in left:
            continue
        wall = walled(layout, pair)
        if wall is None:
            held.update({body: layout.offsets[body] for body in pair})
            continue
        wall.least += rounding_pad(largest_coordinate(*(layout.placed[i].bounds for i in pair)))
        walls.append(wall)
    return [wall for wall in walls if wall.a not in held or wall.b not in held], held
