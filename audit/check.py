"""The check of a scene: bodies in, a report out."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import UNSET, UnsetType
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies import BodyCache, PlacedBodies, place
from satcheck.audit.checked_pairs import Progress, StepsOfScene, examine_pair, examine_pairs
from satcheck.audit.close_pairs import ClosePairs, IndexPair
from satcheck.audit.draft import Draft, indeterminate
from satcheck.audit.figures import with_figures
from satcheck.audit.finding import examine_boxes
from satcheck.audit.messages import finding_message, with_messages
from satcheck.audit.pair import Pair
from satcheck.audit.planner import Planner
from satcheck.audit.settings import LISTED_PAIRS, LISTED_UNDECIDABLE, Settings, require_settings
from satcheck.audit.summary import (
    body_reports,
    count,
    doubtful_sizes,
    effects_of,
    empty_report,
    issues_of,
    stopped_early,
    tool,
)
from satcheck.core.errors import SatcheckError
from satcheck.report.report import (
    ENOUGH_FAILURES,
    MEETINGS_OF_BODY,
    OUTSIDE_REGION,
    REGION_OPEN,
    Exempt,
    Finding,
    Issue,
    Report,
    Summary,
    all_allowed,
)
from satcheck.report.verdict import fails, summarise, truncated_of
from satcheck.scene import Scene
from satcheck.scene.files.readers import stated_options

if TYPE_CHECKING:
    from satcheck.audit.checked_pairs import CheckedPair
    from satcheck.audit.motion.sweep import Movers
    from satcheck.core.peers import Peers, VolumeMeter
    from satcheck.report.baseline import UndecidedBy
    from satcheck.report.regions import Regions
    from satcheck.report.request import Request
    from satcheck.report.statics import Statics

DEFAULT_SETTINGS = Settings()

# The most close pairs that are examined together.
BLOCK = 20_000


def check(
    scene: Scene | Sequence[str | Path],
    settings: Settings = DEFAULT_SETTINGS,
    progress: Progress | None = None,
    cache: BodyCache | None = None,
    least: int = 2,
) -> Report:
    """Check every pair of bodies that the scene does not exempt.

    scene: a loaded scene, or paths of mesh and scene files. progress(done, total) is called from
    this thread as pairs are settled. cache: data from earlier checks of the same bodies at other
    placements, with the same settings; this check adds to it. least: the least number of bodies,
    unless rules ask about single ones; a single usable body, or none, passes.

    Findings come in the order of the bodies. There is one for every pair that was neither pruned
    nor allowed, and, in a scene of few pairs, for pruned pairs too (Settings.list_pruned). Of the
    pairs whose bodies cannot be used or compared, only the first LISTED_UNDECIDABLE are listed.
    Report.truncated counts those left out.

    Raises SatcheckError: `too-few-bodies`, and for paths what `load_scene` raises. A file that
    cannot be used and a pair that fails are results, not errors.
    """
    _refuse_two(scene, settings)
    require_settings(settings)
    scene = _loaded(scene, settings)
    _require_bodies(scene, least)
    if scene.joint_path is not None:  # many poses: figures on request only
        settings = replace(settings, depth=settings.depth or False)
    bodies = place(scene, settings, cache)
    moving = bool(scene.motions) or scene.joint_path is not None
    planner = Planner(settings, bodies.book, scene.composed, moving=moving)
    movers = None
    if moving:
        from satcheck.audit.motion.sweep import Movers

        movers = Movers(scene, bodies, planner)
    close = ClosePairs(bodies, planner) if movers is None else movers.close()
    pairs, examined, unexamined = _examined(
        bodies, close, planner, movers, progress, keep=cache is not None
    )
    if any(pair.draft is not None for pair in examined):
        examined = with_figures(examined, settings, keep=cache is not None)
    return _report(scene, bodies, planner, movers, pairs, examined, unexamined)


def described(scene: Scene, settings: Settings, cache: BodyCache) -> Report:
    """Return the report of a check of bodies at rest, without their pairs."""
    require_settings(settings)
    scene = _loaded(scene, settings)
    _require_bodies(scene, 2)
    bodies = place(scene, settings, cache)
    return _report(scene, bodies, Planner(settings, bodies.book, scene.composed), None, [], [], 0)


def check_meshes_of(scene: Scene, settings: Settings) -> Finding:
    """Return the finding of the only pair of a scene of two meshes in memory, as `check` reports
    it. No other part of a report is made."""
    scene = _loaded(scene, settings)
    bodies = place(scene, settings)
    planner = Planner(settings, bodies.book)
    finding = None
    if len(bodies.placed) == 2:
        a, b = bodies.placed.values()
        limit = planner.gap_limit(0, 1, a.resolution + b.resolution)
        if core.box_gap(a.bounds, b.bounds) <= limit:
            request = planner.request(0, 1)
            with ExitStack() as stack:
                tools = _tools(stack, settings, [request])
                pair = Pair(a, b, settings, request, *tools, alone=True)
                finding = examine_pair(pair).finding
    if finding is None:
        (finding,) = _findings(bodies, [], [], planner)
    return replace(finding, message=finding_message(finding, empty_report(settings)))


def _require_bodies(scene: Scene, least: int) -> None:
    if scene.asks_for_support or scene.asks_for_regions:
        least = 1
    if len(scene.bodies) + len(scene.unreadable) < least:
        few = "one body" if least == 1 else "two bodies"
        errors = [each for each in scene.issues if each.severity == "error"]
        why = f"; {errors[0].message}" if errors else ""
        raise SatcheckError("too-few-bodies", f"a check needs {few} at least{why}")


def _report(
    scene: Scene,
    bodies: PlacedBodies,
    planner: Planner,
    movers: Movers | None,
    pairs: list[IndexPair],
    examined: list[CheckedPair],
    unexamined: int,
) -> Report:
    """Return the report of a scene. pairs: the close pairs; unexamined: the number of others."""
    settings = planner.settings
    findings = _findings(bodies, pairs, examined, planner)
    counts = count(bodies, [pair.finding for pair in examined], findings, unexamined)
    pose = scene.posture.pose() if scene.posture else None
    allowed = all_allowed(counts, bodies.book.rules, pose)
    statics, support_issues = _support(scene, bodies, settings)
    regions, region_issues = _regions(scene, bodies, settings)
    of_pairs = [
        *doubtful_sizes(bodies, findings, settings.planar),
        *(() if movers is None else movers.issues()),
        *support_issues,
        *region_issues,
        *(issue for pair in examined for issue in pair.issues),
        *stopped_early(unexamined),
    ]
    report = Report(
        tool=tool(),
        units=scene.units,
        settings=planner.stated(),
        summary=Summary("incomplete", counts, {}),  # what follows from the rest is not known yet
        reading=stated_options(scene.reading, {body.file.format for body in scene.bodies}),
        bodies=body_reports(bodies),
        exempt=Exempt(tuple(sorted(scene.ignore_within_groups)), not scene.check_static),
        rules=bodies.book.rules,
        effects=effects_of(
            planner,
            ((planner.request(*k), pair.finding) for k, pair in zip(pairs, examined, strict=True)),
            counts,
            units_unknown=bodies.several_units_count,
        ),
        motions=() if movers is None else movers.stated(),
        pose=pose,
        findings=tuple(findings),
        issues=issues_of(scene, bodies, counts, allowed, of_pairs, settings.accept),
        truncated=truncated_of(counts, findings),
        statics=statics,
        regions=regions,
    )
    return with_messages(replace(report, summary=summarise(report)))


def _refuse_two(first: object, second: object) -> None:
    """Refuse two paths or two meshes, each an argument of its own."""
    if isinstance(first, str | Path) and isinstance(second, str | Path):
        message = f"paths go in one list: satcheck.check([{str(first)!r}, {str(second)!r}])"
        raise SatcheckError("bad-argument", message)
    if hasattr(first, "vertices") and hasattr(second, "vertices"):
        raise SatcheckError("bad-argument", "satcheck.check_meshes takes two meshes")


def _loaded(scene: Scene | Sequence[str | Path], settings: Settings) -> Scene:
    if isinstance(scene, Sequence):
        from satcheck.scene import load_scene

        scene = load_scene(
            scene,
            seconds_per_file=settings.seconds_per_file,
            megabytes_per_file=settings.megabytes_per_file,
        )
    if not isinstance(scene, Scene):
        kind = type(scene).__name__
        message = f"scene: a satcheck scene, or a list of paths, got {kind}"
        hint = "satcheck.scene_of_meshes makes a scene of a trimesh.Scene, or of meshes by name"
        raise SatcheckError("bad-argument", f"{message}: {hint}")
    scene = scene.reaching()
    if settings.planar is None:
        scene.require_in_space("add --planar xy")
        return scene
    from satcheck.scene.planar.flat_scene import flat_scene

    return flat_scene(scene, settings.planar, allow_open=settings.allow_open)


def _support(
    scene: Scene, bodies: PlacedBodies, settings: Settings
) -> tuple[Statics | UnsetType, list[Issue]]:
    """Return UNSET if no rule asks about support. Raises SatcheckError if the question cannot be
    answered at all."""
    if not scene.asks_for_support:
        return UNSET, []
    from satcheck.audit.statics.support import Support

    support = Support(scene, bodies, settings)
    statics = support.stated()
    return statics, list(support.issues(scene, statics))


def _regions(
    scene: Scene, bodies: PlacedBodies, settings: Settings
) -> tuple[Regions | UnsetType, list[Issue]]:
    """Return UNSET if no rule asks whether a body lies in a region."""
    if not scene.asks_for_regions:
        return UNSET, []
    from satcheck.audit.regions import regions_of
    from satcheck.audit.statics.answers import issues_of

    regions = regions_of(scene, bodies, settings)
    return regions, issues_of(regions.findings, OUTSIDE_REGION, REGION_OPEN)


def _examined(
    bodies: PlacedBodies,
    close: ClosePairs,
    planner: Planner,
    movers: Movers | None,
    progress: Progress | None,
    *,
    keep: bool,
) -> tuple[list[IndexPair], list[CheckedPair], int]:
    """Return close pairs, up to the block in which as many fail, or meet, as may in a scene; what
    is found of each; and the number of close pairs after them. A pair for which the steps of the
    scene do not suffice counts as a failure. keep: later checks need the data of the bodies."""
    pairs: list[IndexPair] = []
    examined: list[CheckedPair] = []
    failures = meetings = 0
    most_meetings = ENOUGH_FAILURES + MEETINGS_OF_BODY * len(bodies.ids)
    budget, blocks = StepsOfScene(), close.blocks(BLOCK)
    block, after = next(blocks, []), next(blocks, [])
    total = close.count() if after and progress is not None else len(block)
    while block and failures < ENOUGH_FAILURES and meetings < most_meetings:
        told = None if progress is None else _counting_on(progress, len(pairs), total)
        kept = keep or bool(after)
        found = _examined_together(bodies, block, planner, movers, told, budget, keep=kept)
        pairs += block
        examined += found
        fail_on = planner.settings.fail_on
        failures += sum(
            fails(pair.finding, fail_on)
            or (pair.wants_more and pair.finding.relation == "indeterminate")
            for pair in found
        )
        meetings += sum(pair.finding.relation not in ("separated", "near") for pair in found)
        if after and not keep:
            for i in {i for i, _ in block} - {after[0][0]}:
                bodies.placed[i].release()
        block, after = after, next(blocks, [])
    return pairs, examined, close.count() - len(examined) if block else 0


def _counting_on(progress: Progress, before: int, total: int) -> Progress:
    """Return what tells the progress of a block after so many pairs of a scene."""
    return lambda done, _: progress(before + done, total)


def _examined_together(
    bodies: PlacedBodies,
    close: list[IndexPair],
    planner: Planner,
    movers: Movers | None,
    progress: Progress | None,
    budget: StepsOfScene,
    *,
    keep: bool,
) -> list[CheckedPair]:
    settings = planner.settings
    requests = [planner.request(i, j) for i, j in close]
    with ExitStack() as stack:
        tools = _tools(stack, settings, requests)
        alone = len(close) == 1 and not keep
        pairs = [
            Pair(bodies.placed[i], bodies.placed[j], settings, request, *tools, alone=alone)
            for (i, j), request in zip(close, requests, strict=True)
        ]
        if movers is not None:
            movers.add_sweeps(pairs)
        return examine_pairs(pairs, settings.jobs, progress, budget=budget, keep=keep)


def _tools(
    stack: ExitStack, settings: Settings, requests: Sequence[Request]
) -> tuple[VolumeMeter | None, Peers | None]:
    """Return the other libraries that pairs with these requests need, until the stack closes."""
    meter = peers = None
    if any(request.wants("volume") for request in requests):
        meter = stack.enter_context(volume_meter(settings))
    if settings.cross_check:
        from satcheck.core.peers import Peers

        seconds, megabytes = settings.cross_check_seconds, settings.cross_check_megabytes
        peers = stack.enter_context(Peers(seconds=seconds, megabytes=megabytes))
    return meter, peers


def volume_meter(settings: Settings) -> VolumeMeter:
    from satcheck.core.peers import VolumeMeter

    return VolumeMeter(seconds=settings.volume_seconds, megabytes=settings.volume_megabytes)


def _findings(
    bodies: PlacedBodies,
    close: list[IndexPair],
    examined: list[CheckedPair],
    planner: Planner,
) -> list[Finding]:
    """Return the findings to list: of close pairs, of pairs that nothing decides, and, in a scene
    of few pairs, of those that are apart by their boxes."""
    findings = {pair: checked.finding for pair, checked in zip(close, examined, strict=True)}
    settings = planner.settings
    listed = settings.list_pruned
    total, allowed = (0, 0) if listed is False else bodies.book.count()
    if listed is None:
        listed = total - allowed <= LISTED_PAIRS
    most = None if listed else LISTED_UNDECIDABLE
    for i, j, reason in islice(bodies.undecidable_pairs(), most):
        usable = i in bodies.placed and j in bodies.placed
        code: UndecidedBy | None = None
        if usable and not bodies.is_comparable(i, j):
            code = "units-unknown"
        findings[i, j] = indeterminate(bodies.ids[i], bodies.ids[j], reason, reason_code=code)
    if listed and len(findings) < total - allowed:
        for i, j in bodies.book.checked_pairs():
            if (i, j) not in findings:
                request = planner.request(i, j)
                draft = Draft(Pair(bodies.placed[i], bodies.placed[j], settings, request))
                findings[i, j] = examine_boxes(draft)
                if settings.certificate:
                    from satcheck.audit.stages.certificate import with_certificate

                    findings[i, j] = with_certificate(findings[i, j], draft)
    return [findings[pair] for pair in sorted(findings)]
