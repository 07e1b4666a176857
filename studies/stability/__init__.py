"""satcheck.studies.stability: variants of a pair that must not change the answer.

Each family of variants comes with what it may change: nothing, the last digits, or as much as its
rounding moves the surfaces. Every variant goes through `satcheck.audit.check`, like any question.
"""

from __future__ import annotations

from satcheck.studies.stability.answer import Answer
from satcheck.studies.stability.comparison import Judgement
from satcheck.studies.stability.probe import probe
from satcheck.studies.stability.result import FamilyResult, Sample, Stability
from satcheck.studies.stability.variant import FAMILIES, Family

__all__ = [
    "FAMILIES",
    "Answer",
    "Family",
    "FamilyResult",
    "Judgement",
    "Sample",
    "Stability",
    "probe",
]
