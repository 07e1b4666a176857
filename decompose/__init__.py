"""Splits concave meshes into convex parts with a measured error, and caches them on disk."""

from satcheck.decompose.cache import Cache
from satcheck.decompose.decomposition import decompose
from satcheck.decompose.errors import DecompositionError
from satcheck.decompose.result import Decomposition, Note
from satcheck.decompose.settings import DecompositionSettings

__all__ = [
    "Cache",
    "Decomposition",
    "DecompositionError",
    "DecompositionSettings",
    "Note",
    "decompose",
]
