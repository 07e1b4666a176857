"""How well an island stands: how far gravity may tilt, how little friction it needs, and whether it
stands without being squeezed."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from msgspec.structs import replace

from satcheck.audit.statics.equilibrium import (
    Island,
    Programme,
    find_forces,
    friction_cones,
    minimum,
    tangents,
)
from satcheck.audit.statics.islands import Outcome
from satcheck.audit.statics.near import Floats

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


def with_margins(outcomes: Sequence[Outcome]) -> list[Outcome]:
    """The same outcomes with the figures of islands that stand, unless they have too many contacts.
    The first islands use up the points for tilts."""
    measured: list[Outcome] = []
    left = MOST_POINTS
    for outcome in outcomes:
        island = outcome.standing
        if island is None or len(island.at) > MOST_OF_STEP:
            measured.append(outcome)
            continue
        full = len(island.at) <= left
        left -= len(island.at) if full else 0
        stated = replace(
            outcome.stated,
            margin=_tilt(island) if full else None,
            least_friction=_least_friction(island) if full else None,
            squeezed=_is_squeezed(island),
        )
        measured.append(replace(outcome, stated=stated))
    return measured


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
    from clarabel import NonnegativeConeT, ZeroConeT
    from scipy import sparse

    programme = Programme(island, 1.0)
    rows, columns = programme.matrix.shape
    push = np.zeros((len(island.weights), 6))
    push[:, :3] = aside
    balance = sparse.hstack([programme.matrix, sparse.csc_matrix(push.reshape(-1, 1))])
    tilt = np.eye(1, columns + 1, columns)
    solution = minimum(
        -tilt[0],
        (balance, -programme.load.ravel(), [ZeroConeT(rows)]),
        (sparse.csc_matrix(tilt), np.array([MOST_TILT]), [NonnegativeConeT(1)]),
        friction_cones(programme.friction, columns + 1),
    )
    return None if solution is None else max(float(solution.x[-1]), 0.0)


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
    from clarabel import ZeroConeT
    from scipy import sparse

    programme = Programme(island, 1.0)
    rows, columns = programme.matrix.shape
    gyration = np.tile([1.0, 1.0, 1.0, *[1 / math.sqrt(GYRATION)] * 3], len(island.weights))
    mass = np.repeat(np.sqrt(island.weights / programme.unit), 6)
    metric = sparse.diags(gyration * mass) @ programme.matrix  # forces -> sqrt(M) acceleration
    load = gyration * mass * programme.load.ravel()
    tie = sparse.hstack([metric, -sparse.eye(rows)]), -load, [ZeroConeT(rows)]
    own = friction_cones(programme.friction, columns + rows)
    quadratic = sparse.diags(np.repeat([0.0, 1.0], [columns, rows]))
    moved = load
    last = math.inf
    for _ in range(ROUNDS):
        sliding = (metric.T @ moved).reshape(-1, 3)
        q = np.zeros(columns + rows)
        q[0:columns:3] = programme.friction * np.hypot(sliding[:, 1], sliding[:, 2])
        solution = minimum(q, tie, own, quadratic=quadratic)
        if solution is None:
            return None
        moved = np.array(solution.x[columns:])
        fastest = float(np.abs(moved / mass).max())
        if fastest < AT_REST:
            return False
        if abs(fastest - last) < 1e-6 * fastest:
            return True
        last = fastest
    return None
