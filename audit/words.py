"""Words about one thing in a report: a number, a count, a figure, a motion, a limit; and the order
of findings, the worst first. Numbers have three significant digits, and all digits before the
point; the JSON report has all of them."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_UP, Decimal
from itertools import takewhile
from math import inf
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.report.colliders import OF_COLLIDERS
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import OVERLAPS, SEVERITIES
from satcheck.report.request import OPTIONS_OF_LIMITS
from satcheck.report.verdict import severity
from satcheck.scene.units import MICROMETRES, unit_of

if TYPE_CHECKING:
    from satcheck.report.report import BodyReport, Finding, Relation, Report, RuleReport
    from satcheck.report.sweep import Joints, Place
    from satcheck.report.values import Interval

DIGITS = 3
# Between these a number is written without an exponent.
_SMALL, _LARGE = 1e-4, 1e6
# Relative. A bound this close to its rounded digits is shown as these: the last place of a float64
# computation is not worth a whole unit in the last digit.
ROUNDOFF = 1e-12
# A lower bound below this share of the upper one is left out: it tells a person nothing.
NEGLIGIBLE = 1e-3
# A line names at most so many joints.
MOST_JOINTS = 8
LONGEST_NAME = 40  # where there is little room
_MILDER: tuple[Relation, ...] = ("indeterminate", "touching", "near", "separated")


def number(value: float) -> str:
    """Rounded to nearest."""
    value += 0.0
    is_whole = 10**DIGITS - 0.5 <= abs(value) < _LARGE
    return f"{value:.0f}" if is_whole else f"{value:.{DIGITS}g}"


def stated(value: float) -> str:
    """Return a number that a person has chosen: none of the digits that he gave is lost."""
    return f"{value + 0.0:.12g}"


def bounds(low: float, high: float) -> str:
    """Return `0.504 ±0.003`: a middle and a half-width that contain the proven interval, or one
    number where the figure is exact."""
    if high - low <= EXACT_WIDTH * abs(high):
        return number(high)
    least, most = Decimal(low), Decimal(high)
    size = max(abs(low / 2 + high / 2), high / 2 - low / 2)
    last = Decimal(1).scaleb(_last_place(size))
    middle = ((least + most) / 2).quantize(last)
    half = max(middle - least, most - middle).quantize(last, ROUND_UP)
    if _SMALL <= size < _LARGE:
        return f"{middle:f} ±{half:f}"
    return f"{number(float(middle))} ±{number(float(half))}"


def _last_place(value: float) -> int:
    """Return the power of ten of the last digit that `number` shows."""
    place = math.floor(math.log10(value)) - DIGITS + 1
    return place if value >= _LARGE else min(place, 0)


def at_least(value: float) -> str:
    """A proven lower bound, rounded down (to ROUNDOFF)."""
    return _rounded(value, ROUND_FLOOR)


def at_most(value: float) -> str:
    """A proven upper bound, rounded up (to ROUNDOFF)."""
    return _rounded(value, ROUND_CEILING)


def vector(values: tuple[float, float, float]) -> str:
    """Rounded relative to the longest component: no 1e-17 beside a 1."""
    return f"({', '.join(_components(values))})"


def about(values: tuple[float, float, float] | None) -> str:
    """Return `about ` where `vector` does not show the numbers themselves, else nothing."""
    return "" if values is None or tuple(map(float, _components(values))) == values else "about "


def _components(values: tuple[float, float, float]) -> list[str]:
    longest = max(abs(value) for value in values)
    if longest == 0:
        return ["0", "0", "0"]
    return [number(round(value, -_last_place(longest))) for value in values]


def duration(microseconds: float) -> str:
    """Three significant digits, in the unit that suits."""
    for limit, unit, factor in ((1e3, "us", 1.0), (1e6, "ms", 1e-3)):
        if microseconds < limit:
            return f"{microseconds * factor:.3g} {unit}"
    return f"{microseconds * 1e-6:.3g} s"


def _rounded(value: float, outward: str) -> str:
    text = number(value)
    if abs(float(text) - value) <= ROUNDOFF * abs(value):
        return text
    last = Decimal(1).scaleb(_last_place(abs(value)))
    return number(float(Decimal(value).quantize(last, outward)))


def counted(count: int, singular: str, plural: str | None = None) -> str:
    """`1 pair`, `2 pairs`."""
    return f"{count:,} {singular if count == 1 else plural or singular + 's'}"


def interval(proven: Interval | None, *, bounded: str = "<= ") -> str:
    """A figure with its proven bounds, as one number where they are the same but for rounding;
    empty when there is none.

    bounded: what goes before a figure that has no lower bound worth showing.
    """
    if proven is None:
        return ""
    low, high = proven
    return bounded + at_most(high) if low <= NEGLIGIBLE * high < high else bounds(low, high)


def figure(proven: Interval | None, unit: str | None) -> str:
    """Return `0.504 ±0.003 mm`, `at most 0.3 mm`."""
    return with_unit(interval(proven, bounded="at most "), unit)


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


def in_motion(finding: Finding, unit: str | None, whom: str = "") -> str:
    """Return `hits at 60 deg, near (1.5, 2, 0)`, `0.25 mm apart`, `apart`, `touches`,
    `undecided from t = 0.4`; empty where neither body moves. whom: is hit."""
    swept = finding.motion
    if swept is None:
        return ""
    if swept.relation == "penetrating":
        verb = "hits" if swept.proven else "possibly hits"
        on_path = "" if swept.poses is None else between_poses(*swept.poses)
        near = "" if swept.point is None else f", near {vector(swept.point)}"
        return f"{verb}{whom} at {', '.join(place(one, unit) for one in swept.at)}{on_path}{near}"
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
    if finding.rule is None:
        return None
    named = [rule for rule in report.rules if rule.name == finding.rule]
    return named[0] if len(named) == 1 else None


def limits(finding: Finding, report: Report) -> list[str]:
    """What the pair is held against: `clearance 5 mm`; of an overlap `max_depth 1 mm`."""
    overlaps = finding.relation in OVERLAPS
    if finding.rule is None and (overlaps or report.settings.clearance is None):
        return []
    unit, rule = unit_of(report.units), rule_of(finding, report)
    if not overlaps:
        own = None if rule is None else rule.clearance
        limit = report.settings.clearance if own is None else own
        return [] if limit is None else [f"clearance {with_unit(stated(limit), unit)}"]
    if rule is not None:
        asked = {
            "max_thickness": (rule.max_thickness, ""),
            "max_depth": (rule.max_depth, ""),
            "max_volume": (rule.max_volume, "^3"),
        }
    else:
        settings, deciding = report.settings, (finding.rule or "").split(", ")
        asked = {
            key: (getattr(settings, key), "")
            for key, option in OPTIONS_OF_LIMITS.items()
            if option in deciding
        }
    return [
        f"{name} {with_unit(stated(limit), unit and unit + power)}"
        for name, (limit, power) in asked.items()
        if limit is not None
    ]


def with_titles(report: Report) -> Report:
    """Return the report with `name (id)` for the id of each node of a file whose name is not its
    id, for reading only."""
    shown = {
        body.id: f"{body.name} ({body.id})"
        for body in report.bodies
        if body.path is not None and body.name != body.id
    }
    return _renamed(report, shown)


def common_root(names: Collection[str]) -> str:
    """Return the beginning of all names, up to a `/`; "" for none."""
    ends = zip(min(names, default=""), max(names, default=""), strict=False)
    same = "".join(a for a, _ in takewhile(lambda pair: pair[0] == pair[1], ends))
    return same[: same.rfind("/") + 1]


def short_names(*ids: str) -> list[str]:
    """Return the names without the folders that all share, of a long one its end."""
    root = common_root(ids) if len(ids) > 1 else ""
    short = [id_.removeprefix(root) for id_ in ids]
    return [name if len(name) <= LONGEST_NAME else f"…{name[-LONGEST_NAME:]}" for name in short]


def without_root(report: Report, root: str) -> Report:
    """Return the report with names that do not begin with the root, for reading only."""
    names = (body.id for body in report.bodies)
    return _renamed(report, {name: name.removeprefix(root) for name in names if root})


def _renamed(report: Report, shown: Mapping[str, str]) -> Report:
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


def is_listed(finding: Finding) -> bool:
    """Whether there is something to see."""
    return finding.severity != "none" or finding.undecided is not None


def is_wrong(finding: Finding) -> bool:
    """Whether it fails, warns or is undecided."""
    return severity(finding) in ("error", "warning") or finding.undecided is not None


def worst_first(findings: Iterable[Finding]) -> list[Finding]:
    """By severity, then the thicker overlap, then the deeper one, then the earlier hit."""
    return sorted(findings, key=rank)


def rank(finding: Finding, units: str | None = None) -> tuple[float, ...]:
    """The lower the worse. units: of its lengths; unknown ones count as millimetres beside those of
    another report."""
    kind, first, second = _size(finding)
    scale = 1.0 if is_hit(finding) else MICROMETRES[unit_of(units) or "mm"]
    return (SEVERITIES.index(severity(finding)), kind, scale * first, scale * second)


def _size(finding: Finding) -> tuple[int, float, float]:
    """An overlap is no thicker than deep, so its depth stands for a thickness that is unknown. One
    without figures comes last: its boxes overlap by less than those that were measured. Bodies that
    overlap within the touch band only touch, and also have a thickness."""
    if finding.at_rest in OVERLAPS:
        deep = -inf if finding.depth is None else finding.depth
        thick = deep if finding.thickness is None else finding.thickness
        return (0, -thick, -deep)
    if is_hit(finding):
        return (1, _first_time(finding), 0.0)
    gap = inf if finding.distance is None else finding.distance
    if finding.rule in OF_COLLIDERS:
        return (-1, -gap, 0.0)
    return (2 + _MILDER.index(finding.at_rest), gap, -(finding.thickness or 0.0))


def _first_time(hit: Finding) -> float:
    impact = hit.motion and hit.motion.time_of_impact
    return impact[1] if impact else 0.0
