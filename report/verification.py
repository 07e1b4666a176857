"""The report of `satcheck verify`: what its certificates prove about a report and its files."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, Meta, UnsetType

from satcheck.report.statics import State
from satcheck.report.values import Count, Length, Tool, Value

Outcome = Literal["accepted", "rejected", "not certified", "open", "no file"]
# proven: from the mesh files and the certificates. follows: checked against proven values. stated:
# a request, taken as stated. certified: proven if the finding has a certificate for it, else not
# covered. not covered: only its type is checked.
Kind = Literal["proven", "follows", "stated", "certified", "not covered"]


class Checked(Value, frozen=True):
    """One finding of the report.

    outcome: open: the report states that the pair is indeterminate, which claims nothing. no file:
    the file of a body is missing, so nothing is known. reason: why it is not accepted. depth, mtv,
    thickness: whether that figure is proven too. distance_error: how far the proven distance may be
    off, world units; None: no distance is proven. left: fields of the finding with a value that is
    not proven.
    """

    a: str
    b: str
    relation: str
    outcome: Outcome
    reason: str | None = None
    depth: bool = False
    mtv: bool = False
    thickness: bool = False
    distance_error: Length | None = None
    left: tuple[str, ...] = ()


class CheckedSupport(Value, frozen=True):
    """One answer to a question about a single body: whether it is supported, stable, or inside a
    region. reason: why it is not accepted."""

    body: str
    question: str
    answer: State
    outcome: Outcome
    reason: str | None = None


class Uncovered(Value, frozen=True):
    """A field of the report with a value that is not proven.

    field: its path; [] means each member of a list. kind: stated: taken as the report states it.
    not covered: only its type is checked. certified: it can be proven, but was not in these
    findings. called: its meaning, in words. findings: number of findings with it; None: it belongs
    to the whole report.
    """

    field: str
    kind: Kind
    called: str
    findings: Annotated[int, Meta(ge=1)] | None = None


class VerificationReport(Value, frozen=True, kw_only=True):
    """The result of checking a report and its certificates against the mesh files.

    tool: the program that verified, and not the one of the report. accepted: every verdict of the
    report is proven or stated to be open, and everything else follows from the verdicts. findings:
    of the report, in its order. faults: errors of the report as a whole. not_certified: claims
    without a certificate, because of which the report is not accepted. pruned: unlisted pairs whose
    boxes are apart. exempt: unlisted pairs that the scene exempts or allows. missing: missing
    files; claims about their bodies are not checked. support: the answers about the support of
    bodies; absent if no rule asks.
    """

    schema: Literal["satcheck.verification/1"] = "satcheck.verification/1"
    tool: Tool
    accepted: bool
    findings: tuple[Checked, ...]
    faults: tuple[str, ...]
    not_certified: tuple[str, ...]
    pruned: Count
    exempt: Count
    missing: tuple[str, ...]
    support: tuple[CheckedSupport, ...] | UnsetType = UNSET
    not_covered: tuple[Uncovered, ...]

    @property
    def rejected(self) -> bool:
        """Return whether a checked claim is false."""
        outcomes = [f.outcome for f in self.findings] + [f.outcome for f in self.support or ()]
        return bool(self.faults) or "rejected" in outcomes
