"""Suggests which bodies of a scene are fixed, so that rules of support can be asked of the others.
A person must decide: a mesh does not say whether it is a building or a box.
"""

from __future__ import annotations

import re

import numpy as np
from msgspec import Struct

from satcheck.audit.bodies.placed_bodies import place
from satcheck.audit.request.settings import Settings
from satcheck.audit.statics.subjects import Subject, subjects_of
from satcheck.audit.statics.terms import terms_for
from satcheck.audit.statics.touching import contacts_of
from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene
from satcheck.scene.statics import terms_of

# The last word of names of bodies that hold others: "house/floor", "Wall.001", no "floor_lamp".
STRUCTURE = re.compile(
    r"(?<![a-z])(floor|ground|terrain|wall|ceiling|foundation|slab|roof|building)s?[\W\d_]*$", re.I
)


class Fixed(Struct, frozen=True):
    """A body that may be fixed, and the evidence."""

    body: str
    evidence: str


class SupportTerms(Struct, frozen=True):
    """gravity: unit. fixed: the suggested bodies, in the order of the scene. known: the number of
    bodies that are fixed already."""

    gravity: Vector
    fixed: tuple[Fixed, ...]
    known: int


def suggest_support(scene: Scene, settings: Settings) -> SupportTerms:
    """Bodies with the name of a part of a building; if there are none and no body is fixed, those
    that reach down to the lowest point of the scene.

    Raises SatcheckError: `planar-only`; `units-unknown` if bodies have no common unit.
    """
    scene.require_in_space("rules of support need bodies in space")
    scene.require_one_unit()
    bodies = place(scene, settings)
    everything = terms_of(scene.in_order(), scene.body_rules)
    subjects = subjects_of(list(bodies.placed.values()), [everything[k] for k in bodies.placed])
    if not subjects:
        raise SatcheckError("too-few-bodies", "no body can be read")
    free = [subject for subject in subjects if subject.fixed is None]
    terms = terms_for(scene, [subject.body for subject in free])
    fixed = [
        Fixed(subject.id, f"its name says {word[1].lower()}")
        for subject in free
        if (word := STRUCTURE.search(subject.id)) is not None
    ]
    if not fixed and len(free) == len(subjects):
        fixed = _lowest(free, np.array(terms.gravity), terms.tolerance, settings)
    return SupportTerms(terms.gravity, tuple(fixed), len(subjects) - len(free))


def _lowest(
    free: list[Subject], down: np.ndarray, tolerance: float, settings: Settings
) -> list[Fixed]:
    reach = [_reach(subject, down) for subject in free]
    contacts, _ = contacts_of(free, tolerance, settings)
    touching = [0] * len(free)
    for contact in contacts:
        touching[contact.a] += 1
        touching[contact.b] += 1
    return [
        Fixed(subject.id, f"it lies lowest, and touches {touching[k]} of the others")
        for k, subject in enumerate(free)
        if reach[k] >= max(reach) - tolerance
    ]


def _reach(subject: Subject, down: np.ndarray) -> float:
    """How far the box of the body reaches down."""
    low, high = (np.array(end) for end in subject.body.bounds)
    return float(np.maximum(down * low, down * high).sum())
