"""The figures of overlaps, where no flag asks for those of all pairs.

A scene may have thousands of overlaps. So their figures share budgets of counted steps, which any
machine and any number of threads spends alike. The pair with the deepest overlap of world boxes
comes first. Steps that a pair leaves go to the pairs after it. Pairs that come after a budget is
spent have no figures.

First come the figures that rules limit, and those of mesh files alone. They may take the steps that
the relations of the scene have left. Then a failing pair calls for its other figures, within the
budget of one pair with --depth.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from msgspec.structs import replace

from satcheck.audit.body import box_escape
from satcheck.audit.checked_pairs import PARALLEL_PAIRS, CheckedPair, Held, failed, finished
from satcheck.audit.draft import Draft
from satcheck.audit.finding import measure
from satcheck.audit.parallel import in_parallel
from satcheck.audit.planner import FOR_FAILURES
from satcheck.audit.settings import THICKNESS_SHARE, Settings
from satcheck.audit.stages.thickness import why_not_thick
from satcheck.core.steps import LeftOut, is_careful, risky_step
from satcheck.report.report import BEYOND_BUDGET, OVERLAPS, Finding, Issue
from satcheck.report.verdict import fails

T = TypeVar("T")
R = TypeVar("R")

# A step of a search takes as long as so many steps of a climb, if the surfaces cross much.
STEPS_OF_SEARCH = 5
# The pairs that share what is left at a time. One, where a child process measures volumes.
AT_ONCE = 16
# A failing pair may use this share of the budget, even if that leaves nothing for the last pairs.
LEAST_SHARE = 1 / 8
# Steps for what the searches do not count, such as hulls and the proof of a way out: for a pair,
# and for each of its triangles. More if that proof takes more.
STEPS_OF_PAIR = 400_000
STEPS_OF_TRIANGLE = 1_000


def with_figures(
    examined: Sequence[CheckedPair], settings: Settings, left: int, *, keep: bool
) -> list[CheckedPair]:
    """Return the pairs with the figures of those that wait for them, as far as the budgets go.
    left: steps of the scene. keep: do not release the data of the bodies."""
    pairs = list(examined)
    drafts = {k: pair.draft for k, pair in enumerate(pairs) if pair.draft is not None}
    overlap = {k: box_escape(d.pair.a.bounds, d.pair.b.bounds)[0] for k, d in drafts.items()}
    order = sorted(drafts, key=lambda k: (-overlap[k], k))
    threads = 1 if is_careful() else settings.jobs or os.cpu_count() or 1
    waiting = [k for k in order if drafts[k].waits]
    _measure(pairs, waiting, left // STEPS_OF_SEARCH, threads, shared=True)
    failing = [k for k in order if _calls_for_figures(pairs[k])]
    _measure(pairs, failing, settings.work, 1, shared=False)
    some = any(d.pair.moves or d.pair.request.wants("certificate") for d in drafts.values())
    done = _each(lambda k: _finished(pairs[k]), order, threads if some else 1)
    for k, pair in zip(order, done, strict=True):
        pairs[k] = pair
    for draft in drafts.values() if not keep else ():
        draft.pair.a.release()
        draft.pair.b.release()
    return pairs


def _calls_for_figures(pair: CheckedPair) -> bool:
    draft = pair.draft
    if draft is None or not draft.pair.request.if_failing:
        return False
    return pair.finding.relation in OVERLAPS and fails(pair.finding, draft.pair.settings.fail_on)


def _measure(
    pairs: list[CheckedPair], order: Sequence[int], left: int, threads: int, *, shared: bool
) -> None:
    """Put the pairs back with their figures, in this order. left: steps of all. shared: measure
    what waits for the relations of the scene, instead of what failing pairs call for."""
    least, at_once = int(left * LEAST_SHARE), 1
    if shared:
        volumes = any(
            "volume" in draft.pair.request.shared for k in order if (draft := pairs[k].draft)
        )
        least, at_once = 0, 1 if volumes else AT_ONCE
    held = Held()
    for start in range(0, len(order), at_once):
        turn = [(k, draft) for k in order[start : start + at_once] if (draft := pairs[k].draft)]
        share = min(max(left // (len(order) - start), least), left)

        def measured(item: tuple[int, Draft], share: int = share) -> tuple[CheckedPair, int]:
            return _measured(pairs[item[0]].finding, item[1], share, shared=shared)

        for (k, draft), (pair, spent) in zip(turn, _each(measured, turn, threads), strict=True):
            pairs[k] = pair
            left -= spent
            held.use(draft.pair.a, draft.pair.b)


def _measured(
    finding: Finding, draft: Draft, share: int, *, shared: bool
) -> tuple[CheckedPair, int]:
    """Return the pair with its figures, and the steps that they took. share: the most steps of the
    searches."""
    pair, before, stages = draft.pair, draft.work, len(draft.stages)
    a, b, request = pair.a.id, pair.b.id, pair.request
    if shared:
        effects, by = list(request.shared), request.by
    else:
        effects = [e for e in request.if_failing if e != "thickness" or not why_not_thick(pair)]
        by = {**request.by, **dict.fromkeys(effects, FOR_FAILURES)}
    if share <= 0:
        return CheckedPair(_beyond(finding) if shared else finding, draft=draft), 0
    work = min(pair.work, math.ceil(share / (1 + THICKNESS_SHARE)))
    draft.pair = replace(pair, work=work, moved_steps=0, request=replace(request, by=by))
    try:
        with risky_step(f"measuring {a!r} and {b!r}"):
            checked = CheckedPair(measure(draft, effects), draft=draft)
    except LeftOut as error:
        reason = f"{a} and {b}: the process that measured this pair {error.message}"
        draft.issues.append(Issue(error.code, "warning", None, None, reason))
        checked = CheckedPair(finding, draft=draft)
    except Exception as error:  # noqa: BLE001  what was proven before it stands
        checked = replace(failed(draft, error), finding=finding)
    steps = max(STEPS_OF_PAIR + STEPS_OF_TRIANGLE * pair.triangles, draft.pair.moved_steps)
    if shared:
        draft.pair = pair
        if work < pair.work and any(s.result == "budget spent" for s in draft.stages[stages:]):
            checked = replace(checked, finding=_beyond(checked.finding))
    return checked, draft.work - before + steps


def _beyond(finding: Finding) -> Finding:
    """Return the finding with the reason why a limit is undecided: steps of the scene are spent."""
    if finding.undecided != "limit":
        return finding
    return replace(finding, reason=f"{finding.reason}: {BEYOND_BUDGET}")


def _each(work: Callable[[T], R], things: Sequence[T], threads: int) -> Iterable[R]:
    if threads == 1 or len(things) < PARALLEL_PAIRS:
        return map(work, things)
    return in_parallel(work, things, threads)


def _finished(pair: CheckedPair) -> CheckedPair:
    draft = pair.draft
    if draft is None:  # it failed while it was measured
        return pair
    try:
        return finished(pair.finding, draft)
    except Exception as error:  # noqa: BLE001  the other pairs are still checked
        return failed(draft, error)
