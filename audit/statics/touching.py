"""Which bodies touch, and where.

The ladder decides which pairs are farther apart than the tolerance, and which overlap by more; that
is proven. The contact points of the others are found on their features.

Some contacts lie along an edge of both bodies, as of a plate that is exactly as wide as its gap.
Such a contact is a line at the border of both faces: the least shift opens it. It needs the
tolerance, so it is no strict contact.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.body import largest_coordinate
from satcheck.audit.checked_pairs import examine_pairs
from satcheck.audit.pair import Pair
from satcheck.audit.planner import request_for
from satcheck.audit.settings import Settings
from satcheck.audit.statics.contacts import (
    NOBODY,
    PARALLEL,
    Points,
    ball_on_ball,
    ball_on_mesh,
    contact_points,
)
from satcheck.audit.statics.features import Features
from satcheck.audit.statics.near import Floats, TooManyNear, cross, near_boxes
from satcheck.audit.statics.subjects import Ball, Subject, Terms
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import Finding
from satcheck.report.statics import Touch

# Coordinates are off by the precision of the files, up to this share of the tolerance.
PRECISION_SHARE = 0.01
TOO_FINE = "too many facets within the tolerance of contacts: state a smaller [statics] tolerance"
TOO_THIN = "thinner than the tolerance of contacts: state a smaller [statics] tolerance"
# The cosine below which two normals are opposed.
OPPOSED = -0.5
# More pairs of contacts at one place are those of facets finer than the tolerance.
MOST_NEAR = 2_000_000
# Contacts with normals that differ by less are of one patch.
SAME_NORMAL = 1e-7
STEEP = np.sqrt(0.5)  # the cosine of 45 degrees: a steeper contact does not carry, it leans


class Contact(Struct, frozen=True):
    """Two subjects by number, the first below the second. complete: no contact within the tolerance
    is missing. reason: why the touch is unknown."""

    a: int
    b: int
    touch: Touch
    complete: bool
    points: Points = NOBODY
    reason: str | None = None


def contacts_of(
    subjects: Sequence[Subject], tolerance: float, settings: Settings
) -> tuple[list[Contact], int]:
    """The contacts of free bodies, and the number of pairs that were looked at."""
    low = np.array([subject.body.bounds[0] for subject in subjects])
    high = np.array([subject.body.bounds[1] for subject in subjects])
    fixed = np.array([subject.fixed is not None for subject in subjects])
    i, j = near_boxes(low, high, low, high, tolerance)
    kept = (i < j) & ~(fixed[i] & fixed[j])
    numbers = sorted(zip(i[kept].tolist(), j[kept].tolist(), strict=True))
    plain = Settings(
        tolerance=tolerance, depth=False, allow_open=settings.allow_open, jobs=settings.jobs
    )
    request = request_for(plain, composed=True)
    pairs = [Pair(subjects[a].body, subjects[b].body, plain, request) for a, b in numbers]
    contacts = []
    for (a, b), pair in zip(numbers, examine_pairs(pairs, settings.jobs), strict=True):
        contact = _contact(subjects, a, b, pair.finding, tolerance)
        if contact is not None:
            contacts.append(contact)
    return contacts, len(numbers)


def _contact(
    subjects: Sequence[Subject], a: int, b: int, finding: Finding, tolerance: float
) -> Contact | None:
    """None: they are farther apart than the tolerance."""
    if finding.undecided in ("relation", "inside") or finding.quality == "estimate":
        reason = finding.reason or "how they relate is not decided"
        return Contact(a, b, "unknown", False, reason=reason)
    if finding.relation in ("separated", "near"):
        return None
    if finding.relation != "touching":
        return Contact(a, b, "overlapping", False)
    one, other = subjects[a], subjects[b]
    try:
        points = _points(one, other, tolerance)
    except TooManyNear:
        return Contact(a, b, "unknown", False, reason=TOO_FINE)
    if may_be_through(points, one.form, other.form, tolerance):
        return Contact(a, b, "unknown", False, reason=TOO_THIN)
    complete = one.complete and other.complete and len(points) > 0
    return Contact(a, b, "touching", complete, points)


def _points(one: Subject, other: Subject, tolerance: float) -> Points:
    rounding = rounding_of(one, other, tolerance)
    a, b = one.form, other.form
    if a is None or b is None:
        return NOBODY
    if isinstance(a, Features) and isinstance(b, Features):
        return contact_points(a, b, tolerance, rounding)
    if isinstance(a, Ball) and isinstance(b, Ball):
        return ball_on_ball(a.centre, a.radius, b.centre, b.radius, tolerance)
    if isinstance(a, Ball) and isinstance(b, Features):
        return ball_on_mesh(a.centre, a.radius, b, tolerance, rounding)
    assert isinstance(a, Features)
    assert isinstance(b, Ball)
    return ball_on_mesh(b.centre, b.radius, a, tolerance, rounding).turned()


def rounding_of(one: Subject, other: Subject, tolerance: float) -> float:
    """How far coordinates of both may be off by themselves."""
    written = min(one.body.resolution + other.body.resolution, PRECISION_SHARE * tolerance)
    return written + rounding_pad(largest_coordinate(one.body.bounds, other.body.bounds))


def may_be_through(
    points: Points, a: Features | Ball | None, b: Features | Ball | None, tolerance: float
) -> bool:
    """Return whether a contact may be on the far side of a body that is too thin for the tolerance.

    A tile that hangs under a thin plate has its bottom within the tolerance of the plate's top. So
    it seems to lie on the plate, and a force of the wrong sign seems to hold it. There, the overlap
    is the thickness of both less the real overlap, and both overlaps are up to the tolerance. Walls
    may be thinner than their body: then contacts at one place have opposed normals. So may contacts
    too many to compare.
    """
    if a is None or b is None or not len(points):
        return False
    normals = np.unique(np.round(points.normals, 7), axis=0)
    if (_widths(a, normals) + _widths(b, normals)).min() <= 2 * tolerance:
        return True
    at = points.at
    try:
        i, j = near_boxes(at, at, at, at, 4 * tolerance, MOST_NEAR)
    except TooManyNear:
        return True
    cosines = np.einsum("ci,ci->c", points.normals[i], points.normals[j])
    return bool((cosines < OPPOSED).any())


def _widths(form: Features | Ball, normals: Floats) -> Floats:
    """Of a body along each normal."""
    if isinstance(form, Ball):
        return np.full(len(normals), 2 * form.radius)
    return np.array([np.ptp(form.points @ normal) for normal in normals])


def without_flush_edges(
    contacts: Sequence[Contact], subjects: Sequence[Subject], terms: Terms
) -> list[Contact]:
    """The same contacts; those of patches that are such a line, and carry a weight, are not
    strict. Bodies that lean against each other, as two cards, are pressed together."""
    down = np.array(terms.gravity)
    judged = []
    for contact in contacts:
        one, other = subjects[contact.a], subjects[contact.b]
        if isinstance(one.form, Features) and isinstance(other.form, Features):
            rounding = rounding_of(one, other, terms.tolerance)
            points = _without_edges(contact.points, one.form, other.form, down, rounding)
            contact = replace(contact, points=points)
        judged.append(contact)
    return judged


def _without_edges(
    points: Points, a: Features, b: Features, down: Floats, rounding: float
) -> Points:
    rows = np.flatnonzero(points.strict & (np.abs(points.normals @ down) > STEEP))
    if not rows.size:
        return points
    strict = points.strict.copy()
    keys = np.round(points.normals[rows] / SAME_NORMAL)
    _, patch = np.unique(keys, axis=0, return_inverse=True)
    for number in range(int(patch.max()) + 1):
        own = rows[patch.reshape(-1) == number]
        if _is_flush_edge(points.at[own], a, b, rounding):
            strict[own] = False
    return replace(points, strict=strict)


def _is_flush_edge(at: Floats, a: Features, b: Features, rounding: float) -> bool:
    start = at[0]
    steps = at - start
    lengths = np.linalg.norm(steps, axis=1)
    farthest = int(lengths.argmax())
    if lengths[farthest] <= 4 * rounding:
        return False
    along = steps[farthest] / lengths[farthest]
    if np.linalg.norm(cross(steps, along), axis=1).max() > 4 * rounding:
        return False
    return _has_edge(a, start, along, rounding) and _has_edge(b, start, along, rounding)


def _has_edge(body: Features, at: Floats, along: Floats, rounding: float) -> bool:
    """Whether an edge between two faces that are not in one plane lies on this line."""
    ends = body.points[body.ends]
    edges = ends[:, 1] - ends[:, 0]
    sines = np.linalg.norm(cross(edges, along), axis=1)
    away = np.linalg.norm(cross(ends[:, 0] - at, along), axis=1)
    parallel = sines <= PARALLEL * np.linalg.norm(edges, axis=1)
    return bool((parallel & (away <= 4 * rounding)).any())
