"""satcheck.audit.tradeoff: what accuracy costs in time, rung by rung."""

from __future__ import annotations

from satcheck.audit.tradeoff.runs import RUNGS, Rung
from satcheck.audit.tradeoff.study import tradeoff

__all__ = ["RUNGS", "Rung", "tradeoff"]
