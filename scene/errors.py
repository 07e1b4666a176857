"""Why a file cannot be used. Codes are those of `codes.CODES`."""

from __future__ import annotations

from satcheck.core.errors import SatcheckError


class MeshFileError(SatcheckError):
    """A mesh file cannot be used; the others still can."""


class SceneFileError(SatcheckError):
    """A scene file cannot be used, and nothing of it is."""
