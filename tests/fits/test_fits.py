"""Flush fits touch, and interference of three tolerances or more is an error."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fits.run import check_fit

SEED = 1
FITS, INTERFERENCES, PARTS = 200, 50, 10


@pytest.mark.parametrize("part", range(PARTS))
def test_fits_touch(tmp_path: Path, part: int) -> None:
    numbers = range(part, FITS, PARTS)
    results = [check_fit(tmp_path, SEED, number, interferes=False) for number in numbers]
    assert [result for result in results if not result.passes] == []


def test_interference_is_found(tmp_path: Path) -> None:
    results = [
        check_fit(tmp_path, SEED, number, interferes=True) for number in range(INTERFERENCES)
    ]
    assert [result for result in results if not result.passes] == []
