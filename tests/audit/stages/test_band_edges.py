"""Both ends of the touch band: pairs whose gap or depth is known exactly, tolerances at it."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from fractions import Fraction

import pytest

from satcheck.audit import Settings, check
from tests.audit.shapes import Mesh, box, bracket, scene_of

# Integer matrices with orthogonal columns of one length: a turn, and how much it lengthens.
TURNS = {
    "unturned": (((1, 0, 0), (0, 1, 0), (0, 0, 1)), 1),
    "turned about z": (((3, -4, 0), (4, 3, 0), (0, 0, 5)), 5),
    "turned": (((2, -2, 1), (1, 2, 2), (-2, -1, 2)), 3),
}
BLOCK = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
# Each gives two bodies a multiple of g apart (> 0), or that deep in each other (< 0).
PAIRS = {
    "faces": lambda g: (BLOCK, box((1 + g, -0.5, -2), (3, 0.25, 0)), 1),
    "edges": lambda g: (BLOCK, box((1 + 3 * g, 1 + 4 * g, -2), (3, 3, 0)), 5),
    "corners": lambda g: (BLOCK, box((1 + 2 * g, 1 + 3 * g, 1 + 6 * g), (3, 3, 4)), 7),
    "faces that overlap": lambda g: (BLOCK, box((1 - g, -0.5, -2), (3, 0.25, 0)), -1),
    "edges that overlap": lambda g: (BLOCK, box((1 - g, 1 - 2 * g, -2), (3, 3, 0)), -1),
    "notch": lambda g: (bracket(), box((2 + g, 2 + 2 * g, 1), (3, 3, 2)), 1),
    "edge of an arm": lambda g: (bracket(), box((6 + 3 * g, 2 + 4 * g, 1), (9, 9, 2)), 5),
    "arm that overlaps": lambda g: (bracket(), box((2 - g, 3, 1), (3, 4, 2)), -1),
    "end that overlaps": lambda g: (bracket(), box((6 - g, 0.5, 1), (9, 1, 2)), -1),
}


def placed(mesh: Mesh, turn: str, exponent: int, offset: int) -> Mesh | None:
    """Turned, scaled by a power of two and moved; None where a coordinate would be rounded."""
    rows, points = TURNS[turn][0], []
    for point in mesh[0]:
        exact = [
            sum(Fraction(m) * Fraction(c) for m, c in zip(row, point, strict=True)) + offset
            for row in rows
        ]
        exact = [c * Fraction(2) ** exponent for c in exact]
        rounded = [float(c) for c in exact]
        if exact != [Fraction(c) for c in rounded]:
            return None
        points.append(tuple(rounded))
    return points, mesh[1]  # type: ignore[return-value]


def cases(kind: str, seed: int, count: int) -> Iterator[tuple[Mesh, Mesh, float, bool]]:
    """Pairs with their signed distance, and whether they are turned."""
    draw = random.Random(f"{kind} {seed}")
    while count:
        g = draw.randint(1, 1 << 10) * 2.0 ** -draw.choice((13, 20, 30))
        a, b, times = PAIRS[kind](g)
        turn, exponent = draw.choice(list(TURNS)), draw.choice((0, 0, -130, -40, 60, 120))
        offset = draw.choice((0, 0, 1 << 10, 1 << 18))
        one, other = placed(a, turn, exponent, offset), placed(b, turn, exponent, offset)
        if one is None or other is None:
            continue
        if draw.random() < 0.5:
            one, other = other, one
        yield one, other, math.ldexp(g * times * TURNS[turn][1], exponent), turn != "unturned"
        count -= 1


@pytest.mark.parametrize("kind", PAIRS)
@pytest.mark.parametrize("depth", [True, False], ids=["depth", "no depth"])
def test_the_band_ends_at_the_tolerance(tmp_path, kind, depth):
    """Never a wrong word. Where every way out of a concave body rounds, that may be no word, and so
    may a tolerance that is less than an overlap by less than coordinates of points resolve."""
    drawn = list(cases(kind, seed=0, count=4))
    if kind.startswith(("arm", "end")):  # they take seconds: each is checked in one way
        drawn = drawn[:2] if depth else drawn[2:]
    for a, b, distance, is_turned in drawn:
        scene, length = scene_of(tmp_path, a=a, b=b), abs(distance)
        beyond = "separated" if distance > 0 else "penetrating"
        may_hide = is_turned and distance < 0 and kind.startswith(("arm", "end"))
        for tolerance, relation in (
            (length, "touching"),
            (math.nextafter(length, math.inf), "touching"),
            (math.nextafter(length, 0.0), beyond),
            (length * (1 - 5e-10), beyond),
            (0.0, beyond),
        ):
            (found,) = check(scene, Settings(tolerance=tolerance, depth=depth)).findings
            if distance < 0 and length * (1 - 1e-9) < tolerance < length:
                assert found.relation in ("penetrating", "indeterminate")
                continue
            if may_hide and found.relation == "indeterminate":
                assert "rounding" in found.reason
                continue
            assert found.relation == relation, (length, tolerance, a[0], b[0])
            assert found.exact_relation == beyond


@pytest.mark.parametrize("kind", [kind for kind in PAIRS if "overlap" not in kind])
def test_a_clearance_is_kept_from_its_own_length_on(tmp_path, kind):
    for a, b, distance, _ in cases(kind, seed=1, count=3):
        scene = scene_of(tmp_path, a=a, b=b)
        for clearance, relation in (
            (distance, "separated"),
            (math.nextafter(distance, 0.0), "separated"),
            (math.nextafter(distance, math.inf), "near"),
        ):
            settings = Settings(tolerance=0.0, clearance=clearance)
            (found,) = check(scene, settings).findings
            assert found.relation == relation, (distance, clearance, a[0], b[0])
            assert found.quality == "exact"
