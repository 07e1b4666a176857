"""The report of `satcheck suggest --surface-tolerance`: the distance between facets and the curved
surfaces that they approximate, with the evidence."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Length, Size, Tool, Value, Vector


class FacetedCurves(Value, frozen=True):
    """Chains of facets with the same radius and sagitta, to a few per cent.

    concave: the facets lie outside of the material of the curved body, or the mesh is not solid;
    else inside. chains: number of chains. facets: number of their facets. sagitta: the largest
    distance of a facet from the curve. For that facet: degrees: the angle by which the surface
    turns over it; radius: of curvature; place: a point of it, world.
    """

    concave: bool
    chains: Count
    facets: Count
    degrees: Size
    radius: Size
    sagitta: Size
    place: Vector


class BodyTolerance(Value, frozen=True):
    """surface_tolerance: the largest sagitta of a concave curve, rounded up. The mesh has up to
    this much more material than the curved body. None: there is no such curve. stated: the body is
    a shape stated by its sizes, which has no facets. left_out: chains that turn by more than
    `most_degrees` from facet to facet, and may be prisms. Concave curves come first, then by
    decreasing sagitta.
    """

    body: str
    surface_tolerance: Length | None
    stated: bool
    curves: tuple[FacetedCurves, ...]
    left_out: tuple[FacetedCurves, ...]


class SurfaceTolerancesReport(Value, frozen=True, kw_only=True):
    """Surface tolerances, measured on the meshes alone. Lengths in the units of the scene.

    surface_tolerance: covers all bodies; None: no body needs one, or they have different units of
    length. most_degrees: the largest angle between two facets of a curve. least_facets: of a chain.
    """

    schema: Literal["satcheck.surface-tolerances/1"] = "satcheck.surface-tolerances/1"
    tool: Tool
    units: str | None
    surface_tolerance: Length | None
    most_degrees: Size
    least_facets: Count
    bodies: tuple[BodyTolerance, ...]
