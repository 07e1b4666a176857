"""Splits concave meshes into convex parts with a measured error, and caches them on disk."""

from satcheck.decompose.cache import Cache, user_cache
from satcheck.decompose.decomposition import decompose
from satcheck.decompose.errors import DecompositionError
from satcheck.decompose.result import Decomposition, Note
from satcheck.decompose.settings import ENGINES, DecompositionSettings, Limits

__all__ = [
    "ENGINES",
    "Cache",
    "Decomposition",
    "DecompositionError",
    "DecompositionSettings",
    "Limits",
    "Note",
    "decompose",
    "user_cache",
]
