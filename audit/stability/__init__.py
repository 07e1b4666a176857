"""satcheck.audit.stability: the same question, asked in other ways that must not change the answer.

Each family of variants comes with what it may change: nothing, the last digits, or as much as its
rounding moves the surfaces. Every variant goes through `satcheck.audit.check`, like any question.
"""

from __future__ import annotations

from satcheck.audit.stability.answer import Answer
from satcheck.audit.stability.comparison import Judgement
from satcheck.audit.stability.probe import probe
from satcheck.audit.stability.result import FamilyResult, Sample, Stability
from satcheck.audit.stability.variant import FAMILIES, Family

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
