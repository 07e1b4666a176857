"""Whether the bodies of one island stand: forces, or the motion that starts, or why it is open."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec import Struct

from satcheck.audit.statics.equilibrium import Answer, Island, find_forces, solve
from satcheck.audit.statics.near import Floats
from satcheck.audit.statics.subjects import Subject, Terms
from satcheck.audit.statics.touching import Contact
from satcheck.report.statics import State


class Weighed(Struct, frozen=True):
    """An island as the solver sees it. rows: (contact, point) of each of its contact points.
    strict: (c,) whether that is a strict one."""

    island: Island
    rows: list[tuple[int, int]]
    strict: np.ndarray[tuple[int], np.dtype[np.bool_]]


class Outcome(Struct, frozen=True):
    """tolerant, strict: whether forces exist at all contacts, and at the strict ones. forces:
    (contact, point) -> force on the first body of the contact. motions: body -> velocity (6,).
    weighed: what was solved; None: nothing was. reason: why something is open."""

    tolerant: State
    strict: State
    forces: dict[tuple[int, int], Floats]
    motions: dict[int, Floats]
    missing: float | None = None
    weighed: Weighed | None = None
    reason: str | None = None

    @property
    def beside_walls(self) -> bool:
        """Whether a contact is steeper than 45 degrees, so that it may squeeze."""
        if self.weighed is None:
            return False
        island = self.weighed.island
        return bool((np.abs(island.normals @ island.down) < np.sqrt(0.5)).any())


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
        return Outcome("open", "open", {}, {}, reason=reason)
    weighed = weigh(members, subjects, contacts, terms)
    nearest = np.flatnonzero(weighed.strict)
    strict = find_forces(weighed.island.among(nearest))
    if strict.holds:
        rows = [weighed.rows[k] for k in nearest.tolist()]
        forces = _forces(rows, strict)
        return Outcome("yes", "yes", forces, {}, strict.missing, weighed)
    tolerant = solve(weighed.island)
    if tolerant.holds:
        reason = "forces exist only if all surfaces within the tolerance count as contacts"
        forces = _forces(weighed.rows, tolerant)
        return Outcome("yes", "open", forces, {}, tolerant.missing, weighed, reason)
    if tolerant.holds is None:
        reason = "the solver finds neither forces nor a motion: it is at its limit"
        return Outcome("open", "open", {}, {}, tolerant.missing, weighed, reason)
    reason = _why_incomplete(subjects, contacts, alone)
    if reason is not None:
        return Outcome("open", "open", {}, {}, tolerant.missing, weighed, reason)
    motions = _motions(members, tolerant)
    return Outcome("no", "no", {}, motions, tolerant.missing, weighed)


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
) -> Weighed:
    number = {body: k for k, body in enumerate(members)}
    first, second, at, normals, friction, strict = [], [], [], [], [], []
    rows: list[tuple[int, int]] = []
    for index, contact in contacts:
        count = len(contact.points)
        one, other = subjects[contact.a], subjects[contact.b]
        first += [number.get(contact.a, -1)] * count
        second += [number.get(contact.b, -1)] * count
        friction += [terms.friction_of(one.terms, other.terms)] * count
        at.append(contact.points.at)
        normals.append(contact.points.normals)
        strict.append(contact.points.strict)
        rows += [(index, k) for k in range(count)]
    free = [subjects[k] for k in members]
    nowhere = np.empty((0, 3))
    island = Island(
        np.array([subject.mass for subject in free], dtype=float),
        np.array([subject.centre for subject in free], dtype=float),
        np.array([subject.body.diagonal for subject in free]),
        np.array(terms.gravity),
        np.array(first, dtype=np.int64),
        np.array(second, dtype=np.int64),
        np.concatenate([nowhere, *at]),
        np.concatenate([nowhere, *normals]),
        np.array(friction, dtype=float),
    )
    return Weighed(island, rows, np.concatenate([np.empty(0, dtype=bool), *strict]))


def _forces(rows: Sequence[tuple[int, int]], answer: Answer) -> dict[tuple[int, int], Floats]:
    assert answer.forces is not None
    return dict(zip(rows, answer.forces, strict=True))


def _motions(members: Sequence[int], answer: Answer) -> dict[int, Floats]:
    assert answer.motion is not None
    fastest = np.abs(answer.motion).max()
    return {
        body: answer.motion[k] / fastest for k, body in enumerate(members) if answer.motion[k].any()
    }
