"""Bodies that fit, by the planes of their faces and by making them smaller."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from satcheck.core import Mesh, Surface, fit_by_faces, free_when_shrunk, search_thickness
from tests.core.voxel_solids import VoxelSolid
from tests.core.voxel_solids import box as voxel_box
from tests.fits.files import Placing, placing
from tests.fits.solids import KINDS, Face, Solid, pierced, prism, rectangle, regular, solid_of

WORK = 100_000_000
HERE = Placing((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
TURNED = Placing((0.3, -1.1, 2.0), (3.0, -7.0, 11.0))


def surface(solid: Solid | list[Face], by: Placing = HERE, off: float = 0.0) -> Surface:
    """off: added to each coordinate, at most."""
    rng = Random(0)
    made = solid if isinstance(solid, Solid) else solid_of(solid, rng)
    points = [[c + rng.uniform(-off, off) for c in by.of(p)] for p in made.vertices]
    return Surface(Mesh(np.array(points), np.array(made.triangles, np.uint32)), True)


def block(low: tuple[float, float, float], high: tuple[float, float, float]) -> list[Face]:
    (x, y, z), (u, v, w) = low, high
    return prism([(x, y), (u, y), (u, v), (x, v)], z, w)


@pytest.mark.parametrize("units", [1, 2, 3, 8])
@pytest.mark.parametrize("side", [1.0, 1024.0])
def test_an_overlap_of_a_few_units_in_the_last_place(units: int, side: float) -> None:
    """Where distances in float64 are off by many of them."""
    thick = units * 2.0**-52 * side
    a = surface(block((0.0, 0.0, 0.0), (side, side, side)))
    b = surface(block((side * (1 - units * 2.0**-52), 0.25, 0.25), (2 * side, side / 2, side / 2)))
    for one, other in ((a, b), (b, a)):
        assert fit_by_faces(one, other, thick * 1.001, WORK)[0] == "fit"
        assert fit_by_faces(one, other, thick * 0.999, WORK)[0] != "fit"
    assert fit_by_faces(a, b, thick / 4, WORK)[0] == "deeper"


@pytest.mark.parametrize("seed", range(25))
def test_no_answer_contradicts_the_search(seed: int) -> None:
    rng = Random(f"face fit {seed}")
    make, state, off = rng.choice(KINDS), rng.getrandbits(64), 10 ** rng.uniform(-6, -2)
    fit = make(Random(state), 0.0)
    inner = make(Random(state), rng.choice([0.0, 2 * off])).inner
    by = placing(rng, 2.0)
    a, b = surface(fit.outer, by, off), surface(inner, by, off)
    found = search_thickness(a, b, width=0.05, work=20_000_000)
    for length in (0.5 * found.lower, 0.95 * found.lower, 1.05 * found.upper, 4 * found.upper):
        if not length > 0:
            continue
        answer = fit_by_faces(a, b, length, 20_000_000)[0]
        assert answer in (("deeper", None) if length < found.lower else ("thin", "fit", None))
        if free_when_shrunk(a, b, length / 2, length / 2):
            assert length >= found.lower


@pytest.mark.parametrize("by", [HERE, TURNED])
def test_a_sheet_and_a_wire_do_not_fit(by: Placing) -> None:
    """A pin through a thin sheet, a wire through a block: thin, but no fit."""
    pin = prism(regular(0.5, 8, 0.1), -1.0, 1.0)
    for one, other in (
        (prism(rectangle(3.0, 3.0), 0.0, 1e-4), pin),
        (block((-1.0, -1.0, -0.5), (1.0, 1.0, 0.5)), prism(rectangle(1e-4, 1e-4), -1.0, 1.0)),
    ):
        assert fit_by_faces(surface(one, by), surface(other, by), 2e-4, WORK)[0] in ("thin", None)
        assert not free_when_shrunk(surface(one, by), surface(other, by), 1e-4, 1e-4)


@pytest.mark.parametrize("by", [HERE, TURNED])
def test_facets_that_interlock_are_free_of_each_other_when_shrunk(by: Placing) -> None:
    """A bolt in its hole, turned by half a facet: one reaches 1 - cos(pi / 24) into the other."""
    reach = 1 - np.cos(np.pi / 24)
    hole = pierced(rectangle(4.0, 4.0), regular(1.0, 24, 0.0), 0.0, 1.0)
    bolt = prism(regular(1.0, 24, np.pi / 24), -0.5, 1.5)
    a, b = surface(hole, by), surface(bolt, by)
    assert free_when_shrunk(a, b, reach, reach)
    assert free_when_shrunk(b, a, reach, reach)
    assert not free_when_shrunk(a, b, 0.2 * reach, 0.2 * reach)
    assert search_thickness(a, b, width=0.01, work=WORK).lower > 0.4 * reach


def test_a_deep_overlap_is_not_free_when_shrunk() -> None:
    a, b = (voxel_box((k,) * 3, (k + 4,) * 3) for k in (0, 3))
    assert isinstance(a, VoxelSolid)
    one, other = Surface(a.mesh(), True), Surface(b.mesh(), True)
    assert not free_when_shrunk(one, other, 0.49, 0.49)
    assert free_when_shrunk(one, other, 0.9, 0.9)


def test_what_is_no_solid_is_refused() -> None:
    sheet = Surface(Mesh(np.eye(3), np.array([[0, 1, 2]], np.uint32)), False)
    solid = surface(block((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)))
    with pytest.raises(ValueError, match="two solids"):
        fit_by_faces(sheet, solid, 1.0, WORK)
    with pytest.raises(ValueError, match="two solids"):
        free_when_shrunk(sheet, solid, 1.0, 1.0)
    with pytest.raises(ValueError, match="positive"):
        fit_by_faces(solid, solid, 0.0, WORK)
