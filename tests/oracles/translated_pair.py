"""When a translated convex point set overlaps another one, exactly: an open interval of t.

A + t v and B have a common interior when they overlap along every facet normal of A - B; each
normal bounds t from one side. No hull, no tolerance: see `exact_pair` for the axes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from tests.oracles.exact_pair import candidate_axes, dot, exact


def overlap_times(
    a: Iterable[Sequence[float]], b: Iterable[Sequence[float]], v: Sequence[float]
) -> tuple[Fraction, Fraction] | None:
    """All t, also outside [0, 1], at which A + t v and B have a common interior; None: no t.

    The point sets have interiors, and v is not zero.
    """
    points_a, points_b = exact(a), exact(b)
    (step,) = exact([v])
    enter, leave = None, None
    for n in candidate_axes(points_a, points_b):
        # room > t * speed is needed: A must not have left B behind along n.
        room = max(dot(n, p) for p in points_b) - min(dot(n, p) for p in points_a)
        speed = dot(n, step)
        if speed == 0:
            if room <= 0:
                return None
            continue
        t = Fraction(room) / Fraction(speed)
        if speed > 0:
            leave = t if leave is None else min(leave, t)
        else:
            enter = t if enter is None else max(enter, t)
    if enter is None or leave is None or enter >= leave:
        return None
    return enter, leave
