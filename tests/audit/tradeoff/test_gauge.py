"""What there is to spend, by a clock that is set."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from satcheck.audit.tradeoff import RUNGS, gauge
from satcheck.audit.tradeoff.gauge import Budget, Gauge


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    made = SimpleNamespace(now=100.0)
    monkeypatch.setattr(gauge, "monotonic", lambda: made.now)
    return made


def test_who_waits_gets_what_the_others_leave(clock: SimpleNamespace) -> None:
    whole = Budget(12.0)
    first = whole.share(2)
    assert (first.left, whole.left) == (6.0, 12.0)
    clock.now += 3.0
    assert (first.left, whole.spent, whole.share(1).left) == (3.0, 3.0, 9.0)
    clock.now += 10.0
    assert whole.share(1).left < 0.0


def test_a_rung_has_no_more_than_its_own_limit(clock: SimpleNamespace) -> None:
    budget, one = Budget(12.0, per_rung=5.0), Gauge(RUNGS[0])
    assert one.left(budget) == 5.0
    one.spent = 4.0
    assert one.left(budget) == 1.0
    clock.now += 11.5
    assert one.left(budget) == 0.5


def test_what_was_stopped_keeps_its_answer_and_asks_no_more() -> None:
    silent, answered = Gauge(RUNGS[0]), Gauge(RUNGS[0], state="answered", reason=None)
    for one in (silent, answered):
        one.stop(2.0)
        assert one.longest == float("inf")
    assert silent.reason == "budget: stopped after 2 s"
    assert not silent.wants_more
    assert answered.reason is None
    assert answered.wants_more
