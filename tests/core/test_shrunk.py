"""Bodies that fit: free of each other when made smaller, or thicker than a length together."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from satcheck.core import Mesh, Surface, free_when_shrunk, search_thickness
from tests.core.voxel_solids import VoxelSolid
from tests.core.voxel_solids import box as voxel_box
from tests.fits.files import Placing, placed, placing
from tests.fits.solids import KINDS, Face, Solid, pierced, prism, rectangle, regular, solid_of

WORK = 10_000_000
HERE = Placing((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
TURNED = Placing((0.3, -1.1, 2.0), (3.0, -7.0, 11.0))


def surface(solid: Solid | list[Face], by: Placing = HERE, off: float = 0.0) -> Surface:
    """off: added to each coordinate, at most."""
    rng = Random(0)
    made = solid if isinstance(solid, Solid) else solid_of(solid, rng)
    points = [[c + rng.uniform(-off, off) for c in by.of(p)] for p in made.vertices]
    return Surface(Mesh(np.array(points), np.array(made.triangles, np.uint32)), True)


def decided(a: Surface, b: Surface, length: float) -> bool | None:
    """Return whether a ball thicker than the length lies in both; None: the search is undecided."""
    found = search_thickness(a, b, width=0.0, work=WORK, limit=length)
    return True if found.lower > length else False if found.upper <= length else None


def block(low: tuple[float, float, float], high: tuple[float, float, float]) -> list[Face]:
    (x, y, z), (u, v, w) = low, high
    return prism([(x, y), (u, y), (u, v), (x, v)], z, w)


@pytest.mark.parametrize("units", [1, 2, 3, 8])
@pytest.mark.parametrize("side", [1.0, 1024.0])
def test_an_overlap_of_a_few_units_in_the_last_place_is_deeper(units: int, side: float) -> None:
    """Where distances in float64 are off by many of them."""
    thick = units * 2.0**-52 * side
    a = surface(block((0.0, 0.0, 0.0), (side, side, side)))
    b = surface(block((side * (1 - units * 2.0**-52), 0.25, 0.25), (2 * side, side / 2, side / 2)))
    for one, other in ((a, b), (b, a)):
        assert decided(one, other, 0.999 * thick) is True
        assert decided(one, other, 1.001 * thick) is not True


@pytest.mark.parametrize("seed", range(40))
def test_fits_and_interferences_as_exact_as_float64(seed: int) -> None:
    """Coordinates are off by a roundoff, the surfaces by 16: far below what distances round."""
    rng = Random(f"exact {seed}")
    make, state, by = rng.choice(KINDS), rng.getrandbits(64), placing(rng, 2.0)
    outer = surface(make(Random(state), 0.0).outer, by)
    off = 16 * 2.0**-53 * float(np.abs(outer.mesh.vertices).max())
    assert free_when_shrunk(outer, surface(make(Random(state), 0.0).inner, by), off, off)
    larger = surface(make(Random(state), 8 * off).inner, by)
    assert not free_when_shrunk(outer, larger, off, off)
    assert decided(outer, larger, 2 * off) is True


@pytest.mark.parametrize("seed", range(40))
def test_fits_of_rounded_coordinates(seed: int) -> None:
    """No vertex has to move farther than half of the diagonal of a cell of the grid: back."""
    rng = Random(f"rounded {seed}")
    make, state, by = rng.choice(KINDS), rng.getrandbits(64), placing(rng, 2.0)
    fit = make(Random(state), 0.0)
    one, other = (placed(solid_of(faces, rng), by) for faces in (fit.outer, fit.inner))
    a, b = (
        Surface(Mesh(np.round(solid.vertices, 9), np.array(solid.triangles, np.uint32)), True)
        for solid in (one, other)
    )
    off = 0.5e-9 * np.sqrt(3)
    assert free_when_shrunk(a, b, off, off)
    assert free_when_shrunk(b, a, off, off)


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
        assert decided(a, b, length) in (length < found.lower, None)
        if free_when_shrunk(a, b, length / 2, length / 2):
            assert length >= found.lower


@pytest.mark.parametrize("by", [HERE, TURNED])
def test_a_sheet_and_a_wire_are_not_free_when_shrunk(by: Placing) -> None:
    """A pin through a thin sheet, a wire through a block: thin, but no fit."""
    pin = prism(regular(0.5, 8, 0.1), -1.0, 1.0)
    for one, other in (
        (prism(rectangle(3.0, 3.0), 0.0, 1e-4), pin),
        (block((-1.0, -1.0, -0.5), (1.0, 1.0, 0.5)), prism(rectangle(1e-4, 1e-4), -1.0, 1.0)),
    ):
        assert decided(surface(one, by), surface(other, by), 2e-4) is False
        for off in (1e-4, 2e-4):
            assert not free_when_shrunk(surface(one, by), surface(other, by), off, off)


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
        free_when_shrunk(sheet, solid, 1.0, 1.0)
