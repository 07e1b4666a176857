"""Every pair once, near ones after each other, and nothing kept for bodies that are done."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from queue import SimpleQueue
from threading import Event, Thread
from time import sleep

import pytest

from satcheck.audit import checked_pairs
from satcheck.audit.checked_pairs import (
    BATCH_PAIRS,
    BATCH_TRIANGLES,
    PARALLEL_PAIRS,
    examine_pairs,
)
from satcheck.audit.pair import STEPS_OF_SCENE, STEPS_OF_TRIANGLE


@dataclass(eq=False)
class FakeMesh:
    triangles: int = 12


@dataclass(eq=False)
class FakeBody:
    bounds: tuple
    gone: list = field(default_factory=list)
    shared: FakeMesh = field(default_factory=FakeMesh)
    curved: None = None

    def release(self):
        self.gone.append(True)


@dataclass(eq=False)
class FakePair:
    a: FakeBody
    b: FakeBody
    triangles: int = 24
    steps: int = 0


@dataclass(frozen=True)
class FakeChecked:
    result: object
    steps: int = 0
    wants_more: bool = False


def chain(count):
    """Each body with the next one, in a shuffled order."""
    bodies = [FakeBody(((float(k), 0.0, 0.0), (k + 1.5, 1.0, 1.0))) for k in range(count + 1)]
    order = [(7919 * k) % count for k in range(count)]
    return bodies, [FakePair(bodies[k], bodies[k + 1]) for k in order]


@pytest.fixture(autouse=True)
def climbs(monkeypatch):
    """The climb of a pair is the pair itself, and no pair takes long."""
    monkeypatch.setattr(checked_pairs, "start_climbs", lambda pairs, _: lambda: list(pairs))
    monkeypatch.setattr(checked_pairs, "leaves_work", lambda *_: False)


@pytest.fixture
def found(monkeypatch):
    """What an examination makes of each of these pairs."""

    def by(pairs, examine, jobs=1, **options):
        def examined(pair, climb=None):  # a pair that is examined alone climbs then
            result = examine(pair) if climb is None or climb is pair else None
            return result if isinstance(result, FakeChecked) else FakeChecked(result)

        monkeypatch.setattr(checked_pairs, "examine_pair", examined)
        return [checked.result for checked in examine_pairs(pairs, jobs, **options)]

    return by


@pytest.mark.parametrize("every", [None, 1, 3])
@pytest.mark.parametrize("jobs", [1, 3])
@pytest.mark.parametrize("count", [1, PARALLEL_PAIRS + 1, BATCH_PAIRS + 100])
def test_every_pair_has_its_result(jobs, count, every, monkeypatch, found):
    _, pairs = chain(count)
    heavy = {id(pair) for pair in pairs[::every]} if every else set()
    monkeypatch.setattr(checked_pairs, "leaves_work", lambda pair, _: id(pair) in heavy)
    assert found(pairs, id, jobs) == list(map(id, pairs))


@pytest.mark.parametrize("granted", [0, 1])
def test_every_pair_has_its_result_where_no_more_threads_are_granted(granted, monkeypatch, found):
    start, started = Thread.start, []

    def refuse(thread):
        if len(started) == granted:
            raise RuntimeError("can't start new thread")
        started.append(thread)
        start(thread)

    monkeypatch.setattr(Thread, "start", refuse)
    _, pairs = chain(2 * BATCH_PAIRS)
    monkeypatch.setattr(checked_pairs, "leaves_work", lambda *_: True)
    assert found(pairs, lambda pair: sleep(1e-4) or id(pair), 3) == list(map(id, pairs))


@pytest.mark.parametrize("jobs", [1, 3])
def test_batches_are_bounded_in_pairs_and_in_triangles(jobs, monkeypatch, found):
    _, pairs = chain(BATCH_PAIRS + 100)
    for pair in pairs[:40]:
        pair.triangles = BATCH_TRIANGLES
    batches = []

    def start_climbs(batch, threads):
        assert threads == jobs
        batches.append(list(batch))
        return lambda: batch

    monkeypatch.setattr(checked_pairs, "start_climbs", start_climbs)
    assert len(found(pairs, id, jobs)) == len(pairs)
    assert sum(map(len, batches)) == len(pairs)
    assert max(map(len, batches)) <= BATCH_PAIRS
    assert len(batches) > 40 // (jobs + 1)
    for batch in batches:
        assert sum(pair.triangles for pair in batch[:-1]) < jobs * BATCH_TRIANGLES


def test_a_body_is_let_go_after_its_last_pair(found):
    bodies, pairs = chain(200)
    met = {id(body): 0 for body in bodies}

    def meet(pair):
        for body in (pair.a, pair.b):
            assert not body.gone
            met[id(body)] += 1

    held = []
    found(
        pairs,
        meet,
        progress=lambda *_: held.append(sum(met[id(b)] > 0 and not b.gone for b in bodies)),
    )
    assert all(body.gone == [True] for body in bodies)
    assert max(held) <= 4


def test_what_another_check_needs_is_kept(found):
    bodies, pairs = chain(20)
    assert len(found(pairs, id, keep=True)) == 20
    assert not any(body.gone for body in bodies)


@pytest.mark.parametrize("jobs", [1, 3])
@pytest.mark.parametrize(("heavy", "needed"), [(1, 10**9), (50, 10**7), (400, 10**8)])
def test_pairs_share_the_steps_of_the_scene(jobs, heavy, needed, found):
    """A few heavy pairs have the steps that the others leave. Where all are heavy, as many as the
    steps last for are decided, and no number of threads changes which."""
    _, pairs = chain(400)
    wants = {id(pair): needed if k < heavy else 1000 for k, pair in enumerate(pairs)}
    taken = []

    def examine(pair):
        steps = min(wants[id(pair)], pair.steps)
        taken.append(steps)
        return FakeChecked(steps == wants[id(pair)], steps, steps < wants[id(pair)])

    told = []
    decided = found(pairs, examine, jobs, progress=lambda done, total: told.append((done, total)))
    most = STEPS_OF_SCENE + 24 * STEPS_OF_TRIANGLE * 400
    assert sum(taken) <= most
    assert told[-1] == (400, 400)
    assert all(before <= after for (before, _), (after, _) in pairwise(told))
    assert all(decided[heavy:])
    if heavy * needed * 2 <= STEPS_OF_SCENE:
        assert all(decided)
    else:
        assert sum(decided[:heavy]) >= STEPS_OF_SCENE // (4 * needed)
    assert decided == found(pairs, examine, 1)


def test_no_pairs_at_all():
    assert examine_pairs([], 0) == []


def test_after_an_error_nobody_waits_for_the_others(monkeypatch, found):
    _, pairs = chain(PARALLEL_PAIRS + 2)
    in_order = []
    found(pairs, in_order.append)
    started, answered, heard = Event(), Event(), SimpleQueue()

    def examine(pair):
        if pair is in_order[0]:
            assert started.wait(timeout=20)
            raise KeyboardInterrupt
        started.set()
        heard.put(answered.wait(timeout=20))

    monkeypatch.setattr(checked_pairs, "leaves_work", lambda *_: True)
    with pytest.raises(KeyboardInterrupt):
        found(pairs, examine, 2)
    answered.set()
    assert heard.get(timeout=20)
