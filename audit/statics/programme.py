"""Cone programmes of clarabel, with forces in friction cones as the first variables."""

from __future__ import annotations

from typing import Any

import numpy as np

from satcheck.audit.statics.near import Floats

SOLVED = ("Solved", "AlmostSolved")
PRECISION = 1e-10


def friction_rows(friction: Floats, columns: int) -> Any:
    """Rows of -(mu x_n, x_t, x_t) for each contact, of `columns` variables in all: each three are
    in a second-order cone."""
    from scipy import sparse

    scale = np.ones((len(friction), 3))
    scale[:, 0] = friction
    own = sparse.diags(-scale.ravel())
    return sparse.hstack([own, sparse.csc_matrix((own.shape[0], columns - own.shape[1]))])


def minimum(quadratic: Any, linear: Floats, rows: Any, limits: Floats, cones: list[Any]) -> Any:
    """The solution of: minimise x'Px / 2 + q'x with b - A x in the cones."""
    import clarabel
    from scipy import sparse

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = PRECISION
    solver = clarabel.DefaultSolver(
        sparse.csc_matrix(quadratic), linear, sparse.csc_matrix(rows), limits, cones, settings
    )
    return solver.solve()


def cone(size: int) -> Any:
    """A second-order cone."""
    import clarabel

    return clarabel.SecondOrderConeT(size)


def zeros(size: int) -> Any:
    import clarabel

    return clarabel.ZeroConeT(size)


def positive(size: int) -> Any:
    import clarabel

    return clarabel.NonnegativeConeT(size)
