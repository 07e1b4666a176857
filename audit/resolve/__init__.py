"""Pushing the bodies of a scene apart: `resolve` and its result."""

from __future__ import annotations

from satcheck.audit.resolve.resolve import Resolution, moved_scene, proof_of, resolve

__all__ = ["Resolution", "moved_scene", "proof_of", "resolve"]
