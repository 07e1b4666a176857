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
    MeshDistance,
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
    deviation,
    mesh_distance,
    mesh_relation,
    sat_polygons,
)
from satcheck.core.conventions import OUTCOMES

__all__ = [
    "OUTCOMES",
    "Box",
    "Capsule",
    "Cone",
    "Cylinder",
    "Ellipsoid",
    "Hull",
    "Mesh",
    "MeshDistance",
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
    "deviation",
    "mesh_distance",
    "mesh_relation",
    "sat_polygons",
]
