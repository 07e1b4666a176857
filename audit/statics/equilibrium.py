"""Contact forces that balance gravity, or the motion that starts: two sides of one cone programme.

P. Livesley, "Limit analysis of structures formed from rigid blocks" (1978), E. Whiting et al.,
"Procedural modeling of structurally-sound masonry buildings" (2009), with Coulomb's cone instead of
a pyramid. For the forces f in their cones the missing force |A f + w| is minimal. If it is 0, f is
the proof. If not, its direction v is the virtual velocity: A'v is in the dual of every cone and
v.w > 0, so that no forces exist (Farkas).
"""

from __future__ import annotations

from itertools import chain
from typing import Any

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.statics.near import Flags, Floats, Indices, cross
from satcheck.core.errors import SatcheckError

# Cones are narrowed by this share to look for forces, and widened to look for a motion: rounding of
# a cone decides nothing.
CONE_ROUNDING = 1e-7
# Forces that miss this share of a weight are polished; what misses more is not found.
FOUND = 1e-5
# Forces balance if they miss no more than this share of the weight of any body.
BALANCED = 1e-9
# A body that moves less than one of these shares of the fastest is taken to rest, if it may.
RESTS = (1e-3, 1e-5, 1e-7, 1e-9, 0.0)
# A motion is a proof if no forces below this many times the weight of the island prevent it.
LEAST_FACTOR = 1e6


SOLVED = ("Solved", "AlmostSolved")
PRECISION = 1e-10


Block = tuple[Any, Floats, list[Any]]  # rows A, limits b, cones: b - A x is in the cones


class Island(Struct, frozen=True):
    """Bodies that touch each other, and their contacts. Body numbers count from 0; -1 is fixed.

    weights: (n,) over 0. centres: (n, 3). sizes: (n,) lengths for torques. down: unit. first,
    second: (c,) the bodies of each contact. at: (c, 3). normals: (c, 3) unit, from second to first.
    friction: (c,). strict: (c,) as `Points.strict`. rows: (c, 2) the numbers of the contact of two
    bodies, and of its point.
    """

    weights: Floats
    centres: Floats
    sizes: Floats
    down: Floats
    first: Indices
    second: Indices
    at: Floats
    normals: Floats
    friction: Floats
    strict: Flags
    rows: Indices

    def among_strict(self) -> Island:
        """The same bodies with the strict contacts alone."""
        of_contacts = ("first", "second", "at", "normals", "friction", "strict", "rows")
        return replace(self, **{name: getattr(self, name)[self.strict] for name in of_contacts})


class Answer(Struct, frozen=True):
    """holds: whether forces exist; None: not decided. forces: (c, 3) on the first body of each
    contact, units of the weights. motion: (n, 6) virtual velocity of each body: of its centre, then
    angular. missing: the smallest force that is missing, as a share of the weight."""

    holds: bool | None
    forces: Floats | None = None
    motion: Floats | None = None
    missing: float = 0.0


def require_solver() -> None:
    """Raises SatcheckError (`missing-extra`) if the solver is not installed."""
    try:
        import clarabel  # noqa: F401
        import scipy.sparse  # noqa: F401
    except ImportError:
        message = "rules of support need clarabel and scipy: pip install 'satcheck[statics]'"
        raise SatcheckError("missing-extra", message) from None


def find_forces(island: Island) -> Answer:
    """Forces that hold the island; if there are none, or none is found, holds is None."""
    answer = Programme(island, 1.0 - CONE_ROUNDING).answer()
    return answer if answer.holds else Answer(None, missing=answer.missing)


def solve(island: Island) -> Answer:
    """Forces that hold the island, or the motion that starts."""
    inner = find_forces(island)
    if inner.holds:
        return inner
    outer = Programme(island, 1.0 + CONE_ROUNDING).answer()
    return outer if outer.holds is False else inner


def tangents(normals: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors across each normal."""
    axis = np.argmin(np.abs(normals), axis=1)
    u = cross(normals, np.eye(3)[axis])
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    return u, cross(normals, u)


class Programme:
    """Minimise |A x + w| over forces x = (normal, tangent, tangent) in cones of friction times
    `widening`. Rows are in weights of their body, torques also in its size."""

    def __init__(self, island: Island, widening: float) -> None:
        self.island = island
        self.friction = island.friction * widening
        u, v = tangents(island.normals)
        slippery = island.friction == 0
        u[slippery] = v[slippery] = 0.0  # no tangential force
        self.frame = np.stack([island.normals, u, v], axis=2)  # columns
        self.matrix = _balance(island, self.frame)
        n = len(island.weights)
        self.load = np.zeros((n, 6))
        self.load[:, :3] = island.down
        self.unit = island.weights.max()

    def answer(self) -> Answer:
        x, motion, missing = self._minimum()
        if x is None:
            return Answer(None, missing=missing)
        if missing <= FOUND:
            x = self._polished(x)
            rest = self._rest(x)
            if np.abs(rest).max() <= BALANCED and self._within(x):
                forces = np.einsum("cij,cj->ci", self.frame, x) * self.unit
                return Answer(True, forces=forces, missing=float(np.abs(rest).max()))
        motion = None if motion is None else self._least_motion(motion)
        if motion is not None:
            velocity = motion.copy()
            velocity[:, 3:] /= self.island.sizes[:, None]
            velocity /= self.island.weights[:, None] / self.unit
            return Answer(False, motion=velocity, missing=missing)
        return Answer(None, missing=missing)

    def _minimum(self) -> tuple[Floats | None, Floats | None, float]:
        from clarabel import SecondOrderConeT
        from scipy import sparse

        rows, columns = self.matrix.shape
        # Variables: x, t. Cones: (t, A x + w), then (friction * normal, tangents) of each contact.
        missed = sparse.block_diag([-self.matrix, [[-1.0]]]).tocsr()
        missed = missed[[rows, *range(rows)]]
        limits = np.concatenate([[0.0], self.load.ravel()])
        solution = minimum(
            np.eye(1, columns + 1, columns)[0],
            (missed, limits, [SecondOrderConeT(rows + 1)]),
            friction_cones(self.friction, columns + 1),
            accepted=(*SOLVED, "InsufficientProgress"),
        )
        if solution is None:
            return None, None, 0.0
        forces = np.array(solution.x[:-1]).reshape(-1, 3)
        forces[self.friction == 0, 1:] = 0.0
        missing = float(np.linalg.norm(self._rest(forces)))
        return forces, -np.array(solution.z[1 : rows + 1]).reshape(-1, 6), missing

    def _rest(self, x: Floats) -> Floats:
        """(n, 6) what is missing."""
        rest: Floats = (self.matrix @ x.ravel()).reshape(-1, 6) + self.load
        return rest

    def _within(self, x: Floats) -> bool:
        """Whether all forces are in their cones, which are narrower than those of the question."""
        return bool(np.all(np.hypot(x[:, 1], x[:, 2]) <= self.island.friction * x[:, 0]))

    def _polished(self, x: Floats) -> Floats:
        """Takes the rest away, by changes in proportion to the forces."""
        from scipy import sparse
        from scipy.sparse.linalg import MatrixRankWarning, spsolve  # noqa: F401

        x = x.copy()
        room = np.maximum(self.friction * x[:, 0], 0.0) + 1e-12
        tangent = np.hypot(x[:, 1], x[:, 2])
        over = tangent > room
        x[over, 1:] *= (room[over] / tangent[over])[:, None]
        for _ in range(3):
            rest = self._rest(x).ravel()
            if np.abs(rest).max() <= BALANCED * 1e-3:
                break
            weight = np.repeat(np.maximum(x[:, 0], 0.0), 3)
            scaled = self.matrix @ sparse.diags(weight)
            normal = (scaled @ self.matrix.T + 1e-13 * sparse.eye(self.matrix.shape[0])).tocsc()
            step = -(scaled.T @ spsolve(normal, rest))
            if not np.isfinite(step).all():
                break
            x = x + step.reshape(-1, 3)
        return x

    def _least_motion(self, motion: Floats) -> Floats | None:
        """The motion, without that of bodies that move little, as long as it is a proof; None: it
        is none."""
        speed = np.abs(motion).max(axis=1, keepdims=True)
        for share in RESTS:
            least = np.where(speed > share * speed.max(), motion, 0.0)
            if self._proves(least):
                return least
        return None

    def _proves(self, motion: Floats) -> bool:
        """Whether no forces below LEAST_FACTOR weights prevent the motion."""
        power = float((motion * self.load).sum())
        if power <= 0:
            return False
        relative = (self.matrix.T @ motion.ravel()).reshape(-1, 3)
        slack = relative[:, 0] - self.friction * np.hypot(relative[:, 1], relative[:, 2])
        worst = max(-float(slack.min(initial=0.0)), 0.0)
        return worst * LEAST_FACTOR * len(motion) <= power


def _balance(island: Island, frame: Floats) -> Any:
    """The sparse matrix from forces, in units of the largest weight, to force and torque on each
    body."""
    from scipy import sparse

    unit = island.weights.max()
    rows, columns, values = [], [], []
    for bodies, sign in ((island.first, 1.0), (island.second, -1.0)):
        own = np.flatnonzero(bodies >= 0)
        body = bodies[own]
        force = sign * frame[own] * (unit / island.weights[body])[:, None, None]
        arm = (island.at[own] - island.centres[body]) / island.sizes[body][:, None]
        torque = np.cross(arm[:, :, None], force, axis=1)
        block = np.concatenate([force, torque], axis=1)  # (m, 6, 3)
        rows.append(np.broadcast_to((6 * body)[:, None, None] + np.arange(6)[:, None], block.shape))
        columns.append(np.broadcast_to((3 * own)[:, None, None] + np.arange(3), block.shape))
        values.append(block)
    shape = (6 * len(island.weights), 3 * len(island.at))
    flat = [np.concatenate([part.ravel() for part in parts]) for parts in (values, rows, columns)]
    return sparse.csc_matrix((flat[0], (flat[1], flat[2])), shape=shape)


def friction_cones(friction: Floats, columns: int) -> Block:
    """(mu x_n, x_t, x_t) of each contact in a second-order cone, of `columns` variables in all."""
    from clarabel import SecondOrderConeT
    from scipy import sparse

    scale = np.ones((len(friction), 3))
    scale[:, 0] = friction
    rows = sparse.diags(-scale.ravel(), shape=(scale.size, columns))
    return rows, np.zeros(scale.size), [SecondOrderConeT(3)] * len(friction)


def minimum(
    linear: Floats, *blocks: Block, quadratic: Any = None, accepted: tuple[str, ...] = SOLVED
) -> Any:
    """The solution of: minimise x'Px / 2 + q'x, where each block holds; None: not solved."""
    import clarabel
    from scipy import sparse

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = PRECISION
    rows, limits, cones = zip(*blocks, strict=True)
    solution = clarabel.DefaultSolver(
        sparse.csc_matrix((linear.size, linear.size) if quadratic is None else quadratic),
        linear,
        sparse.vstack(rows, format="csc"),
        np.concatenate(limits),
        list(chain.from_iterable(cones)),
        settings,
    ).solve()
    return solution if str(solution.status) in accepted else None
