"""The bodies of a question of support: what is fixed, what weighs how much, what can touch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from msgspec import Struct

from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.statics.features import Features, features_of
from satcheck.audit.statics.mass import (
    centre_above_origin,
    volume_and_centre,
    volume_of_shape,
)
from satcheck.audit.statics.near import Floats
from satcheck.core.curved.placed import CurvedShape, rows_of
from satcheck.core.shapes import Sphere
from satcheck.scene.statics import BodyTerms


class Ball(Struct, frozen=True):
    centre: Floats
    radius: float


class Subject(Struct, frozen=True):
    """A placed body. fixed: why it holds others; None: it may fall. mass, centre: of a free body;
    None: not known, and why_massless says why. form: what touches: a mesh, a ball, or None, if the
    contacts of such a body are not known. complete: all its contacts are found."""

    body: PlacedBody
    terms: BodyTerms
    fixed: Literal["static", "mounted"] | None
    form: Features | Ball | None
    complete: bool
    mass: float | None = None
    centre: Floats | None = None
    why_massless: str | None = None

    @property
    def id(self) -> str:
        return self.body.id


def subjects_of(bodies: Sequence[PlacedBody], terms: Sequence[BodyTerms]) -> list[Subject]:
    return [_subject(body, own) for body, own in zip(bodies, terms, strict=True)]


def _subject(body: PlacedBody, terms: BodyTerms) -> Subject:
    fixed: Literal["static", "mounted"] | None = None
    if body.body.static:
        fixed = "static"
    elif terms.value("mounted"):
        fixed = "mounted"
    form = _form(body)
    complete = isinstance(form, Ball) or (form is not None and body.solid)
    if fixed is not None:
        return Subject(body, terms, fixed, form, complete)
    volume, centre, why = _weighed(body, form)
    mass = terms.value("mass")
    if mass is None and volume is not None:
        mass = volume * (terms.value("density") or 1.0)
    return Subject(body, terms, None, form, complete, None if why else mass, centre, why)


def _form(body: PlacedBody) -> Features | Ball | None:
    if body.curved is not None:
        shape = body.curved.primitive
        if isinstance(shape, Sphere):
            return Ball(np.array(body.curved.centre), shape.radius)
        return None
    points, triangles = _mesh(body)
    if not body.solid:  # a sheet holds on both sides
        triangles = np.concatenate([triangles, triangles[:, ::-1]])
    return features_of(points, triangles)


def _mesh(body: PlacedBody) -> tuple[Floats, np.ndarray[tuple[int, int], np.dtype[np.int64]]]:
    mesh = body.mesh
    return np.array(mesh.vertices), np.array(mesh.triangles, dtype=np.int64)


def _weighed(
    body: PlacedBody, form: Features | Ball | None
) -> tuple[float | None, Floats | None, str | None]:
    """(volume, centre of mass, why they are not known)."""
    if body.curved is not None:
        return volume_of_shape(body.curved.primitive), _centre_of_shape(body.curved), None
    if not body.solid:
        return None, None, f"the mesh of {body.id} is not closed, so its mass is not known"
    if not body.shared.covers_once():
        return None, None, f"parts of {body.id} overlap each other, so its mass is not known"
    assert isinstance(form, Features)
    volume, centre = volume_and_centre(form.points, form.faces)
    if volume <= 0:
        return None, None, f"{body.id} has no volume, so its mass is not known"
    return volume, centre, None


def _centre_of_shape(curved: CurvedShape) -> Floats:
    axis = np.array([row[2] for row in rows_of(curved.turn)])
    return np.array(curved.centre) + centre_above_origin(curved.primitive) * axis
