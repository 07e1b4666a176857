"""Pushing the bodies of a scene apart: `resolve` and its result."""

from __future__ import annotations

from satcheck.audit.resolve.resolution import Resolution
from satcheck.audit.resolve.resolve import ITERATIONS, moved_scene, proof_of, resolve

__all__ = [
    "ITERATIONS",
    "Resolution",
    "moved_scene",
    "proof_of",
    "resolve",
]
