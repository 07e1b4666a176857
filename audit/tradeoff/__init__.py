"""satcheck.audit.tradeoff: what accuracy costs in time.

Each rung of the ladder is asked about the same pair and held against what the exact one proves.
"""

from __future__ import annotations

from satcheck.audit.tradeoff.gauge import Budget
from satcheck.audit.tradeoff.measure import measure_pair
from satcheck.audit.tradeoff.pareto import Times
from satcheck.audit.tradeoff.result import (
    ClimbEnd,
    Figure,
    PairTradeoff,
    Row,
    Tradeoff,
    Truth,
    choices,
)
from satcheck.audit.tradeoff.rungs import RUNGS, Rung, labels_of
from satcheck.audit.tradeoff.tradeoff import tradeoff

__all__ = [
    "RUNGS",
    "Budget",
    "ClimbEnd",
    "Figure",
    "PairTradeoff",
    "Row",
    "Rung",
    "Times",
    "Tradeoff",
    "Truth",
    "choices",
    "labels_of",
    "measure_pair",
    "tradeoff",
]
