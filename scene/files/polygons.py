"""Cuts polygons into triangles."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from satcheck._native.readers import ReadError, cut_polygons
from satcheck.scene.errors import Refused


def triangles_of(
    points: NDArray[np.floating[Any]], corners: ArrayLike, lengths: ArrayLike
) -> NDArray[np.int64]:
    """Return the triangles of polygons, (n, 3): numbers of points.

    points: (m, 3). corners: of all polygons, one after the other. lengths: the number of corners of
    each. Raises Refused.
    """
    if (np.asarray(lengths) == 3).all():
        return np.asarray(corners, np.int64).reshape(-1, 3)
    cut = cut_polygons(
        points.astype("<f8").tobytes(),
        np.asarray(corners, "<u4").tobytes(),
        np.asarray(lengths, "<u4").tobytes(),
    )
    if isinstance(cut, ReadError):
        raise Refused(cut.code, cut.message)
    return np.frombuffer(cut, "<u4").astype(np.int64).reshape(-1, 3)
