"""Contacts through bodies that are too thin for the tolerance.

A tile that hangs under a thin plate has its bottom within the tolerance of the plate's top. So it
seems to lie on the plate, and a force of the wrong sign seems to hold it.
"""

from __future__ import annotations

import numpy as np

from satcheck.audit.statics.contacts import Points
from satcheck.audit.statics.features import Features
from satcheck.audit.statics.near import Floats, TooManyNear, near_boxes
from satcheck.audit.statics.subjects import Ball

TOO_THIN = "thinner than the tolerance of contacts: state a smaller [statics] tolerance"
# The cosine below which two normals are opposed.
OPPOSED = -0.5
# More pairs of contacts at one place are those of facets finer than the tolerance.
MOST_NEAR = 2_000_000


def may_be_through(
    points: Points, a: Features | Ball | None, b: Features | Ball | None, tolerance: float
) -> bool:
    """Whether a contact may be on the far side. There, the overlap is the thickness of both less
    the real overlap, and both overlaps are up to the tolerance. Walls may be thinner than their
    body: then contacts at one place have opposed normals. So may contacts too many to compare."""
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
