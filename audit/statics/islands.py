"""The contact graph, with its islands of free bodies, chains to fixed ones, and what floats; and
whether the bodies of one island stand: forces, or the motion that starts, or why it is open."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from functools import cached_property

import numpy as np
from msgspec import Struct

from satcheck.audit.statics.contacts import joined
from satcheck.audit.statics.equilibrium import Answer, Island, find_forces, solve
from satcheck.audit.statics.near import Floats
from satcheck.audit.statics.subjects import Subject, Terms
from satcheck.audit.statics.touching import Contact
from satcheck.report.statics import BodyIsland, State


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


class Outcome(Struct, frozen=True, dict=True):
    """stated: as in the report. island: with all its contacts; None: nothing was solved. forces:
    (contact, point) -> force on the first body of the contact. motions: body -> velocity (6,)."""

    stated: BodyIsland
    island: Island | None = None
    forces: dict[tuple[int, int], Floats] = {}
    motions: dict[int, Floats] = {}

    @cached_property
    def standing(self) -> Island | None:
        """The island with the contacts at which forces hold it; None: no such forces are known."""
        if self.island is None or self.stated.tolerant != "yes":
            return None
        return self.island.among_strict() if self.stated.strict == "yes" else self.island

    @cached_property
    def beside_walls(self) -> bool:
        """Whether a contact is steeper than 45 degrees, so that it may squeeze."""
        if self.island is None:
            return False
        return bool((np.abs(self.island.normals @ self.island.down) < np.sqrt(0.5)).any())


def left_open(members: Sequence[int], subjects: Sequence[Subject], reason: str) -> Outcome:
    """An island of which nothing is known."""
    names = tuple(subjects[k].id for k in members)
    return Outcome(BodyIsland(names, "open", "open", reason=reason))


def outcome_of(
    members: Sequence[int],
    subjects: Sequence[Subject],
    contacts: Sequence[tuple[int, Contact]],
    terms: Terms,
    *,
    alone: bool,
) -> Outcome:
    """members: the bodies of the island. contacts: of these bodies, with their numbers. alone: no
    body of the scene is unusable."""
    reason = _why_not(members, subjects, contacts)
    if reason is not None:
        return left_open(members, subjects, reason)
    island = weigh(members, subjects, contacts, terms)

    def outcome(
        tolerant: State, strict: State, answer: Answer, reason: str | None = None
    ) -> Outcome:
        names = tuple(subjects[k].id for k in members)
        stated = BodyIsland(names, tolerant, strict, answer.missing, reason=reason)
        if answer.forces is None:
            return Outcome(stated, island)
        solved = island.among_strict() if strict == "yes" else island
        rows = map(tuple, solved.rows.tolist())
        return Outcome(stated, island, dict(zip(rows, answer.forces, strict=True)))

    nearest = find_forces(island.among_strict())
    if nearest.holds:
        return outcome("yes", "yes", nearest)
    tolerant = solve(island)
    if tolerant.holds:
        reason = "forces exist only if all surfaces within the tolerance count as contacts"
        return outcome("yes", "open", tolerant, reason)
    reason = "the solver finds neither forces nor a motion: it is at its limit"
    if tolerant.motion is not None:
        reason = _why_incomplete(subjects, contacts, alone)
        if reason is None:
            falls = outcome("no", "no", tolerant)
            return Outcome(falls.stated, island, motions=_motions(members, tolerant.motion))
    return outcome("open", "open", tolerant, reason)


def _why_not(
    members: Sequence[int], subjects: Sequence[Subject], contacts: Sequence[tuple[int, Contact]]
) -> str | None:
    """Why nothing can be decided; None: it can."""
    for k in members:
        if subjects[k].why_massless is not None:
            return subjects[k].why_massless
    for _, contact in contacts:
        a, b = subjects[contact.a].id, subjects[contact.b].id
        if contact.touch == "overlapping":
            return f"{a} and {b} overlap by more than the tolerance"
        if contact.touch == "unknown":
            return f"{a} and {b}: {contact.reason}"
    return None


def _why_incomplete(
    subjects: Sequence[Subject], contacts: Sequence[tuple[int, Contact]], alone: bool
) -> str | None:
    """Why contacts may be missing, so that nothing is proven to fall; None: none are."""
    for _, contact in contacts:
        if not contact.complete:
            a, b = subjects[contact.a].id, subjects[contact.b].id
            return f"the contacts of {a} and {b} are not all known"
    return None if alone else "a body that cannot be used may hold it"


def weigh(
    members: Sequence[int],
    subjects: Sequence[Subject],
    contacts: Sequence[tuple[int, Contact]],
    terms: Terms,
) -> Island:
    number = {body: k for k, body in enumerate(members)}
    bodies = [(number.get(c.a, -1), number.get(c.b, -1)) for _, c in contacts]
    friction = [terms.friction_of(subjects[c.a].terms, subjects[c.b].terms) for _, c in contacts]
    points = joined([contact.points for _, contact in contacts])
    counts = [len(contact.points) for _, contact in contacts]
    both = np.repeat(np.array(bodies, dtype=np.int64).reshape(-1, 2), counts, axis=0)
    rows = [(index, k) for index, contact in contacts for k in range(len(contact.points))]
    free = [subjects[k] for k in members]
    return Island(
        weights=np.array([subject.mass for subject in free], dtype=float),
        centres=np.array([subject.centre for subject in free], dtype=float),
        sizes=np.array([subject.body.diagonal for subject in free]),
        down=np.array(terms.gravity),
        first=both[:, 0],
        second=both[:, 1],
        at=points.at,
        normals=points.normals,
        friction=np.repeat(np.array(friction, dtype=float), counts),
        strict=points.strict,
        rows=np.array(rows, dtype=np.int64).reshape(-1, 2),
    )


def _motions(members: Sequence[int], motion: Floats) -> dict[int, Floats]:
    """The motions of the bodies that move, as shares of the fastest."""
    fastest = np.abs(motion).max()
    return {body: motion[k] / fastest for k, body in enumerate(members) if motion[k].any()}
