"""Geometry on arrays: meshes, convex shapes, exact relations, distances.

Nothing here reads files, prints, or keeps state. Signs, frames and units: ``core.conventions``.
"""

from satcheck.core._native import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Hull,
    Mesh,
    MeshRelation,
    PairResult,
    PairResults,
    PolygonResult,
    Polytope,
    Shape,
    Sphere,
    Surface,
    Topology,
    check_pair,
    check_pairs,
    mesh_relation,
    sat_polygons,
)

__all__ = [
    "Box",
    "Capsule",
    "Cone",
    "Cylinder",
    "Ellipsoid",
    "Hull",
    "Mesh",
    "MeshRelation",
    "PairResult",
    "PairResults",
    "PolygonResult",
    "Polytope",
    "Shape",
    "Sphere",
    "Surface",
    "Topology",
    "check_pair",
    "check_pairs",
    "mesh_relation",
    "sat_polygons",
]
