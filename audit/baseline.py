"""Compares findings with a baseline: which are new, unchanged or worse, and which are gone.

An unchanged finding does not fail a check. A finding is worse if its relation is graver than the
known one, or if a figure is proven to be worse. A length has to be worse by more than the precision
of the input (the default touch band of the pair). It is unchanged if no figure can be worse. An
overlap without figures may be worse: it is undecided, unless somebody accepted it without figures.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import get_args

import msgspec
from msgspec.structs import replace

from satcheck.audit.messages import with_messages
from satcheck.audit.settings import Settings
from satcheck.audit.words import counted, number, with_unit
from satcheck.core.errors import SatcheckError
from satcheck.report.baseline import (
    SCHEMA,
    Baseline,
    BaselineState,
    Figure,
    KnownFinding,
    KnownRelation,
    KnownUndecided,
    StatedBaseline,
    UndecidedBy,
)
from satcheck.report.judge import is_within, keeps
from satcheck.report.report import OVERLAPS, SEVERITIES, Finding, Issue, Report
from satcheck.report.values import Interval, Relation
from satcheck.report.verdict import fails, summarise
from satcheck.scene.access import FilesRead, Signature, files_read, followed, note, signature
from satcheck.scene.opening import exists, read_whole
from satcheck.scene.units import unit_of
from satcheck.scene.words import listed

GONE_ASSETS = "gone-assets"
# From the mildest to the gravest.
_GRAVITY: dict[KnownRelation, int] = {
    "separated": 0,
    "near": 1,
    "touching": 2,
    "penetrating": 3,
    "contains": 4,
    "inside": 4,
    "coincident": 5,
}
_FIGURES: tuple[Figure, ...] = get_args(Figure)
_OF_OVERLAPS: tuple[Figure, ...] = ("depth", "thickness", "volume")
_DEPTHS = frozenset((*_OF_OVERLAPS, "motion_depth"))
# Figures for which a smaller value is worse.
_GAPS: tuple[Figure, ...] = ("distance", "motion_distance")


def beside_baseline(
    report: Report, baseline: Baseline, file: str, assets: Sequence[str] = ("",)
) -> Report:
    """The report with the state of each failing finding, and its verdict without unchanged ones.

    file: of the baseline, to name it. assets: what the baseline may call the input of the report;
    where it knows a pair under several of these names, the first one counts.
    """
    known = {each.key: each for each in baseline.findings}
    open_for = {each.key: each.reason_code for each in baseline.undecided}
    findings = tuple(
        _with_state(_if_accepted(finding, open_for, assets), report, known, assets)
        for finding in report.findings
    )
    absent = (known for asset in assets for known in absent_from(report, baseline, asset))
    beside = replace(report, findings=findings, baseline=StatedBaseline(file, tuple(absent)))
    summary = summarise(beside)
    if report.summary.verdict == "pass":  # a baseline only excuses
        summary = replace(report.summary, accepted=summary.accepted)
    return with_messages(replace(beside, summary=summary))


def _if_accepted(
    finding: Finding,
    open_for: Mapping[tuple[str, frozenset[str]], UndecidedBy],
    assets: Sequence[str],
) -> Finding:
    """Return the finding, accepted if it is undecided for the reason that the baseline knows."""
    pair, code = frozenset((finding.a, finding.b)), finding.reason_code
    if code is None or code not in [open_for.get((asset, pair)) for asset in assets]:
        return finding
    return replace(finding, baseline_state="accepted")


def known_undecided(report: Report, asset: str = "", reason: str = "") -> list[KnownUndecided]:
    """Return the undecided pairs that a baseline can accept."""
    return [
        KnownUndecided(asset=asset, a=each.a, b=each.b, reason_code=each.reason_code, reason=reason)
        for each in report.findings
        if each.reason_code is not None
    ]


def known_findings(
    report: Report, asset: str = "", reason: str = "", *, unmeasured: bool = False
) -> list[KnownFinding]:
    """The failing findings of a report, as a baseline holds them. unmeasured: overlaps without
    figures are accepted, however deep they get."""
    return [
        KnownFinding(
            asset=asset,
            a=finding.a,
            b=finding.b,
            severity=finding.severity,
            relation=finding.relation,
            units=report.units,
            unmeasured=unmeasured and _lacks_figures(finding.relation, _bounds(finding)),
            reason=reason,
            **{name: bounds[name not in _GAPS] for name, bounds in _bounds(finding).items()},
        )
        for finding in report.findings
        if fails(finding, report.settings.fail_on)
        and finding.relation != "indeterminate"
        and finding.severity != "silenced"
        and finding.severity != "none"
    ]


def of_unknown_depth(before: Baseline, after: Baseline) -> list[KnownFinding]:
    """Return the overlaps without figures that nobody has accepted as such, and that a baseline has
    only after a change."""
    known = {each.key for each in before.findings}
    return [
        each
        for each in after.findings
        if not each.unmeasured
        and each.key not in known
        and _lacks_figures(each.relation, [f for f in _FIGURES if each.figure(f) is not None])
    ]


def _lacks_figures(relation: Relation, figures: Iterable[Figure]) -> bool:
    return relation in OVERLAPS and _DEPTHS.isdisjoint(figures)


def absent_from(report: Report, baseline: Baseline, asset: str = "") -> list[KnownFinding]:
    """Known findings of pairs that this report has checked, and that do not fail any more."""
    usable = {body.id for body in report.bodies if body.triangles is not None}
    still = {
        frozenset((finding.a, finding.b))
        for finding in report.findings
        if finding.undecided is not None or fails(finding, report.settings.fail_on)
    }
    return [
        known
        for known in baseline.findings
        if known.asset == asset
        and {known.a, known.b} <= usable
        and known.key[1] not in still
        and _would_fail(known, report)
    ]


def _would_fail(known: KnownFinding, report: Report) -> bool:
    """Return whether the settings of this report may show the finding as it is known."""
    if SEVERITIES.index(known.severity) > SEVERITIES.index(report.settings.fail_on):
        return False
    # A file without a unit has the same coordinates where rules or --units lend it one.
    if known.units not in (None, report.units) or (known.moves and not report.motions):
        return False
    if known.relation in OVERLAPS or (known.relation == "touching" and known.severity == "note"):
        return True
    gap = max(known.distance or 0.0, known.motion_distance or 0.0)
    clearances = (report.settings.clearance, *(rule.clearance for rule in report.rules))
    return any(clearance is not None and clearance > gap for clearance in clearances)


def gone_assets(baseline: Baseline, file: Path) -> Counter[str]:
    """Return the assets that are no files any more, with the number of their known findings. file:
    of the baseline."""
    known, folder = Counter(filter(None, baseline.assets)), followed(file.parent)

    def is_there(asset: str) -> bool:
        return all(exists(folder / name) for name in files_of(asset, folder))

    return Counter({asset: n for asset, n in known.items() if not is_there(asset)})


def about_gone_assets(baseline: Baseline, file: Path) -> tuple[Issue, ...]:
    """Return a note about known findings that no check can find again."""
    gone = gone_assets(baseline, file)
    if not gone:
        return ()
    are_all = gone.keys() == set(baseline.assets)
    step = "was it written in another folder?" if are_all else "satcheck baseline prune"
    assets = counted(len(gone), "asset that is", "assets that are")
    said = f"{counted(gone.total(), 'known finding')} of {assets} gone ({listed([*gone])}): {step}"
    return (Issue(GONE_ASSETS, "note", None, str(file), said),)


def measuring(settings: Settings) -> Settings:
    """Return the settings of a check beside a baseline: it compares the figures of all overlaps, as
    far as their own budgets go. The figures of a pair then depend on no other pair."""
    return replace(settings, depth=True) if settings.depth is None else settings


def updated(
    baseline: Baseline,
    findings: Iterable[KnownFinding],
    undecided: Iterable[KnownUndecided] = (),
) -> Baseline:
    """The baseline with these findings added, sorted by name. A finding that is already known keeps
    its reason and the worse of both figures; figures in other units are replaced."""
    known = {each.key: each for each in baseline.findings}
    for each in findings:
        known[each.key] = _merged(known.get(each.key), each)
    accepted = {each.key: each for each in baseline.undecided}
    accepted |= {
        each.key: each
        for each in undecided
        if each.key not in accepted or accepted[each.key].reason_code != each.reason_code
    }
    return _sorted(known.values(), accepted.values())


def _merged(old: KnownFinding | None, new: KnownFinding) -> KnownFinding:
    if old is None:
        return new
    if old.units != new.units:
        return replace(new, reason=old.reason or new.reason)
    figures: dict[str, float | None] = {}
    for name in _FIGURES:
        known = [each for each in (old.figure(name), new.figure(name)) if each is not None]
        figures[name] = (min if name in _GAPS else max)(known, default=None)
    graver = max(old, new, key=lambda each: _GRAVITY[each.relation])
    severity = min(old.severity, new.severity, key=SEVERITIES.index)
    return replace(
        old,
        relation=graver.relation,
        severity=severity,
        unmeasured=(old.unmeasured or new.unmeasured) and not any(map(figures.get, _DEPTHS)),
        reason=old.reason or new.reason,
        **figures,
    )


def pruned(
    baseline: Baseline, absent: Sequence[KnownFinding], gone: Collection[str] = ()
) -> Baseline:
    """Return the baseline without these findings, and without those of assets that are gone."""
    keys = {each.key for each in absent}
    kept = (e for e in baseline.findings if e.key not in keys and e.asset not in gone)
    return _sorted(kept, (each for each in baseline.undecided if each.asset not in gone))


def _sorted(findings: Iterable[KnownFinding], undecided: Iterable[KnownUndecided]) -> Baseline:
    def place(each: KnownFinding | KnownUndecided) -> tuple[str, str, str]:
        return each.asset, each.a, each.b

    return Baseline(
        findings=tuple(sorted(findings, key=place)), undecided=tuple(sorted(undecided, key=place))
    )


def _with_state(
    finding: Finding,
    report: Report,
    known: Mapping[tuple[str, frozenset[str]], KnownFinding],
    assets: Sequence[str],
) -> Finding:
    if not fails(finding, report.settings.fail_on):
        return finding
    pair = frozenset((finding.a, finding.b))
    before = next((known[asset, pair] for asset in assets if (asset, pair) in known), None)
    if before is None:
        return replace(finding, baseline_state="new")
    state = _compared(before, finding, report)
    if state == "worse":
        said = filter(None, [_known(before, finding.relation), finding.reason])
        finding = replace(finding, reason="; ".join(said))
    return replace(finding, baseline_state=state)


def _known(before: KnownFinding, now: Relation) -> str:
    """Return `the baseline has depth 1 mm, thickness 0.5 mm`, and the relation if it is another."""
    said: list[str] = [before.relation] if before.relation != now else []
    unit = unit_of(before.units)
    for name in _FIGURES:
        value, power = before.figure(name), "^3" if name == "volume" else ""
        if value is not None:
            figure = with_unit(number(value), unit and unit + power)
            said.append(f"{name.replace('_', ' ')} {figure}")
    return f"the baseline has {', '.join(said)}"


def _compared(before: KnownFinding, now: Finding, report: Report) -> BaselineState:
    if now.relation == "indeterminate":
        return "undecided"
    if _GRAVITY[now.relation] > _GRAVITY[before.relation]:
        return "worse"
    if before.unmeasured and now.undecided is None:
        return "accepted"
    if now.undecided is not None or before.units != report.units:
        return "undecided"
    bounds, band = _bounds(now), _band(now, report)
    figures = _figures_to_compare(before, now)
    if _lacks_figures(now.relation, figures):
        return "undecided"
    kept = [_is_no_worse(name, before.figure(name), bounds.get(name), band) for name in figures]
    return "worse" if False in kept else "undecided" if None in kept else "unchanged"


def _figures_to_compare(before: KnownFinding, now: Finding) -> list[Figure]:
    """The figures that either finding has, and the depth of a hit while moving."""
    names: set[Figure] = set()
    if now.at_rest in OVERLAPS:
        names.update(_OF_OVERLAPS)
    if now.relation in OVERLAPS:
        names.add("motion_depth")
    elif before.relation in ("separated", "near"):
        names.update(_GAPS)
    stated = {name for name in _FIGURES if before.figure(name) is not None} | _bounds(now).keys()
    if now.motion is not None and now.relation in OVERLAPS:
        stated.add("motion_depth")
    return sorted(names & stated)


def _is_no_worse(
    name: Figure, known: float | None, bounds: Interval | None, band: float
) -> bool | None:
    """None: unknown."""
    if known is None or bounds is None:
        return None
    if name in _GAPS:
        return keeps(known - band, *bounds)
    return is_within(known if name == "volume" else known + band, *bounds)


def _band(finding: Finding, report: Report) -> float:
    """The precision of the input; 0 if a user may have set another tolerance."""
    is_set = report.settings.tolerance != "input-precision"
    if is_set or any(rule.tolerance is not None for rule in report.rules):
        return 0.0
    return finding.tolerance or 0.0


def _bounds(finding: Finding) -> dict[Figure, Interval]:
    """Bounds of the figures that were computed. The error of a volume is an estimate."""
    gap, volume, error = finding.distance, finding.volume, finding.volume_error or 0.0
    worst = None if finding.motion is None else finding.motion.worst
    bounds: dict[Figure, Interval | None] = {
        "depth": finding.depth_bounds,
        "thickness": finding.thickness_bounds,
        "volume": None if volume is None else (max(volume - error, 0.0), volume + error),
        "distance": finding.distance_bounds or (None if gap is None else (gap, gap)),
        "motion_depth": None if worst is None else worst.depth,
        "motion_distance": None if worst is None else worst.distance,
    }
    return {name: interval for name, interval in bounds.items() if interval is not None}


class _Head(msgspec.Struct, frozen=True):
    schema: str


def read_baseline(path: Path) -> Baseline:
    """Raises SatcheckError: `bad-baseline`, or a code about the file."""
    if not exists(path):
        reason = "no such file: `satcheck baseline write` makes one"
        raise SatcheckError("file-not-found", reason, file=str(path))
    try:
        text = read_whole(path)
        schema = msgspec.json.decode(text, type=_Head).schema
        if schema != SCHEMA and schema.startswith(SCHEMA.rstrip("1")):
            reason = "of another version of satcheck: write it again"
            raise SatcheckError("bad-baseline", reason, file=str(path))
        return msgspec.json.decode(text, type=Baseline)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise SatcheckError("bad-baseline", f"no baseline: {error}", file=str(path)) from None


def current_baseline(path: Path) -> Baseline:
    """The same for many assets: the file is read once, and again when it has changed."""
    note(path)
    known, files = _read_once(path, signature(str(path)))
    files.note_again()
    return known


@lru_cache(maxsize=1)
def _read_once(path: Path, _: Signature) -> tuple[Baseline, FilesRead]:
    with files_read() as files:
        return read_baseline(path), files


def files_of(asset: str, folder: Path = Path()) -> list[str]:
    """The files of an asset of `satcheck batch`, which its name lists. folder: they are relative to
    it. A comma may also be part of a name: of a file that exists."""
    names = asset.split(", ")
    files, begin = list[str](), 0
    for end in range(1, len(names) + 1):
        name = ", ".join(names[begin:end])
        if exists(folder / name):
            files.append(name)
            begin = end
    return files if begin == len(names) else names


def asset_key(files: Iterable[str], baseline: Path) -> str:
    """The name of an asset in a baseline: its files, relative to the folder of the baseline, with
    `/`, so that it does not depend on where the command runs, nor on links that lead to a folder.
    """
    folder = followed(baseline.parent)
    real = (followed(Path(file).parent) / Path(file).name for file in files)
    return ", ".join(Path(os.path.relpath(file, folder)).as_posix() for file in real)


def names_in_baseline(paths: Sequence[str], baseline: Path) -> tuple[str, ...]:
    """What a baseline may call the input of a plain check: as the asset of these files that
    `satcheck batch` checks, whose bodies have the same ids, or not at all."""
    return (asset_key(paths, baseline), "")
