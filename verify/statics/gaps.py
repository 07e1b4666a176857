"""That two bodies are farther apart than a tolerance, so that they do not touch."""

from __future__ import annotations

from fractions import Fraction

from satcheck.verify.bodies import Placed
from satcheck.verify.exact import Rejected, dot, point
from satcheck.verify.patches import comes_within
from satcheck.verify.statics.weights import ball
from satcheck.verify.surfaces import close_pairs
from satcheck.verify.world import Exact, World

# With more pairs of near triangles there is no proof.
MOST_NEAR = 2_000_000


def check_apart(a: Placed, b: Placed, tolerance: float) -> None:
    """Rejects bodies that are not farther apart than the tolerance. If one is a ball, the tolerance
    may be negative: then the bodies may overlap by less than that."""
    if _boxes_apart(a, b, tolerance):
        return
    if a.world is not None and b.world is not None:
        _meshes_apart(a.world, b.world, tolerance)
    elif a.world is not None:
        _ball_apart(b, a.world, tolerance)
    elif b.world is not None:
        _ball_apart(a, b.world, tolerance)
    else:
        _balls_apart(a, b, tolerance)


def _boxes_apart(a: Placed, b: Placed, tolerance: float) -> bool:
    if a.bounds is None or b.bounds is None:
        raise Rejected("a body that cannot be read may hold others")
    (low_a, high_a), (low_b, high_b) = a.bounds, b.bounds
    gap = max(
        Fraction(float(low)) - Fraction(float(high))
        for low, high in (*zip(low_a, high_b, strict=True), *zip(low_b, high_a, strict=True))
    )
    return gap > Fraction(tolerance)


def _meshes_apart(a: World, b: World, tolerance: float) -> None:
    k = max(a.lattice, b.lattice)
    one, other = Exact(a, k), Exact(b, k)
    within = (Fraction(tolerance) * (1 << k)) ** 2
    for _, _, squared in close_pairs(one, other, Fraction(tolerance), MOST_NEAR):
        if squared <= within:
            raise Rejected("bodies that should be apart are within the tolerance")
    for inner, outer in ((one, other), (other, one)):
        if not outer.world.solid:
            continue
        for v in inner.world.components:
            if outer.winding(point(inner.points[v])) != 0:
                raise Rejected("a body that should be apart lies in another")


def _ball_apart(round_: Placed, world: World, tolerance: float) -> None:
    centre, radius = ball(round_)
    mesh = Exact(world, world.lattice)
    middle = point(Fraction(c) * (1 << mesh.k) for c in centre)
    reach = max(Fraction(radius) + Fraction(tolerance), Fraction(0))
    if comes_within(mesh, middle, reach, open_=False):
        raise Rejected("bodies that should be apart are within the tolerance")
    if world.solid and mesh.winding(middle) != 0:
        raise Rejected("a body that should be apart lies in another")


def _balls_apart(a: Placed, b: Placed, tolerance: float) -> None:
    (p, r), (q, s) = ball(a), ball(b)
    step = [Fraction(x) - Fraction(y) for x, y in zip(p, q, strict=True)]
    reach = max(Fraction(r) + Fraction(s) + Fraction(tolerance), Fraction(0))
    if dot(step, step) <= reach * reach:
        raise Rejected("bodies that should be apart are within the tolerance")
