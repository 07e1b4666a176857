"""How well an island stands: how far gravity may tilt, how little friction it needs, and whether it
stands without being squeezed."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.statics.equilibrium import (
    SOLVED,
    Island,
    Programme,
    cone,
    find_forces,
    friction_rows,
    minimum,
    positive,
    tangents,
    zeros,
)
from satcheck.audit.statics.near import Floats
from satcheck.report.statics import BALANCED_DEGREES

# The most contact points of all islands together whose tilt and friction are looked for, by some
# twenty programmes each, and the most of one island whose first step is.
MOST_POINTS = 200
MOST_OF_STEP = 2000
DIRECTIONS = 8
# The largest tilt that is looked for, as a tangent: 89.4 degrees.
MOST_TILT = 100.0
HALVINGS = 12
# The fixed point of the first step: at most so many rounds, and an acceleration, as a share of
# gravity, below which a body rests.
ROUNDS = 25
AT_REST = 1e-2
# Square of the radius of gyration of a box over that of its diagonal.
GYRATION = 1.0 / 12.0


class Margins(Struct, frozen=True):
    """tilt: degrees, a lower and an upper end of the smallest tilt of gravity that the island does
    not stand. least_friction: a friction of all contacts that suffices; None: they
    differ. squeezed: whether it falls unless something presses it; None: not decided."""

    tilt: tuple[float, float] | None
    least_friction: float | None
    squeezed: bool | None

    @property
    def balanced(self) -> bool:
        return self.tilt is not None and self.tilt[1] <= BALANCED_DEGREES


def margins_of(islands: Sequence[Island | None]) -> list[Margins | None]:
    """Of islands that stand; None: it does not, or has too many contacts. The first islands use up
    the points for tilts."""
    margins: list[Margins | None] = []
    left = MOST_POINTS
    for island in islands:
        points = MOST_OF_STEP + 1 if island is None else len(island.at)
        if island is None or points > MOST_OF_STEP:
            margins.append(None)
            continue
        full = points <= left
        left -= points if full else 0
        margins.append(
            Margins(
                _tilt(island) if full else None,
                _least_friction(island) if full else None,
                _is_squeezed(island),
            )
        )
    return margins


def _tilt(island: Island) -> tuple[float, float] | None:
    """The tilts that an island stands are a convex set, as forces add up. It holds the polygon of
    the tilts in some directions."""
    u, v = (axis[0] for axis in tangents(island.down[None]))
    reach, corners = [], []
    for k in range(DIRECTIONS):
        angle = 2 * math.pi * k / DIRECTIONS
        most = _most_tilt(island, math.cos(angle) * u + math.sin(angle) * v)
        if most is None:
            return None
        reach.append(most)
        corners.append((most * math.cos(angle), most * math.sin(angle)))
    inner = min(
        _distance_to_line(p, q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)
    )
    low, high = (math.degrees(math.atan(t)) for t in (inner, min(reach)))
    return min(low, high), high


def _distance_to_line(p: tuple[float, float], q: tuple[float, float]) -> float:
    """From the origin to the line through two points around it."""
    length = math.hypot(q[0] - p[0], q[1] - p[1])
    return abs(p[0] * q[1] - p[1] * q[0]) / length if length else math.hypot(*p)


def _most_tilt(island: Island, aside: Floats) -> float | None:
    """The largest s for which forces balance gravity along down + s aside; None: not known."""
    from scipy import sparse

    programme = Programme(island, 1.0)
    rows, columns = programme.matrix.shape
    push = np.zeros((len(island.weights), 6))
    push[:, :3] = aside
    balance = sparse.hstack([programme.matrix, sparse.csc_matrix(push.reshape(-1, 1))])
    own = friction_rows(programme.friction, columns + 1)
    limit = sparse.csc_matrix(([1.0], ([0], [columns])), shape=(1, columns + 1))
    q = np.zeros(columns + 1)
    q[-1] = -1.0
    solution = minimum(
        sparse.csc_matrix((columns + 1, columns + 1)),
        q,
        sparse.vstack([balance, limit, own]),
        np.concatenate([-programme.load.ravel(), [MOST_TILT], np.zeros(columns)]),
        [zeros(rows), positive(1)] + [cone(3)] * (columns // 3),
    )
    if str(solution.status) not in SOLVED:
        return None
    return max(float(solution.x[-1]), 0.0)


def _least_friction(island: Island) -> float | None:
    """By bisection; forces exist at the friction that is returned."""
    if not len(island.friction) or np.ptp(island.friction) > 0:
        return None
    low, high = 0.0, float(island.friction[0])
    if _stands_with(island, 0.0):
        return 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if _stands_with(island, middle):
            high = middle
        else:
            low = middle
    return high


def _stands_with(island: Island, friction: float) -> bool:
    return bool(find_forces(replace(island, friction=np.full(len(island.at), friction))).holds)


def _is_squeezed(island: Island) -> bool | None:
    """Whether the bodies start to move when they are let go without any force between them.

    Forces and accelerations by Coulomb's law, in the form of G. De Saxce and Z.-Q. Feng (1998), as
    a fixed point of convex programmes: V. Acary et al., "A formulation of the linear discrete
    Coulomb friction problem via convex optimization" (2011). The first guess are the accelerations
    of a free fall, so that nothing presses unless it has to.
    """
    from scipy import sparse

    programme = Programme(island, 1.0)
    rows, columns = programme.matrix.shape
    gyration = np.tile([1.0, 1.0, 1.0, *[1 / math.sqrt(GYRATION)] * 3], len(island.weights))
    mass = np.repeat(np.sqrt(island.weights / programme.unit), 6)
    metric = sparse.diags(gyration * mass) @ programme.matrix  # forces -> sqrt(M) acceleration
    load = gyration * mass * programme.load.ravel()
    own = friction_rows(programme.friction, columns + rows)
    tie = sparse.hstack([metric, -sparse.eye(rows)])
    quadratic = sparse.block_diag([sparse.csc_matrix((columns, columns)), sparse.eye(rows)])
    limits = np.concatenate([-load, np.zeros(columns)])
    cones = [zeros(rows)] + [cone(3)] * (columns // 3)
    moved = load
    last = math.inf
    for _ in range(ROUNDS):
        sliding = (metric.T @ moved).reshape(-1, 3)
        q = np.zeros(columns + rows)
        q[0:columns:3] = programme.friction * np.hypot(sliding[:, 1], sliding[:, 2])
        solution = minimum(quadratic, q, sparse.vstack([tie, own]), limits, cones)
        if str(solution.status) not in SOLVED:
            return None
        moved = np.array(solution.x[columns:])
        fastest = float(np.abs(moved / mass).max())
        if fastest < AT_REST:
            return False
        if abs(fastest - last) < 1e-6 * fastest:
            return True
        last = fastest
    return None
