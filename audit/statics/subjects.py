"""The bodies of a question of support: what is fixed, what weighs how much, what can touch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
from msgspec import Struct

from satcheck.audit.body import PlacedBody
from satcheck.audit.statics.features import Features, features_of
from satcheck.audit.statics.near import Floats, Indices, cross
from satcheck.core.conventions import Vector
from satcheck.core.curved.placed import CurvedShape, rows_of
from satcheck.core.shapes import Cone, Primitive, Sphere, half_sizes
from satcheck.scene.statics import FRICTION, BodyTerms, StaticsTerms, down_of
from satcheck.scene.units import MICROMETRES, unit_of

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.scene import Scene


TOLERANCE_MICROMETRES = 1000  # 1 mm, if the unit of length is known
TOLERANCE_SHARE = 1e-3  # of the smallest free body, if it is not
Stated = Literal["gravity", "friction", "tolerance"]


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


def subject_of(body: PlacedBody, terms: BodyTerms) -> Subject:
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


def volume_and_centre(points: Floats, triangles: Indices) -> tuple[float, Floats]:
    """Return those of the region that the surface winds around once. The volume may be 0 or less.

    B. Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties" (1996): by tetrahedra
    between each triangle and one point, which is taken inside the box of the body, so that little
    cancels. The weights only set up the problem; the checker of certificates weighs again, exactly.
    """
    used = points[triangles]
    middle = 0.5 * (used.min(axis=(0, 1)) + used.max(axis=(0, 1)))
    corners = used - middle
    six = np.einsum("ti,ti->t", corners[:, 0], cross(corners[:, 1], corners[:, 2]))
    volume = math.fsum(six) / 6.0
    if volume <= 0:
        return volume, middle
    moments = [math.fsum(six * corners[:, :, k].sum(axis=1)) / 24.0 for k in range(3)]
    return volume, middle + np.array(moments) / volume


def volume_of_shape(shape: Primitive) -> float:
    """Of a curved shape: that of a ball, a cylinder or a cone of its half sizes."""
    from satcheck.core.shapes import Capsule, Cylinder, Ellipsoid, Sphere

    a, b, c = half_sizes(shape)
    match shape:
        case Sphere():
            return 4.0 / 3.0 * math.pi * a**3
        case Ellipsoid():
            return 4.0 / 3.0 * math.pi * a * b * c
        case Capsule():
            return math.pi * a * a * (2 * c + 4.0 / 3.0 * a)
        case Cylinder():
            return math.pi * a * a * 2 * c
        case Cone():
            return math.pi * a * a * 2 * c / 3.0
        case _:
            return 8 * a * b * c


def centre_above_origin(shape: Primitive) -> float:
    """The height of the centre of mass of a shape along its own axis."""
    return -shape.height / 4.0 if isinstance(shape, Cone) else 0.0


class Terms(Struct, frozen=True):
    """Gravity, friction and tolerance of a check. gravity: unit. stated: which of these the scene
    states; the others are assumed."""

    gravity: Vector
    friction: float
    tolerance: float
    stated: tuple[Stated, ...]

    def friction_of(self, a: BodyTerms, b: BodyTerms) -> float:
        """Of a contact of two bodies: the smaller of theirs."""
        own = [terms.value("friction") for terms in (a, b)]
        return min([value for value in own if value is not None], default=self.friction)


def terms_for(scene: Scene, free: Sequence[PlacedBody]) -> Terms:
    """free: the bodies that may fall."""
    stated = scene.statics or StaticsTerms()
    gravity = stated.gravity or down_of(scene)
    size = math.hypot(*gravity)
    x, y, z = (c / size for c in gravity)
    names: tuple[Stated, ...] = ("gravity", "friction", "tolerance")
    return Terms(
        (x, y, z),
        FRICTION if stated.friction is None else stated.friction,
        contact_tolerance(scene, free),
        tuple(name for name in names if getattr(stated, name) is not None),
    )


def contact_tolerance(scene: Scene, free: Sequence[PlacedBody]) -> float:
    """As stated, else by the unit of length, else by the smallest of these bodies."""
    if scene.statics is not None and scene.statics.tolerance is not None:
        return scene.statics.tolerance
    unit = unit_of(scene.units)
    if unit is not None:
        return TOLERANCE_MICROMETRES / MICROMETRES[unit]
    return TOLERANCE_SHARE * min((body.diagonal for body in free), default=0.0)
