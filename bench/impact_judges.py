"""Judges times of impact by the rational truth, for `bench.motions` and `bench.impacts`."""

from __future__ import annotations

import math

from bench.impact_pairs import ImpactPair
from bench.swept_truth import Meeting
from satcheck.report.sweep import Sweep

Answer = float | None  # the time of impact; None: free
# A time that is wrong by more than this share of the motion is off.
OFF = 1e-3
# How far the overlap of a proven interval may lie before the end of the band, as a share of t.
BAND = 1e-6


def judge(pair: ImpactPair, truth: Meeting, found: Sweep) -> str:
    """The kind of a wrong answer of satcheck; "" if it is right."""
    if found.relation == "indeterminate":
        return "undecided"
    if found.relation == "penetrating":
        if truth.overlap is None:
            return "false"
        lower, upper = found.time_of_impact or (math.nan, math.nan)
        is_right = lower - BAND <= truth.overlap <= upper <= truth.overlap + OFF
        return "" if is_right or pair.slight else "off"
    if found.relation == "touching":
        is_right = pair.slight or (truth.overlap is None and truth.touch is not None)
        return "" if is_right else "missed" if truth.overlap is not None else "false"
    return "" if truth.touch is None else "missed"


def judge_time(pair: ImpactPair, truth: Meeting, answer: Answer) -> str:
    """The same for FCL, which has no touches."""
    if pair.slight or (truth.overlap is None and truth.touch is not None):
        return ""
    if truth.overlap is None:
        return "" if answer is None else "false"
    if answer is None:
        return "missed"
    return "off" if abs(answer - truth.overlap) > OFF else ""
