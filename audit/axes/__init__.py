"""satcheck.audit.axes: the separating axis theorem on one pair, axis by axis."""

from __future__ import annotations

from satcheck.audit.axes.study import axes_of

__all__ = ["axes_of"]
