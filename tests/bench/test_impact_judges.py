"""The judges of the benchmark of impacts call each kind of wrong answer by its name."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bench.impact_judges import Answer, judge, judge_time
from bench.impact_pairs import ImpactPair
from bench.swept_truth import Meeting
from satcheck.report.sweep import Sweep

EXACT = ImpactPair("by hand", [], (0, 0, 0), [])
SLIGHT = ImpactPair("by hand", [], (0, 0, 0), [], slight=True)
HIT = Meeting(Fraction(1, 4), Fraction(1, 2))
TOUCH = Meeting(Fraction(1, 4), None)
FREE = Meeting(None, None)

APART = Sweep(relation="separated", tolerance=0.0, reached=1.0)
TOUCHES = Sweep(relation="touching", tolerance=0.0, reached=1.0)
OPEN = Sweep(relation="indeterminate", tolerance=0.0, reached=0.5)


def hit(lower: float, upper: float) -> Sweep:
    impact = (lower, upper)
    return Sweep(relation="penetrating", tolerance=0.0, reached=lower, time_of_impact=impact)


@pytest.mark.parametrize(
    ("truth", "answer", "kind"),
    [
        (HIT, hit(0.5, 0.5 + 1e-9), ""),
        (HIT, hit(0.6, 0.7), "off"),
        (HIT, hit(0.3, 0.4), "off"),
        (HIT, TOUCHES, "missed"),
        (HIT, APART, "missed"),
        (HIT, OPEN, "undecided"),
        (TOUCH, TOUCHES, ""),
        (TOUCH, APART, "missed"),
        (TOUCH, hit(0.2, 0.3), "false"),
        (FREE, APART, ""),
        (FREE, TOUCHES, "false"),
        (FREE, hit(0.2, 0.3), "false"),
        (FREE, OPEN, "undecided"),
    ],
)
def test_satcheck_is_judged(truth: Meeting, answer: Sweep, kind: str) -> None:
    assert judge(EXACT, truth, answer) == kind


def test_rounding_may_make_a_touch_of_slight_motions_and_nothing_else() -> None:
    assert judge(SLIGHT, HIT, TOUCHES) == judge(SLIGHT, FREE, TOUCHES) == ""
    assert judge(SLIGHT, HIT, APART) == "missed"
    assert judge(SLIGHT, FREE, hit(0.2, 0.3)) == "false"
    assert judge(SLIGHT, HIT, OPEN) == "undecided"


@pytest.mark.parametrize(
    ("truth", "answer", "kind"),
    [
        (HIT, 0.5, ""),
        (HIT, 0.6, "off"),
        (HIT, None, "missed"),
        (TOUCH, None, ""),
        (TOUCH, 0.25, ""),
        (FREE, None, ""),
        (FREE, 0.3, "false"),
    ],
)
def test_a_library_without_touches_is_judged(truth: Meeting, answer: Answer, kind: str) -> None:
    assert judge_time(EXACT, truth, answer) == kind
