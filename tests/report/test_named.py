"""What a pair is called, case by case."""

from collections.abc import Collection
from itertools import product
from typing import get_args

import pytest

from satcheck.report.judge import named
from satcheck.report.report import OVERLAPS
from satcheck.report.values import Relation

ANY = (True, False, None)
OPEN = (False, None)
SAME = "as it is exactly"
EXACT = ("separated", "touching", *sorted(OVERLAPS))

# (exactly, whether it is within the tolerance, whether it keeps the clearance): its name
TABLE: dict[tuple[Collection[str], Collection[bool | None], Collection[bool | None]], str] = {
    (EXACT, (True,), ANY): "touching",
    (("separated",), OPEN, (True,)): "separated",
    (("separated",), OPEN, OPEN): "near",
    (("touching", *OVERLAPS), OPEN, ANY): SAME,
}
CASES = [(case, name) for cases, name in TABLE.items() for case in product(*cases)]


@pytest.mark.parametrize(("case", "name"), CASES)
def test_named(case, name: str) -> None:
    exact, within, kept = case
    assert named(exact, within, kept) == (exact if name is SAME else name)


def test_the_table_has_each_case_once() -> None:
    assert len(CASES) == len({case for case, _ in CASES}) == len(EXACT) * 9
    assert {*EXACT} == {*get_args(Relation)} - {"near", "indeterminate"}
