"""The depth and the thickness of pairs that fail, where nobody asked for the figures of all pairs.

A failing pair calls for its figures, and a scene may have thousands of them. So they share a budget
of counted steps, which any machine and any number of threads spends alike: that of one pair with
--depth. The pair with the deepest overlap of world boxes comes first. Steps that a pair leaves go
to the pairs after it. Pairs that come after the budget is spent have no figures.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence

from msgspec.structs import replace

from satcheck.audit.body import box_escape
from satcheck.audit.checked_pairs import PARALLEL_PAIRS, CheckedPair, failed, finished
from satcheck.audit.draft import Draft
from satcheck.audit.finding import measure
from satcheck.audit.parallel import in_parallel
from satcheck.audit.planner import FOR_FAILURES
from satcheck.audit.settings import THICKNESS_SHARE, Settings
from satcheck.audit.stages.thickness import why_not_thick
from satcheck.core.steps import LeftOut, is_careful, risky_step
from satcheck.report.report import Finding, Issue

# A pair may use this share of the budget, even if that leaves nothing for the last pairs.
LEAST_SHARE = 1 / 8
# Steps for what the searches do not count, such as hulls and the proof of a way out: for a pair,
# and for each of its triangles. More if that proof takes more.
UNCOUNTED_OF_PAIR = 400_000
UNCOUNTED_OF_TRIANGLE = 1_000


def with_figures(
    examined: Sequence[CheckedPair], settings: Settings, *, keep: bool
) -> list[CheckedPair]:
    """Return the pairs with the figures of those that wait for them, as far as the budget goes.
    keep: do not release the data of the bodies."""
    pairs = list(examined)
    drafts = {k: pair.draft for k, pair in enumerate(pairs) if pair.draft is not None}
    overlap = {k: box_escape(d.pair.a.bounds, d.pair.b.bounds)[0] for k, d in drafts.items()}
    order = sorted(drafts, key=lambda k: (-overlap[k], k))
    left = budget = settings.work
    for number, k in enumerate(order):
        if left <= 0:
            break
        share = max(left // (len(order) - number), int(budget * LEAST_SHARE))
        pairs[k], spent = _measured(pairs[k].finding, drafts[k], min(share, left))
        left -= spent
    threads = settings.jobs or os.cpu_count() or 1
    done: Iterable[CheckedPair]
    if is_careful() or threads == 1 or len(order) < PARALLEL_PAIRS:
        done = (_finished(pairs[k]) for k in order)
    else:
        done = in_parallel(lambda k: _finished(pairs[k]), order, threads)
    for k, pair in zip(order, done, strict=True):
        pairs[k] = pair
    for draft in drafts.values() if not keep else ():
        draft.pair.a.release()
        draft.pair.b.release()
    return pairs


def _measured(finding: Finding, draft: Draft, share: int) -> tuple[CheckedPair, int]:
    """Return the pair with its figures, and the steps that they took. share: the most steps of the
    searches."""
    pair, before = draft.pair, draft.work
    a, b, request = pair.a.id, pair.b.id, pair.request
    effects = [e for e in request.if_failing if e != "thickness" or why_not_thick(pair) is None]
    work = min(pair.work, math.ceil(share / (1 + THICKNESS_SHARE)))
    by = {**request.by, **dict.fromkeys(effects, FOR_FAILURES)}
    draft.pair = replace(pair, work=work, moved_steps=0, request=replace(request, by=by))
    try:
        with risky_step(f"measuring {a!r} and {b!r}"):
            checked = CheckedPair(measure(draft), draft=draft)
    except LeftOut as error:
        reason = f"{a} and {b}: the process that measured this pair {error.message}"
        draft.issues.append(Issue(error.code, "warning", None, None, reason))
        checked = CheckedPair(finding, draft=draft)
    except Exception as error:  # noqa: BLE001  what was proven before it stands
        checked = replace(failed(draft, error), finding=finding)
    steps = UNCOUNTED_OF_PAIR + UNCOUNTED_OF_TRIANGLE * pair.triangles
    return checked, draft.work - before + max(steps, draft.pair.moved_steps)


def _finished(pair: CheckedPair) -> CheckedPair:
    draft = pair.draft
    if draft is None:  # it failed while it was measured
        return pair
    try:
        return finished(pair.finding, draft)
    except Exception as error:  # noqa: BLE001  the other pairs are still checked
        return failed(draft, error)
