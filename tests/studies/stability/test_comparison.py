"""What a displacement may change, and what it may not."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.studies.stability.answer import Answer
from satcheck.studies.stability.comparison import compare
from satcheck.studies.stability.variant import Variant, body
from tests.audit.shapes import scene_of, unit_box

APART = Answer("separated", 1.0, convex=True, distance=0.5, hold=0.5, quality="exact")
BARELY = replace(APART, distance=1e-12, hold=1e-12)
TOUCHING = Answer("touching", 1.0, convex=True, distance=0.0, quality="exact")
DEEP = Answer("penetrating", 1.0, convex=True, depth_bounds=(0.5, 0.5), quality="exact")
THICK = replace(DEEP, thickness_bounds=(0.25, 0.5))
GRAZING = replace(DEEP, depth_bounds=(1e-12, 1e-12))
NESTED = Answer("contains", 1.0, convex=True, depth_bounds=(0.5, 0.5), hold=1e-12, quality="exact")
WIDE = Answer("penetrating", 1.0, convex=False, depth_bounds=(0.4, 0.6), quality="bounded")
UNKNOWN = Answer("indeterminate", 1.0, reason="not proven")


def judged(
    folder: Path, asked: Answer, seen: Answer, displacement: float = 0.0, **known: bool
) -> str:
    file = scene_of(folder, a=unit_box()).bodies[0].file
    variant = Variant(
        "noise", "", body("a", file), body("b", file), displacement=displacement, **known
    )
    return compare(asked, seen, variant).judgement


@pytest.mark.parametrize(
    ("asked", "seen", "displacement", "expected"),
    [
        (APART, APART, 0.0, "same"),
        (APART, replace(APART, distance=0.5 + 1e-15), 0.0, "within"),
        (APART, replace(APART, distance=0.5 + 1e-9), 0.0, "beyond"),
        (APART, replace(APART, distance=0.5 + 1e-9), 1e-8, "within"),
        (APART, TOUCHING, 1e-8, "beyond"),
        (BARELY, TOUCHING, 1e-8, "within"),
        (BARELY, TOUCHING, 0.0, "beyond"),
        (TOUCHING, GRAZING, 1e-8, "within"),
        (TOUCHING, DEEP, 1e-8, "beyond"),
        (BARELY, GRAZING, 1e-8, "within"),
        (APART, GRAZING, 1e-8, "beyond"),
        (DEEP, NESTED, 1e-8, "within"),
        (DEEP, replace(NESTED, hold=0.1), 1e-8, "beyond"),
        (DEEP, NESTED, 0.0, "beyond"),
        (WIDE, replace(WIDE, depth_bounds=(0.5, 0.9)), 0.0, "same"),
        (WIDE, replace(WIDE, depth_bounds=(0.7, 0.9)), 0.0, "beyond"),
        (replace(TOUCHING, convex=False), WIDE, 1e-8, "within"),
        (replace(TOUCHING, convex=False), WIDE, 0.0, "beyond"),
        (WIDE, replace(TOUCHING, convex=False), 1e-8, "within"),
        (replace(WIDE, hold=0.1), replace(TOUCHING, convex=False), 1e-8, "beyond"),
        (replace(WIDE, hold=0.1), replace(NESTED, convex=False), 1e-8, "within"),
        (THICK, replace(THICK, thickness_bounds=(0.4, 0.5)), 0.0, "same"),
        (THICK, replace(THICK, thickness_bounds=(0.125, 0.2)), 0.0, "beyond"),
        (THICK, replace(THICK, thickness_bounds=(0.125, 0.25 - 3e-8)), 1e-8, "beyond"),
        (THICK, replace(THICK, thickness_bounds=(0.125, 0.25 - 1.5e-8)), 1e-8, "within"),
        (THICK, DEEP, 0.0, "same"),
        (DEEP, UNKNOWN, 0.0, "undecided"),
        (UNKNOWN, DEEP, 0.0, "undecided"),
    ],
)
def test_judgement(
    asked: Answer, seen: Answer, displacement: float, expected: str, tmp_path: Path
) -> None:
    assert judged(tmp_path, asked, seen, displacement) == expected


@pytest.mark.parametrize(
    "change",
    [{"mtv": (1.0, 0.0, 0.0)}, {"depth_bounds": (0.5, 0.5 + 2**-52)}, {"quality": "bounded"}],
)
def test_identical_is_meant_to_the_bit(change: dict[str, object], tmp_path: Path) -> None:
    assert judged(tmp_path, DEEP, DEEP, identical=True) == "same"
    assert judged(tmp_path, DEEP, replace(DEEP, **change), identical=True) == "beyond"


def test_the_interval_of_the_thickness_may_be_another_one(tmp_path: Path) -> None:
    other, apart = (replace(THICK, thickness_bounds=ends) for ends in ((0.3, 0.6), (0.6, 0.7)))
    assert judged(tmp_path, THICK, other, identical=True) == "same"
    assert judged(tmp_path, THICK, apart, identical=True) == "beyond"
