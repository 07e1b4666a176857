"""What `satcheck suggest --surface-tolerance` proposes: how far facets are off the curved surfaces
that they stand for, with the evidence."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Length, Size, Tool, Value, Vector


class FacetedCurves(Value, frozen=True):
    """Chains of facets with the same radius and sagitta, to a few per cent.

    concave: the facets lie outside of the material of the curved body, or the mesh is not solid;
    else inside. chains: how many. facets: of all of them. sagitta: the largest distance of a facet
    from the curve. Of that facet, degrees: the angle by which the surface turns over it; radius: of
    curvature; place: a point of it, world.
    """

    concave: bool
    chains: Count
    facets: Count
    degrees: Size
    radius: Size
    sagitta: Size
    place: Vector


class BodyTolerance(Value, frozen=True):
    """surface_tolerance: the largest sagitta of a concave curve, rounded up: so far the mesh has
    more material than the curved body. None: no such curve is seen. stated: the body is a shape
    stated by its sizes, which has no facets. left_out: chains that turn by more than `most_degrees`
    from facet to facet, and may be prisms. Concave ones first, then the largest sagitta.
    """

    body: str
    surface_tolerance: Length | None
    stated: bool
    curves: tuple[FacetedCurves, ...]
    left_out: tuple[FacetedCurves, ...]


class SurfaceTolerancesReport(Value, frozen=True, kw_only=True):
    """Surface tolerances, measured on the meshes alone. Lengths in the units of the scene.

    surface_tolerance: that covers all bodies; None: no body needs one, or they have different units
    of length. most_degrees: the largest angle between two facets that is read as
    that of a curve. least_facets: in a chain.
    """

    schema: Literal["satcheck.surface-tolerances/1"] = "satcheck.surface-tolerances/1"
    tool: Tool
    units: str | None
    surface_tolerance: Length | None
    most_degrees: Size
    least_facets: Count
    bodies: tuple[BodyTolerance, ...]
