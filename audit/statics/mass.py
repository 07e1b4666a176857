"""Volume and centre of mass of a closed surface.

B. Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties" (1996): by tetrahedra
between each triangle and one point, which is taken inside the box of the body, so that little
cancels. The weights only set up the problem; the checker of certificates weighs again, exactly.
"""

from __future__ import annotations

import math

import numpy as np

from satcheck.audit.statics.near import Floats, Indices, cross
from satcheck.core.shapes import Cone, Primitive, half_sizes


def volume_and_centre(points: Floats, triangles: Indices) -> tuple[float, Floats]:
    """Of the region that the surface winds around once. The volume may be 0 or less."""
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
