"""Orders the joints of SDFormat and USD into trees.

A joint may name its links in either order, and joints may close loops. A joint of a loop cannot
move alone: it stays as the file places it, and a warning says so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from satcheck.core.conventions import Vector
from satcheck.core.transform import Transform, compose
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import Joint, JointKind, Limits, Mimic
from satcheck.scene.words import listed


class Moves(NamedTuple):
    """How a joint moves. axis: unit vector in the frame of the joint; of a prismatic joint its
    length is that of a metre in the unit of the poses. rest: the value at which the links stand as
    the file places them."""

    kind: JointKind
    axis: Vector = (0.0, 0.0, 1.0)
    limits: Limits | None = None
    mimic: Mimic | None = None
    rest: float = 0.0


class Edge(NamedTuple):
    """A joint between two links, or between a link and the world. pose: of its frame in the
    world."""

    path: str
    parent: str
    child: str
    pose: Transform
    moves: Moves

    def other(self, link: str) -> str:
        return self.parent if link == self.child else self.child


class Trees(NamedTuple):
    """roots: links that no joint carries. joints: parents first."""

    roots: list[str]
    joints: tuple[Joint, ...]


def trees_of(
    starts: Sequence[str],
    still: frozenset[str],
    poses: Mapping[str, Transform],
    edges: Iterable[Edge],
    note: Callable[[Edge, str], None],
) -> Trees:
    """starts: all links, and the world, in the order in which they become roots. still: the world
    and links of static models. poses: of links in the world. note: takes the message about a loop
    that this joint closes."""
    carriers, roots, loops = _walk(starts, still, list(edges))
    stuck = _stuck(carriers, loops, note)
    joints = (_joint(edge, link, poses, edge.path in stuck) for link, edge in carriers.items())
    return Trees(roots, tuple(joints))


def _walk(
    starts: Sequence[str], still: frozenset[str], edges: Sequence[Edge]
) -> tuple[dict[str, Edge], list[str], list[Edge]]:
    """(link -> the joint that carries it, roots, joints that close loops)"""
    around: dict[str, list[Edge]] = {}
    for edge in edges:
        for link in (edge.parent, edge.child):
            around.setdefault(link, []).append(edge)
    carriers: dict[str, Edge] = {}
    roots: list[str] = []
    reached: set[str] = set()
    used: set[str] = set()
    loops: list[Edge] = []
    for start in starts:
        if start in reached:
            continue
        first = [link for link in starts if link in still] if start in still else [start]
        roots += first
        reached.update(first)
        waiting = list(first)
        for link in waiting:  # grows
            for edge in around.get(link, ()):
                if edge.path in used:
                    continue
                used.add(edge.path)
                other = edge.other(link)
                if other in reached:
                    loops.append(edge)
                else:
                    reached.add(other)
                    carriers[other] = edge
                    waiting.append(other)
    return carriers, roots, loops


def _stuck(
    carriers: Mapping[str, Edge], loops: Iterable[Edge], note: Callable[[Edge, str], None]
) -> set[str]:
    """The joints that are part of a loop."""
    stuck: set[str] = set()
    for edge in loops:
        ways = [list(_way(link, carriers)) for link in (edge.parent, edge.child)]
        shared = {step.path for step in ways[0]} & {step.path for step in ways[1]}
        loop = [edge, *(step for way in ways for step in way if step.path not in shared)]
        stuck.update(step.path for step in loop)
        moving = [step.path for step in loop if step.moves.kind != "fixed"]
        if moving:
            cause = "joints of a loop are not moved, its links stay as the file places them: "
            note(edge, cause + listed(moving))
    return stuck


def _way(link: str, carriers: Mapping[str, Edge]) -> Iterator[Edge]:
    """The joints from the link to its root."""
    while link in carriers:
        yield carriers[link]
        link = carriers[link].other(link)


def _joint(edge: Edge, link: str, poses: Mapping[str, Transform], stuck: bool) -> Joint:
    """The joint that carries the link. If this is the parent of the joint, it moves against the
    axis."""
    carrier = edge.other(link)
    x, y, z = edge.moves.axis
    return Joint(
        name=edge.path,
        kind="fixed" if stuck else edge.moves.kind,
        parent=carrier,
        child=link,
        origin=compose(inverse(poses[carrier]), edge.pose),
        axis=(x, y, z) if link == edge.child else (-x, -y, -z),
        limits=None if stuck else edge.moves.limits,
        mimic=None if stuck else edge.moves.mimic,
        child_origin=compose(inverse(edge.pose), poses[link]),
        stands_at_zero=True,
        reference=(edge.moves.rest,) if edge.moves.rest and not stuck else (),
    )
