"""`satcheck verify REPORT`: from a report to what is proven of it, and an exit code."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satcheck._version import __version__
from satcheck.cli import exit_codes
from satcheck.cli.output import Document, harmless, talk
from satcheck.core.errors import SatcheckError
from satcheck.core.frozen import frozen
from satcheck.scene.loading.regular_file import size_of

if TYPE_CHECKING:
    from satcheck.verify import Checked, Verification
    from satcheck.verify.document import Outcome

SCHEMA = "satcheck.verification/1"
MOST_BYTES = 1 << 30
# At most this many files that are not there are named.
MOST_NAMED = 3
# Outcomes that are not "accepted", in the words of the last line.
_CALLED: dict[Outcome, str] = {
    "rejected": "rejected",
    "not certified": "not certified",
    "open": "indeterminate",
    "no file": "not checked, as files are missing",
}


@frozen
class Choices:
    """The options of the command line. root: where the paths of the report start."""

    report: Path
    root: Path
    form: str
    output: Path | None
    allow_outside: bool


def run(choices: Choices) -> int:
    """Verify, write the document; returns the exit code."""
    from satcheck.cli.checking import refuse_early
    from satcheck.cli.progress import Bar
    from satcheck.cli.report.json import document as json_text
    from satcheck.verify import Rejected, verify

    report, root = choices.report, choices.root
    refuse_early((str(report),), choices.output)
    document = Document()
    content = _read(report)
    try:
        with Bar() as bar:
            found = verify(content, root, bar, allow_outside=choices.allow_outside)
    except Rejected as why:
        raise SatcheckError("bad-report", f"{report}: {why}") from None
    in_json = choices.form == "json"
    text = json_text(_values(found)) if in_json else _table(found)
    document.deliver(lambda _: text, choices.output, utf8=in_json)
    if found.missing:
        talk(f"satcheck: {_missing(found, root)}")
    if not found.certified:
        talk(f"satcheck: {report}: no certificates: was it made with --certificate?")
        return exit_codes.ERROR
    if found.missing and not found.rejected:
        return exit_codes.ERROR
    return exit_codes.CLEAN if found.accepted else exit_codes.FINDINGS


def _read(report: Path) -> Any:
    from satcheck.verify import Rejected, parse

    try:
        if size_of(report) > MOST_BYTES:
            raise SatcheckError("bad-report", "too large")
        text = report.read_text("utf-8")
    except SatcheckError as error:
        raise SatcheckError(error.code, error.message, file=str(report)) from None
    except OSError as error:
        raise SatcheckError("unreadable-file", f"{report}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise SatcheckError("bad-report", f"{report}: not UTF-8") from None
    try:
        return parse(text)
    except Rejected as why:
        raise SatcheckError("bad-report", f"{report}: {why}") from None


def _values(found: Verification) -> dict[str, Any]:
    return {
        "schema": SCHEMA,
        "tool": {"name": "satcheck", "version": __version__},
        "accepted": found.accepted and found.certified,
        "findings": [asdict(finding) for finding in found.findings],
        "faults": list(found.faults),
        "not_certified": list(found.beyond),
        "pruned": found.pruned,
        "exempt": found.exempt,
        "missing": list(found.missing),
        "not_covered": [asdict(field) for field in found.uncovered],
    }


def _missing(found: Verification, root: Path) -> str:
    from satcheck.cli.report.words import counted

    first = ", ".join(found.missing[:MOST_NAMED])
    more = len(found.missing) - MOST_NAMED
    files = first + (f" and {more:,} more" if more > 0 else "")
    return (
        f"{counted(len(found.missing), 'file is', 'files are')} missing below {root.absolute()}: "
        f"{files}; --root names the folder where the check ran"
    )


def _table(found: Verification) -> str:
    """What was not accepted, line by line, and a sentence about all."""
    unsaid = ("accepted", "no file")  # a line on stderr speaks of all files
    lines = [_line(finding) for finding in found.findings if finding.outcome not in unsaid]
    lines += [f"rejected: {fault}" for fault in found.faults]
    lines += [f"not certified: {what}" for what in found.beyond]
    lines.append(_summary(found))
    lines += _not_covered(found)
    return "".join(f"{harmless(line)}\n" for line in lines)


def _not_covered(found: Verification) -> Iterator[str]:
    """The fields that are not proven, by the names that readers know."""
    for title, kinds in (
        ("Taken as stated", ("stated",)),
        ("Not covered", ("not covered", "certified")),
    ):
        names: dict[str, int] = {}
        for field in found.uncovered:
            if field.kind in kinds:
                names[field.called] = max(names.get(field.called, 0), field.findings or 0)
        if names:
            named = (f"{name} ({count:,})" if count else name for name, count in names.items())
            yield f"{title}: {', '.join(named)}."


def _line(finding: Checked) -> str:
    return f"{finding.outcome}: {finding.a} and {finding.b}, {finding.relation}: {finding.reason}"


def _summary(found: Verification) -> str:
    from satcheck.cli.report.words import counted

    accepted = [f for f in found.findings if f.outcome == "accepted"]
    parts = [f"{counted(len(accepted), 'verdict')} accepted"]
    for outcome, called in _CALLED.items():
        if count := sum(f.outcome == outcome for f in found.findings):
            parts.append(f"{count:,} {called}")
    if found.faults:
        parts.append(f"{counted(len(found.faults), 'fault')} in the rest of the report")
    if found.pruned:
        parts.append(f"{counted(found.pruned, 'pair')} apart by their boxes")
    if found.exempt:
        parts.append(f"{counted(found.exempt, 'pair')} exempt by the scene, not checked")
    depths, moves = sum(f.depth for f in accepted), sum(f.mtv for f in accepted)
    proven = [
        counted(count, *words)
        for count, words in ((depths, ("depth",)), (moves, ("way out", "ways out")))
        if count
    ]
    extra = f" Proven besides: {', '.join(proven)}." if proven else ""
    return ", ".join(parts) + "." + extra
