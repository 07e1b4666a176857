"""The findings of pairs: each pair is examined, and its finding gets its evidence on request.

A pair that fails is a finding too, so that the other pairs are still checked.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.finding import Examined, examine, indeterminate
from satcheck.audit.ladder.core_climb import start_climbs
from satcheck.audit.pair_queue import PairQueue
from satcheck.audit.request.trace import Trace
from satcheck.core.risky_steps import LeftOut, is_careful, not_for_lack_of_memory, risky_step
from satcheck.report.report import INTERNAL_ERROR, Finding, Issue

if TYPE_CHECKING:
    from satcheck.core import Climb

Progress = Callable[[int, int], None]


class CheckedPair(Struct, frozen=True):
    finding: Finding
    issues: tuple[Issue, ...] = ()


def examine_pairs(
    pairs: Sequence[Pair], queue: PairQueue, progress: Progress | None = None
) -> list[CheckedPair]:
    """The findings of pairs with the same settings, in their order."""
    done: dict[int, CheckedPair] = {}
    careful = is_careful()
    examine = _examine_carefully if careful else _examine
    for k, checked in queue.each(pairs, examine, alone=careful):
        done[k] = checked
        if progress is not None:
            progress(len(done), len(pairs))
    return [done[k] for k in range(len(pairs))]


def _examine_carefully(pair: Pair, _: Climb | None) -> CheckedPair:
    """One pair after another, and none that has ended the process before."""
    a, b = pair.a.id, pair.b.id
    try:
        with risky_step(f"checking {a!r} and {b!r}"):
            return _examine(pair, *start_climbs([pair], 1)())
    except LeftOut as error:
        reason = f"the process that checked this pair {error.message}"
        issue = Issue(error.code, "warning", None, None, f"{a} and {b}: {reason}")
        return CheckedPair(indeterminate(a, b, reason, Trace()), (issue,))


def _examine(pair: Pair, climb: Climb | None = None) -> CheckedPair:
    """One pair. A failure becomes a finding, so that the other pairs are still checked."""
    trace = Trace()
    try:
        examined = examine(pair, trace, climb)
        if pair.paths is not None:
            from satcheck.audit.motion.swept_finding import with_sweep

            examined = with_sweep(examined, pair, pair.paths, trace)
        finding = examined.finding
        if pair.request.wants("certificate"):
            finding = with_certificate(pair, examined)
        return CheckedPair(finding, tuple(trace.issues))
    except Exception as error:
        not_for_lack_of_memory(error)
        import logging

        logging.getLogger("satcheck").debug("a pair failed", exc_info=True)
        reason = f"internal error: {type(error).__name__}: {error}"
        message = f"{pair.a.id} and {pair.b.id}: {reason}"
        issue = Issue(INTERNAL_ERROR, "error", None, None, message)
        finding = indeterminate(pair.a.id, pair.b.id, reason, trace)
        return CheckedPair(finding, (*trace.issues, issue))


def with_certificate(pair: Pair, examined: Examined) -> Finding:
    """The finding with its evidence, or with a stage that says why there is none."""
    from satcheck.audit.certify import NoCertificate, certified

    trace, finding = Trace(), examined.finding
    if finding.motion is not None:
        trace.record("certificate", "none", "a sweep of moving bodies leaves no evidence")
        return replace(finding, plan=(*finding.plan, *trace.stages))
    try:
        certificate = certified(pair, examined)
    except Exception as error:  # noqa: BLE001 the verdict stands whatever becomes of its evidence
        not_for_lack_of_memory(error)
        certificate = NoCertificate(f"internal error: {type(error).__name__}: {error}")
    if isinstance(certificate, NoCertificate):
        trace.record("certificate", "none", certificate.reason)
        return replace(finding, plan=(*finding.plan, *trace.stages))
    kind = certificate.relation.__struct_config__.tag
    trace.record("certificate", str(kind), "accepted by the checker")
    return replace(finding, certificate=certificate, plan=(*finding.plan, *trace.stages))
