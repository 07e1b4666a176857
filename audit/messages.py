"""The message of a finding, and that of a report: its verdict, PASS, FAIL or INCOMPLETE, and why.
JSON, the formats of CI and the last line of a table print these; the rows of a table and CSV have
the figures alone. The command says ERROR instead where an input could not be used, as its exit code
does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.words import (
    about,
    at_least,
    bounds,
    counted,
    figure,
    in_motion,
    is_hit,
    is_unusable,
    joint_values,
    limits,
    number,
    past_holes,
    short_names,
    vector,
    with_titles,
    with_unit,
    worst_first,
)
from satcheck.report.colliders import OF_COLLIDERS
from satcheck.report.report import BEYOND_BUDGET, INTERNAL_ERROR, NOTHING_TO_CHECK, OVERLAPS
from satcheck.report.request import OPTIONS_OF_LIMITS
from satcheck.report.sweep import JointPath
from satcheck.report.verdict import is_failure, is_unmet, severity, unlisted_indeterminate
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.report import BodyAnswer, Finding, Issue, Report
    from satcheck.report.statics import Statics

# Letters of what fails: with the next step that is two rows of 80.
_MOST = 140
NAMED = 3  # undecided pairs that a baseline accepts
# What one pair does, and what several do.
_VERBS = {
    "overlap": ("overlaps", "overlap"),
    "possibly": ("possibly overlaps", "possibly overlap"),
    "motion": ("hits in motion", "hit in motion"),
    "clearance": ("is too close", "are too close"),
    "touch": ("touches", "touch"),
    "undecided": ("is undecided", "are undecided"),
}
_OVERLAP = {
    "penetrating": "{} and {} overlap",
    "contains": "{} contains {}",
    "inside": "{} is inside {}",
    "coincident": "{} and {} coincide",
}


def with_messages(report: Report) -> Report:
    """Return the report with its message and those of its findings. They name bodies as a person
    knows them."""
    shown = with_titles(report)
    findings = tuple(
        replace(finding, message=finding_message(titled, shown))
        for finding, titled in zip(report.findings, shown.findings, strict=True)
    )
    return replace(report, message=verdict_line(shown), findings=findings)


def nothing_checked(issues: Iterable[Issue]) -> list[str]:
    """Return `no pair was checked: 1 within one link.`, where that is so."""
    return [f"{issue.message}." for issue in issues if issue.code == NOTHING_TO_CHECK]


def verdict_line(report: Report) -> str:
    """Return `PASS: no collision.`, `FAIL: box and lid overlap (1 mm to pull apart).`"""
    verdict, errors, is_open = report.summary.verdict, _errors(report), left_open(report)
    word, unchecked = f"{verdict.upper()}:", nothing_checked(report.issues)
    if verdict == "fail":
        more = [*is_open, *_unmeasured(report), *errors]
        return " ".join([word, f"{_failed(report)}.", *map(_sentence, more)])
    if unchecked:
        return " ".join([word, *unchecked, *map(_sentence, errors)])
    if verdict == "pass":
        return f"{word} {'; '.join([*errors, _passed(report)])}."
    if has_no_pair(report):
        return f"{word} no pair could be checked: {'; '.join(errors)}."
    if is_open:
        is_open[0] = f"{_no_collision(report)}, but {is_open[0]}"
    return f"{word} {'; '.join([*is_open, *errors]) or 'not everything was checked'}."


def has_no_pair(report: Report) -> bool:
    """Return whether inputs that cannot be used leave nothing to check."""
    usable = sum(not is_unusable(body) for body in report.bodies)
    return usable < min(len(report.bodies), 2) and not report.answers


def of_command(report: Report) -> str:
    """Return the message of the report with the word of the exit code."""
    _, colon, said = report.message.partition(":")
    return f"ERROR{colon}{said}" if _errors(report) else report.message


def _passed(report: Report) -> str:
    if not report.summary.pairs.asked and not report.regions:
        return "no pair to check"
    warnings = sum(severity(finding) == "warning" for finding in report.findings)
    said = _no_collision(report)
    if report.support is not None:
        said += f", {held(report.support)}"
        warnings += sum(
            f.answer == "yes" and f.severity == "warning" for f in report.support.findings
        )
    if report.regions:
        lying = sum(answer.answer == "yes" for answer in report.regions.findings)
        said += f", {counted(lying, 'body', 'bodies')} inside the region"
    accepted = [finding for finding in report.findings if finding.baseline_state == "accepted"]
    if unmeasured := sum(finding.undecided is None for finding in accepted):
        said += f", {unmeasured:,} accepted without figures"
    if undecided := [f"{each.a} and {each.b}" for each in accepted if each.undecided]:
        more = f" and {len(undecided) - NAMED:,} more" if len(undecided) > NAMED else ""
        named = ", ".join(undecided[:NAMED])
        said += f", {len(undecided):,} accepted undecided ({named}{more})"
    if issues := sum(issue.state == "accepted" for issue in report.issues):
        said += f", {counted(issues, 'issue')} accepted"
    return said + (f", {counted(warnings, 'warning')}" if warnings else "")


def _no_collision(report: Report) -> str:
    if report.summary.accepted:
        return "no new or worse finding"
    by = dict.fromkeys(who for finding in report.findings for who in _allowing(finding))
    allow = "allows" if len(by) == 1 and "rules" not in by else "allow"
    none = f"no collision beyond what {' and '.join(by)} {allow}" if by else "no collision"
    found = "" if report.summary.verdict == "pass" else " was found"
    return f"{none}{found}{_while_moving(report)}"


def _while_moving(report: Report) -> str:
    """Return ` on the path through 3 poses`; nothing where bodies stand still."""
    paths = [each for each in report.motions if isinstance(each, JointPath)]
    said = [f"on the path through {counted(len(path.waypoints), 'pose')}" for path in paths]
    if others := len(report.motions) - len(paths):
        said.append(f"during {counted(others, 'motion')}")
    return f" {' and '.join(said)}" if said else ""


def _allowing(finding: Finding) -> list[str]:
    """Return what allows the pair of a check that does not fail what it has, or may: `--max-depth`,
    or rules."""
    overlaps = finding.relation in OVERLAPS
    if finding.undecided == ("relation" if overlaps else "limit"):
        return []
    named = (finding.rule or "").split(", ")
    options = [name for name in OPTIONS_OF_LIMITS.values() if name in named]
    return options or (["rules"] if overlaps or finding.rule is not None else [])


def failing(report: Report) -> list[Finding]:
    fail_on = report.settings.fail_on
    return worst_first(f for f in report.findings if is_failure(f, fail_on))


def _failed(report: Report) -> str:
    """Return `6 of 21 pairs overlap, 1 is too close; worst: box and lid overlap (thickness 1
    mm)`."""
    worst = failing(report)
    first = clause(worst[0], report, brief=True) if worst else ""
    if len(worst) == 1 and len(first) > _MOST:
        a, b = short_names(worst[0].a, worst[0].b)
        first = clause(replace(worst[0], a=a, b=b), report, brief=True)
    said = [first] if first else []
    if len(worst) > 1:
        kinds, named = _kinds(worst, report), f"worst: {first}"
        said = [kinds, named] if len(f"{kinds}; {named}") <= _MOST else [kinds]
    said += _unmet(report)
    if worst and all(finding.severity != "error" for finding in worst):
        said.append(f"failed by --fail-on {report.settings.fail_on}")
    return "; ".join(said)


def _unmeasured(report: Report) -> list[str]:
    """Return `figures of the 12 worst of 40 failing pairs; --depth measures all`, if the budget of
    the scene left out the others."""
    spared = (effect.not_run for effect in report.effects if effect.effect == "depth")
    if not any(BEYOND_BUDGET in reasons for reasons in spared):
        return []
    overlaps = [finding for finding in failing(report) if finding.at_rest in OVERLAPS]
    measured = sum(finding.depth is not None for finding in overlaps)
    if not measured:
        return []
    which = "the worst" if measured == 1 else f"the {measured:,} worst"
    said = f"figures of {which} of {len(overlaps):,} failing pairs"
    return [f"{said}; --depth measures all"]


def _kinds(worst: Iterable[Finding], report: Report) -> str:
    """Return `6 of 21 pairs overlap, 1 is too close`; `overlap more than allowed` beside overlaps
    that pass."""
    kinds = Counter("possibly" if is_unsure(f, report) else kind_of(f) for f in worst)
    total = f" of {counted(report.summary.pairs.total, 'pair')}"
    said: list[str] = []
    for kind, verbs in _VERBS.items():
        if count := kinds[kind]:
            allowed = kind == "overlap" and any(map(_is_allowed, report.findings))
            too_much = " more than allowed" if allowed else ""
            said.append(f"{count:,}{'' if said else total} {verbs[count > 1]}{too_much}")
    return ", ".join(said)


def wrong_pairs(report: Report) -> str:
    """Return `6 of 21 pairs overlap, 1 is undecided`, as a title; the message where no pair is at
    fault."""
    failed = failing(report)
    undecided = [f for f in report.findings if f.undecided is not None and f not in failed]
    if report.answers or not (failed or undecided):
        return report.message.partition(": ")[2]
    return _kinds([*failed, *undecided], report)


def _is_allowed(finding: Finding) -> bool:
    """Return whether a rule lets this overlap pass."""
    return finding.severity in ("note", "silenced") and finding.at_rest in OVERLAPS


def _unmet(report: Report) -> list[str]:
    """Return a message about the first failing body, and the number of the others."""
    unmet = [answer for answer in report.answers if is_unmet(answer, report.settings.fail_on)]
    more = len({answer.body for answer in unmet}) - 1
    rest = [f"and {counted(more, 'more body', 'more bodies')}"] if more > 0 else []
    return [answer_message(answer) for answer in unmet[:1]] + rest


def answer_message(answer: BodyAnswer) -> str:
    """Return `top is not stable: no contact forces hold it`."""
    if answer.answer == "open":
        return f"whether {answer.body} is {answer.question} is open: {answer.reason}"
    is_not = "is not" if answer.answer == "no" else "is"
    return f"{answer.body} {is_not} {answer.question}: {answer.reason}"


def finding_message(finding: Finding, report: Report) -> str:
    """Return `box and lid overlap (thickness 0.5 mm, 1 mm to pull apart); moving box by (-1, 0, 0)
    ends the overlap.`"""
    text, swept = clause(finding, report), finding.motion
    if swept and not _hits_only(finding) and swept.relation not in ("separated", finding.at_rest):
        text += f"; in motion: {in_motion(finding, unit_of(report.units))}"
    if finding.mtv is not None and finding.mtv_verified:
        way = f"{about(finding.mtv)}{vector(finding.mtv)}"
        text += f"; moving {finding.a} by {way} ends the overlap"
    if finding.baseline_state is not None:
        unproven = ""
        if finding.baseline_state == "accepted":
            unproven = " undecided" if finding.undecided else " without figures"
        text += f" [baseline: {finding.baseline_state}{unproven}]"
    if finding.reason is not None and finding.reason not in text:
        text += f" ({finding.reason})"
    return f"{text}."


def measured(finding: Finding, unit: str | None) -> str:
    """Return `penetrating, thickness 0.5 mm, 1 mm to pull apart`, for what names the bodies."""
    if finding.rule in OF_COLLIDERS and finding.distance is not None:
        least = with_unit(at_least(finding.distance), unit)
        return f"{OF_COLLIDERS[finding.rule]} by {least} at least"
    parts = [finding.relation, *_figures(finding, unit)]
    if finding.distance is not None:
        parts.append(f"gap {with_unit(number(finding.distance), unit)}")
    if moving := in_motion(finding, unit):
        parts.append(f"in motion: {moving}")
    return ", ".join(parts)


def kind_of(finding: Finding) -> str:
    if finding.undecided is not None:
        return "undecided"
    if _hits_only(finding):
        return "motion"
    if finding.relation in OVERLAPS:
        return "overlap"
    if finding.rule in OF_COLLIDERS:
        return finding.rule
    return "touch" if finding.relation == "touching" and finding.rule is None else "clearance"


def clause(finding: Finding, report: Report, *, brief: bool = False) -> str:
    """Return `fence and palm are 40 mm apart (clearance 45 mm)`. brief: without joints."""
    unit, pair = unit_of(report.units), f"{finding.a} and {finding.b}"
    if _hits_only(finding):
        joints = finding.motion and finding.motion.joints
        where = f" ({joint_values(joints)})" if joints and not brief else ""
        return f"{finding.a} {in_motion(finding, unit, f' {finding.b}')}{where}"
    figures = limits(finding, report)
    if finding.baseline_state == "worse" and finding.reason:
        figures.append(finding.reason)
    if finding.at_rest in OVERLAPS:
        figures = [*_figures(finding, unit), *figures]
        said = _overlap(finding, report)
    else:
        said = f"{pair} {_apart(finding, unit)}"
    return f"{said} ({', '.join(figures)})" if figures else said


def _hits_only(finding: Finding) -> bool:
    """Return whether the bodies hit on their way, and do not overlap as they are placed."""
    return is_hit(finding) and finding.at_rest not in OVERLAPS


def _overlap(finding: Finding, report: Report) -> str:
    if finding.quality != "estimate":
        return _OVERLAP[finding.at_rest].format(finding.a, finding.b)
    possibly = "possibly " if is_unsure(finding, report) else ""
    return f"{finding.a} and {finding.b} {possibly}overlap"


def is_unsure(finding: Finding, report: Report) -> bool:
    """Return whether an overlap is stated, and none is proven."""
    if finding.quality != "estimate" or finding.at_rest not in OVERLAPS:
        return False
    settings = report.settings
    is_strict = settings.accuracy == "exact" and not settings.allow_open
    return not is_strict or finding.undecided == "relation"


def _figures(finding: Finding, unit: str | None) -> list[str]:
    known = {"thickness {}": finding.thickness_bounds, "{} to pull apart": finding.depth_bounds}
    said = [words.format(figure(proven, unit)) for words, proven in known.items() if proven]
    if finding.volume is not None:
        said.append(f"volume {with_unit(number(finding.volume), unit and f'{unit}^3')}")
    return said


def _apart(finding: Finding, unit: str | None) -> str:
    """The gap, at the worst of the way."""
    if finding.relation == "indeterminate":
        return "are undecided"
    if finding.relation == "touching":
        return "touch"
    worst = None if finding.motion is None else finding.motion.worst
    if worst is not None and worst.distance is not None:
        return f"come as close as {with_unit(bounds(*worst.distance), unit)}"
    if finding.distance is None:
        return "are apart" if finding.relation == "separated" else "are too close"
    between = finding.distance_bounds
    gap = number(finding.distance) if between is None else bounds(*between)
    return f"are {with_unit(gap, unit)} apart"


def left_open(report: Report) -> list[str]:
    """Return `1 pair is indeterminate`: what was asked and could not be decided."""
    summary, said = report.summary, []
    open_ = [f for f in report.findings if f.undecided is not None or f.motion is not None]
    undecided = sum(f.undecided == "relation" and f.baseline_state != "accepted" for f in open_)
    undecided += unlisted_indeterminate(summary.pairs, report.findings)
    if undecided:
        said.append(_of_pairs(undecided, "is indeterminate", "are indeterminate"))
    if swept := sum(map(past_holes, open_)):
        holes = "past holes that may be filled"
        said.append(_of_pairs(swept, f"moves {holes}", f"move {holes}"))
    unsure = Counter(f.relation in OVERLAPS for f in open_ if f.undecided == "limit")
    for overlap, what in ((True, "exceed {} limits"), (False, "be closer than {} clearance")):
        if count := unsure[overlap]:
            may = f"may {what.format('its' if count == 1 else 'their')}"
            said.append(_of_pairs(count, may, may))
    if moving := summary.sweeps_undecided:
        said.append(_of_pairs(moving, "may hit while moving", "may hit while moving"))
    if blocking := [issue for issue in report.issues if issue.state == "blocking"]:
        blocks = "blocks" if len(blocking) == 1 else "block"
        said.append(f"{counted(len(blocking), 'issue')} {blocks} a pass")
    if disputed := summary.disputed:
        said.append(f"{counted(disputed, 'answer')} {'is' if disputed == 1 else 'are'} disputed")
    if report.answers:
        said += _undecided_bodies(report)
    return said


def _undecided_bodies(report: Report) -> list[str]:
    """`the support of 2 bodies is open`."""
    held = report.support.findings if report.support else ()
    lying = report.regions.findings if report.regions else ()
    counts = {
        "the support of {} is open": len({f.body for f in held if f.answer == "open"}),
        "the region of {} is open": len({f.body for f in lying if f.answer == "open"}),
    }
    return [said.format(counted(n, "body", "bodies")) for said, n in counts.items() if n]


def held(statics: Statics) -> str:
    """`contact forces exist that hold 3 bodies`: of those that are asked about, and free; and how
    many have none, which a severity makes no failure."""
    free = {body.id for body in statics.bodies if body.fixed is None}
    yes = {f.body for f in statics.findings if f.answer == "yes"} & free
    no = {f.body for f in statics.findings if f.answer == "no"}
    said = f"contact forces exist that hold {counted(len(yes - no), 'body', 'bodies')}"
    if not no:
        return said
    missing = f"not supported: {counted(len(no), 'body', 'bodies')}"
    return f"{said}, {missing}" if yes - no else missing


def _of_pairs(count: int, singular: str, plural: str) -> str:
    return f"{counted(count, 'pair')} {singular if count == 1 else plural}"


def _errors(report: Report) -> list[str]:
    errors = [issue.code for issue in report.issues if issue.severity == "error"]
    faults = errors.count(INTERNAL_ERROR)
    said = []
    if inputs := len(errors) - faults:
        said.append(f"{counted(inputs, 'input')} could not be used")
    if faults:
        said.append(f"{counted(faults, 'pair')} failed by an internal error")
    return said


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."
