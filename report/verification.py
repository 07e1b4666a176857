"""What `satcheck verify` proves of a report by its certificates, checked again from the files."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.values import Count, Tool, Value

Outcome = Literal["accepted", "rejected", "not certified", "open", "no file"]
# proven: from the mesh files and the certificates. follows: checked against what is proven.
# stated: what was asked, taken as it stands. certified: proven where the certificate of a finding
# says so, else not covered. not covered: only its type is checked.
Kind = Literal["proven", "follows", "stated", "certified", "not covered"]


class Checked(Value, frozen=True):
    """One finding of the report.

    outcome: open: the report says that the pair is indeterminate, which claims nothing. no file:
    that of a body is missing, so nothing is known. reason: why it is not accepted. depth, mtv,
    thickness: that figure is proven too. left: fields of the finding that say something which is
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
    left: tuple[str, ...] = ()


class Uncovered(Value, frozen=True):
    """A field of the report with a value that is not proven.

    field: its path; [] stands for each member of a list. kind: stated: taken as the report states
    it. not covered: only its type is checked. certified: it can be proven, and was not in these
    findings. called: what it is about, in words. findings: in how many; None: it is of the report.
    """

    field: str
    kind: Kind
    called: str
    findings: Annotated[int, Meta(ge=1)] | None = None


class VerificationReport(Value, frozen=True, kw_only=True):
    """What is proven of a report by its certificates, checked again from the mesh files.

    tool: that verified, not that of the report. accepted: every verdict of the report is proven or
    said to be open, and all else follows from them. findings: those of the report, in their order.
    faults: what is wrong with the report as a whole. not_certified: what no certificate speaks of,
    so that the report is not accepted. pruned: pairs that the report does not list, whose boxes are
    apart. exempt: pairs that it does not list, and that its scene exempts or allows. missing: files
    that are not there: what rests on them is not checked.
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
    not_covered: tuple[Uncovered, ...]
