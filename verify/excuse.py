"""Whether surfaces that may be off by a little explain the overlap of two solids.

The surface of each body may be off by half of the touch band, or by its surface tolerance where
that is more. An overlap is explained where no point lies deeper than that in both. Nothing is
explained where one body passes through the other. A surface tolerance also explains nothing where a
body is no thicker than that, and where the surface of one body reaches deep into the other.
"""

from __future__ import annotations

from fractions import Fraction

from satcheck.report.certificate import Excuse
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import EXACT_WIDTH
from satcheck.verify.pairs import Pair
from satcheck.verify.passing import neither_passes
from satcheck.verify.reach import reaches_no_deeper
from satcheck.verify.surfaces import meeting
from satcheck.verify.thickness import at_most, holds_ball

# No surface may reach deeper into the other body than this, times what both may be off.
MOST_REACH = 4


def is_explained(
    excuse: Excuse, pair: Pair, bodies: tuple[Placed, Placed], tolerance: Fraction
) -> None:
    """Rejects an excuse that does not explain the overlap. tolerance: of the touch band."""
    off_a, off_b = (max(tolerance / 2, Fraction(body.surface_tolerance)) for body in bodies)
    excuses = max(off_a, off_b) > tolerance / 2
    for ball, off, body in ((excuse.a, off_a, pair.a), (excuse.b, off_b, pair.b)):
        radius = Fraction(ball.radius)
        if excuses and radius <= off:
            raise Rejected("a body is not shown to be thicker than its surface may be off")
        holds_ball(body, ball.centre, radius)
    at_most(excuse.cells, pair.a, pair.b, EXACT_WIDTH * max(off_a, off_b) / 2, (off_a, off_b))
    contacts = meeting(pair.a, pair.b)
    neither_passes(pair, contacts)
    if not excuses:
        return
    most = MOST_REACH * (off_a + off_b) * (1 + EXACT_WIDTH)
    reaches_no_deeper(pair.a, pair.b, contacts, most)
    reaches_no_deeper(pair.b, pair.a, [(t, s) for s, t in contacts], most)
