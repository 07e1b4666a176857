"""Every pair once, near ones after each other, and nothing kept for bodies that are done."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from satcheck.audit.pair_queue import PARALLEL_PAIRS, SLICE, InTurn


@dataclass(eq=False)
class FakeBody:
    bounds: tuple
    gone: list = field(default_factory=list)

    def let_go(self):
        self.gone.append(True)


@dataclass(eq=False)
class FakePair:
    a: FakeBody
    b: FakeBody


def chain(count):
    """Each body with the next one, in a shuffled order."""
    bodies = [FakeBody(((float(k), 0.0, 0.0), (k + 1.5, 1.0, 1.0))) for k in range(count + 1)]
    order = [(7919 * k) % count for k in range(count)]
    return bodies, [FakePair(bodies[k], bodies[k + 1]) for k in order]


@pytest.mark.parametrize("jobs", [1, 3])
@pytest.mark.parametrize("count", [1, PARALLEL_PAIRS + 1, SLICE + 100])
def test_every_pair_has_its_result(jobs, count):
    _, pairs = chain(count)
    found = dict(InTurn(jobs).each(pairs, id))
    assert found == {k: id(pair) for k, pair in enumerate(pairs)}


def test_a_body_is_let_go_after_its_last_pair():
    bodies, pairs = chain(200)
    met = {id(body): 0 for body in bodies}

    def meet(pair):
        for body in (pair.a, pair.b):
            assert not body.gone
            met[id(body)] += 1

    most = 0
    for _ in InTurn(1).each(pairs, meet):
        most = max(most, sum(met[id(body)] > 0 and not body.gone for body in bodies))
    assert all(body.gone == [True] for body in bodies)
    assert most <= 4


def test_what_another_check_needs_is_kept():
    bodies, pairs = chain(20)
    assert len(list(InTurn(1, keep=True).each(pairs, id))) == 20
    assert not any(body.gone for body in bodies)


def test_no_pairs_at_all():
    assert list(InTurn(0).each([], id)) == []
