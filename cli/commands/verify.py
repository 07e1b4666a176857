"""`satcheck verify REPORT`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import click

from satcheck.audit.words import at_most, counted
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import deliver, form_option, plain_call
from satcheck.cli.output import harmless, talk
from satcheck.cli.progress import Bar
from satcheck.core.errors import SatcheckError
from satcheck.report.verification import Outcome
from satcheck.scene.opening import read_whole
from satcheck.scene.words import listed
from satcheck.verify import Rejected, VerificationReport, is_certified, parse, verify

# The figures that a certificate may prove, in the words of the last line.
_FIGURES = {"depth": ("depth",), "thickness": ("thickness",) * 2, "mtv": ("way out", "ways out")}
# Outcomes that are not "accepted", in the words of the last line.
_CALLED: dict[Outcome, str] = {
    "rejected": "rejected",
    "not certified": "not certified",
    "open": "indeterminate",
    "no file": "not checked, as files are missing",
}


@click.command("verify", cls=Command, context_settings=HELP_NAMES)
@click.argument("report", metavar="REPORT", type=click.Path(dir_okay=False, path_type=Path))
@option.root
@form_option
@option.output
@scene_option.outside
@option.common
def command(
    report: Path,
    root: Path,
    form: str | None,
    output: Path | None,
    allow_outside: bool,
) -> int:
    """Re-check the certificates of a report.

    satcheck --certificate -o REPORT.json A B writes such a report. Its verdicts are checked
    against the mesh files in rational arithmetic, without the solver. A verdict without a
    certificate (an estimate below --accuracy exact, for instance) is not certified and does not
    pass.

    Exit codes: 0, every verdict is accepted; 1, a verdict is rejected or not certified; 2, wrong
    usage, an unreadable report, no certificate in it, a missing mesh file, or an internal error.
    """
    _, form, document = plain_call({"paths": (str(report),)}, form, output)
    try:
        content = parse(read_whole(report).decode())
        with Bar("verdicts", "verifying") as bar:
            result = verify(content, root, bar, allow_outside=allow_outside)
    except UnicodeDecodeError:
        raise SatcheckError("bad-report", f"{report}: not UTF-8") from None
    except Rejected as why:
        raise SatcheckError("bad-report", f"{report}: {why}") from None
    certified = is_certified(result, content)
    if certified or result.faults or form == "json" or output is not None:
        deliver(document, result, form, output, lambda _: _table(result))
    if result.missing:
        talk(f"satcheck: {_missing(result, root)}")
    if not certified:
        talk(f"satcheck: {report}: no certificates: was it made with --certificate?")
        return exit_codes.ERROR
    if result.missing and not result.rejected:
        return exit_codes.ERROR
    return exit_codes.CLEAN if result.accepted else exit_codes.FINDINGS


def _missing(result: VerificationReport, root: Path) -> str:
    return (
        f"{counted(len(result.missing), 'file is', 'files are')} missing below {root.absolute()}: "
        f"{listed(result.missing)}; --root names the folder where the check ran"
    )


def _table(result: VerificationReport) -> str:
    """Return what was not accepted, line by line, and a sentence about all."""
    unsaid = ("accepted", "no file")  # a line on stderr speaks of all files
    told = [finding for finding in result.findings if finding.outcome not in unsaid]
    open_answers = [answer for answer in result.support or () if answer.outcome != "accepted"]
    lines = [f"{f.outcome}: {f.a} and {f.b}, {f.relation}: {f.reason}" for f in told]
    lines += [f"{a.outcome}: {a.body}, {a.question}: {a.answer}: {a.reason}" for a in open_answers]
    lines += [f"rejected: {fault}" for fault in result.faults]
    lines += [f"not certified: {what}" for what in result.not_certified]
    lines.append(_summary(result))
    lines += _not_covered(result)
    return "".join(f"{harmless(line)}\n" for line in lines)


def _not_covered(result: VerificationReport) -> Iterator[str]:
    """The fields that are not proven, by the names that readers know."""
    for title, kinds in (
        ("Taken as stated", ("stated",)),
        ("Not covered", ("not covered", "certified")),
    ):
        names: dict[str, int] = {}
        for field in result.not_covered:
            if field.kind in kinds:
                names[field.called] = max(names.get(field.called, 0), field.findings or 0)
        if names:
            named = (f"{name} ({count:,})" if count else name for name, count in names.items())
            yield f"{title}: {', '.join(named)}."


def _summary(result: VerificationReport) -> str:
    accepted = [f for f in result.findings if f.outcome == "accepted"]
    parts = [f"{counted(len(accepted), 'verdict')} accepted"]
    for outcome, called in _CALLED.items():
        if count := sum(f.outcome == outcome for f in result.findings):
            parts.append(f"{count:,} {called}")
    if result.support:
        held = sum(answer.outcome == "accepted" for answer in result.support)
        parts.append(f"{held:,} of {counted(len(result.support), 'answer')} about bodies accepted")
    if result.faults:
        parts.append(f"{counted(len(result.faults), 'fault')} in the rest of the report")
    if result.pruned:
        parts.append(f"{counted(result.pruned, 'pair')} apart by their boxes")
    if result.exempt:
        parts.append(f"{counted(result.exempt, 'pair')} exempt by the scene, not checked")
    proven = [
        counted(count, *words)
        for key, words in _FIGURES.items()
        if (count := sum(getattr(f, key) for f in accepted))
    ]
    errors = [f.distance_error for f in accepted if f.distance_error is not None]
    if errors:
        distances = counted(len(errors), "distance", "distances")
        proven.append(f"{distances} to within {at_most(max(errors))}" if any(errors) else distances)
    extra = f" Also proven: {', '.join(proven)}." if proven else ""
    return ", ".join(parts) + "." + extra
