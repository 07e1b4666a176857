"""Contacts along an edge of both bodies, as of a plate that is exactly as wide as its gap.

Such a contact is a line at the border of both faces: the least shift opens it. It needs the
tolerance, so it is no strict contact.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec.structs import replace

from satcheck.audit.statics.contacts import PARALLEL, Points
from satcheck.audit.statics.features import Features
from satcheck.audit.statics.near import Floats, cross
from satcheck.audit.statics.subjects import Subject, Terms
from satcheck.audit.statics.touching import Contact, rounding_of

# Contacts with normals that differ by less are of one patch.
SAME_NORMAL = 1e-7
STEEP = np.sqrt(0.5)  # the cosine of 45 degrees: a steeper contact does not carry, it leans


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
