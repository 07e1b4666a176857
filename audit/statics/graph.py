"""The contact graph: islands of free bodies, chains to fixed ones, and what floats."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from msgspec import Struct

from satcheck.audit.statics.subjects import Subject
from satcheck.audit.statics.touching import Contact
from satcheck.report.statics import State


class Graph(Struct, frozen=True):
    """By number of the body. touching: the bodies that surely touch it, overlapping ones included.
    chains: the shortest chain to a fixed body, itself first; empty if there is none. floating:
    whether there is none. islands: the free bodies of each island, by any contact, also an unknown
    one. island: of each free body."""

    touching: list[list[int]]
    chains: list[list[int]]
    floating: list[State]
    islands: list[list[int]]
    island: dict[int, int]


def graph_of(subjects: Sequence[Subject], contacts: Sequence[Contact], *, alone: bool) -> Graph:
    """alone: no other body exists; else, one that cannot be read may hold what seems to float."""
    count = len(subjects)
    sure: list[list[int]] = [[] for _ in range(count)]
    perhaps: list[list[int]] = [[] for _ in range(count)]
    for contact in contacts:
        for one, other in ((contact.a, contact.b), (contact.b, contact.a)):
            perhaps[one].append(other)
            if contact.touch != "unknown":
                sure[one].append(other)
    chains = _chains(subjects, sure)
    maybe = _chains(subjects, perhaps)
    floating: list[State] = []
    for chain, possible in zip(chains, maybe, strict=True):
        floating.append("no" if chain else "open" if possible or not alone else "yes")
    islands = _islands(subjects, perhaps)
    island = {body: number for number, bodies in enumerate(islands) for body in bodies}
    return Graph(sure, chains, floating, islands, island)


def _chains(subjects: Sequence[Subject], touching: Sequence[Sequence[int]]) -> list[list[int]]:
    """Breadth first from all fixed bodies. A fixed body ends a chain."""
    chains: list[list[int]] = [
        [k] if subject.fixed is not None else [] for k, subject in enumerate(subjects)
    ]
    queue = deque(k for k, chain in enumerate(chains) if chain)
    while queue:
        body = queue.popleft()
        for other in touching[body]:
            if not chains[other]:
                chains[other] = [other, *chains[body]]
                queue.append(other)
    return chains


def _islands(subjects: Sequence[Subject], touching: Sequence[Sequence[int]]) -> list[list[int]]:
    """Free bodies that are connected without a fixed one between them."""
    seen: set[int] = set()
    islands = []
    for start, subject in enumerate(subjects):
        if subject.fixed is not None or start in seen:
            continue
        seen.add(start)
        members, pending = [], [start]
        while pending:
            body = pending.pop()
            members.append(body)
            for other in touching[body]:
                if other not in seen and subjects[other].fixed is None:
                    seen.add(other)
                    pending.append(other)
        islands.append(sorted(members))
    return islands
