"""Words and cells about one thing: a count, an issue, a relation, a depth, a limit, an option; and
a report with names that a terminal can show."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from satcheck.cli.formats.numbers import at_least, at_most, bounds, number, vector
from satcheck.cli.output import harmless
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from satcheck.report.report import BodyReport, Finding, Issue, Report, RuleReport
    from satcheck.report.settings import OptionValue, StatedConfig
    from satcheck.report.sweep import Joints, Place
    from satcheck.report.values import Interval
    from satcheck.scene import Issue as InputIssue

# A lower bound below this share of the upper one is left out: it tells a person nothing.
NEGLIGIBLE = 1e-3
# A line names at most so many joints.
MOST_JOINTS = 8


def counted(count: int, singular: str, plural: str | None = None) -> str:
    """`1 pair`, `2 pairs`."""
    return f"{count:,} {singular if count == 1 else plural or singular + 's'}"


def issue_line(issue: Issue | InputIssue) -> str:
    """`warning: l_bracket: 2 open edges [open-mesh]`, as it also goes to stderr; one line, whatever
    the names are."""
    where = issue.body or issue.file
    known = tuple(filter(None, (where, issue.file)))
    named = f"{where}: " if known and not issue.message.startswith(known) else ""
    return harmless(f"{issue.severity}: {named}{issue.message} [{issue.code}]")


def interval(proven: Interval | None, *, bounded: str = "<= ") -> str:
    """A figure with its proven bounds, as one number where they are the same but for rounding;
    empty when there is none.

    bounded: what goes before a figure that has no lower bound worth showing.
    """
    if proven is None:
        return ""
    low, high = proven
    if high - low <= EXACT_WIDTH * high:
        return number(high)
    return bounded + at_most(high) if low <= NEGLIGIBLE * high else bounds(low, high)


def contacts(finding: Finding) -> str:
    """`1 loop of length 4.25`, `2 patches of area 3, 1 point`; empty when not computed."""
    if finding.contacts is None:
        return ""
    curves, totals = finding.contacts.curves, finding.contacts.totals
    loops = len(curves) == totals.curves and all(curve.closed for curve in curves)
    counts = []
    if totals.patches:
        counts.append(
            f"{counted(totals.patches, 'patch', 'patches')} of area {number(totals.area)}"
        )
    if totals.curves:
        name = counted(totals.curves, "loop" if loops else "curve")
        counts.append(f"{name} of length {number(totals.length)}")
    if totals.points:
        counts.append(counted(totals.points, "point"))
    return ", ".join(counts) or "none"


def is_unusable(body: BodyReport) -> bool:
    """Whether the body could not be read or placed. An error issue says why."""
    return body.triangles is None


def past_holes(finding: Finding) -> bool:
    """Whether one body may come to lie in the other on the way, by what fills a hole."""
    swept = finding.motion
    return swept is not None and swept.relation != "indeterminate" and swept.reason is not None


def is_hit(finding: Finding) -> bool:
    """On their way."""
    return finding.motion is not None and finding.motion.relation == "penetrating"


def in_motion(finding: Finding, unit: str | None) -> str:
    """`hits at 60 deg, near (1.5, 2, 0)`, `0.25 mm apart`, `apart`, `touches`,
    `undecided from t = 0.4`; empty where neither body moves."""
    swept = finding.motion
    if swept is None:
        return ""
    if swept.relation == "penetrating":
        verb = "hits" if swept.proven else "possibly hits"
        on_path = "" if swept.poses is None else between_poses(*swept.poses)
        near = "" if swept.point is None else f", near {vector(swept.point)}"
        return f"{verb} at {', '.join(place(one, unit) for one in swept.at)}{on_path}{near}"
    if swept.relation == "indeterminate":
        return f"undecided from t = {number(swept.reached)}"
    if swept.relation == "touching":
        return "touches"
    distance = swept.worst and swept.worst.distance
    if distance:
        return f"{with_unit(bounds(*distance), unit)} apart"
    least = swept.distance_at_least
    if least is None or least <= swept.tolerance:
        return "apart"
    return f"at least {with_unit(at_least(least), unit)} apart"


def between_poses(before: int, after: int) -> str:
    return f", between poses {before} and {after}"


def joint_values(joints: Joints) -> str:
    """`shoulder = 0.72, elbow = 0`, of the first joints where they are many."""
    said = [
        f"{name} = {', '.join(map(number, value)) if isinstance(value, list) else number(value)}"
        for name, value in joints.items()
    ]
    return ", ".join([*said[:MOST_JOINTS], *(["..."] if len(said) > MOST_JOINTS else [])])


def place(at: Place, unit: str | None) -> str:
    """`60 deg`, `2.5 mm of travel`, `t = 0.3`."""
    value = number(at.value)
    travelled = f"{with_unit(value, unit)} of travel"
    return {"degrees": f"{value} deg", "length": travelled, "t": f"t = {value}"}[at.term]


def with_unit(figure: str, unit: str | None) -> str:
    """`2.5 mm`; the figure alone where its unit is unknown."""
    return f"{figure} {unit}" if unit else figure


def rule_of(finding: Finding, report: Report) -> RuleReport | None:
    """The rule of the scene that decided the severity; None, too, where several have its name, as
    those of one line do."""
    named = [rule for rule in report.rules if rule.name == finding.rule]
    return named[0] if len(named) == 1 else None


def limits(finding: Finding, report: Report) -> list[str]:
    """What the pair is held against: `clearance 5 mm`; of an overlap `max_depth 1 mm`."""
    unit, rule = unit_of(report.units), rule_of(finding, report)
    if finding.relation not in OVERLAPS:
        own = None if rule is None else rule.clearance
        asked = {"clearance": (report.settings.clearance if own is None else own, "")}
    elif rule is None:
        return []
    else:
        asked = {
            "max_depth": (rule.max_depth, ""),
            "max_thickness": (rule.max_thickness, ""),
            "max_volume": (rule.max_volume, "^3"),
        }
    return [
        f"{name} {with_unit(number(limit), unit and unit + power)}"
        for name, (limit, power) in asked.items()
        if limit is not None
    ]


def with_titles(report: Report) -> Report:
    """The report with `name (id)` for the id of each node of a file whose name is not its id, for
    reading only."""
    shown = {
        body.id: f"{body.name} ({body.id})"
        for body in report.bodies
        if body.path is not None and body.name != body.id
    }
    if not shown:
        return report
    return replace(
        report,
        bodies=tuple(replace(body, id=shown.get(body.id, body.id)) for body in report.bodies),
        findings=tuple(
            replace(f, a=shown.get(f.a, f.a), b=shown.get(f.b, f.b)) for f in report.findings
        ),
        issues=tuple(replace(i, body=_of(shown, i.body)) for i in report.issues),
        motions=tuple(
            replace(motion, bodies=tuple(shown.get(body, body) for body in motion.bodies))
            for motion in report.motions
        ),
    )


def _of(shown: Mapping[str, str], body: str | None) -> str | None:
    return None if body is None else shown.get(body, body)


def in_one_line_each(report: Report) -> Report:
    """The report with texts that a terminal can show."""
    names = ((body.id, body.name, body.file, body.path or "") for body in report.bodies)
    if all(name.isprintable() for each in names for name in each):
        return report
    from msgspec import convert, to_builtins

    return convert(_shown(to_builtins(report)), type(report))


def _shown(value: Any) -> Any:
    if isinstance(value, str):
        return harmless(value)
    if isinstance(value, dict):
        return {key: _shown(member) for key, member in value.items()}
    return [_shown(member) for member in value] if isinstance(value, list | tuple) else value


def config_lines(reports: Iterable[Report]) -> list[str]:
    """A line for each config file that took effect."""
    stated = (report.config for report in reports)
    return list(dict.fromkeys(config_line(config) for config in stated if config is not None))


def config_line(config: StatedConfig) -> str:
    """`Options of satcheck.toml: tolerance = 0.1, fail-on = "warning"`."""
    options = (f"{name} = {toml(value)}" for name, value in config.options.items())
    return f"Options of {config.file}: {', '.join(options)}"


def toml(value: OptionValue) -> str:
    """The value as TOML writes it; JSON writes texts, numbers and lists of texts alike."""
    return json.dumps(value, ensure_ascii=False)
