"""How faithful the colliders of links are to what is drawn: how far they stick out of it, how far
they fall short of it, and which openings they close.

The same files are read twice, for visual and for collision geometry. What moves together is
compared: the bodies of a link, or of the smallest node that has both below.

The core bounds how far one surface reaches out of the union of others (`deviation`). Curved
shapes are replaced by meshes within them, and the bounds are widened by their sag. An open mesh has
some unknown fill. So the lower bound is that of the mesh with every fill, and the upper one that of
its surface alone.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from itertools import accumulate, chain
from typing import NamedTuple

import numpy as np
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies import PlacedBodies, UnusableBody, place
from satcheck.audit.body import PlacedBody
from satcheck.audit.check import check
from satcheck.audit.checked_pairs import Progress
from satcheck.audit.openings import SMALLEST, largest_opening
from satcheck.audit.settings import Settings
from satcheck.audit.summary import issues_of_input, tool
from satcheck.audit.words import counted, is_wrong, number, with_unit, worst_first
from satcheck.core import Mesh, Surface
from satcheck.core.errors import SatcheckError
from satcheck.core.mesh_arrays import joined
from satcheck.core.shape_mesh import mesh_of, sag_of
from satcheck.core.shapes import is_curved
from satcheck.core.steps import step
from satcheck.report.colliders import (
    OF_COLLIDERS,
    ColliderLimits,
    ColliderPart,
    CollidersReport,
    Farthest,
    Opening,
    Reach,
)
from satcheck.report.report import NOTHING_TO_CHECK, Issue, Report
from satcheck.report.values import Verdict
from satcheck.report.verdict import summarise
from satcheck.scene import Scene
from satcheck.scene.units import unit_of

# The width of an interval: as a share of its lower end, or of the size of the link.
RATIO = 0.01
FINEST = 1e-5
# Steps of a search, and of all searches, each about a nanosecond; and the searches for a link.
STEPS, STEPS_OF_ALL = 4_000_000_000, 60_000_000_000
SEARCHES = 4
# Points on the circles of curved shapes; more if their sag makes the interval wide.
SEGMENTS = (64, 128, 256)
VERDICTS: tuple[Verdict, ...] = ("fail", "incomplete", "pass")
_SPENT = "the steps of the search are spent"
_HOLES = "what fills the holes of a mesh decides"
_FACETS = "facets replace curved shapes"
_NO_END = "a half space has no end"


class _Kinds(NamedTuple):
    """Of one link."""

    visuals: list[PlacedBody | UnusableBody]
    colliders: list[PlacedBody | UnusableBody]


def compare(
    visual: Scene,
    collision: Scene,
    limits: ColliderLimits,
    settings: Settings,
    progress: Progress | None = None,
) -> tuple[CollidersReport, Report]:
    """Return how faithful the colliders are, and the check of them at rest. The scenes are those of
    the same files for both geometries. Raises SatcheckError: `units-unknown`, and for several
    robots."""
    for scene in (visual, collision):
        scene.require_one_unit()
        if len(scene.robots) > 1:
            raise SatcheckError("bad-argument", "colliders compares the links of one robot")
    groups, parts = grouped(place(visual, Settings()), place(collision, Settings())), []
    steps = min(STEPS, STEPS_OF_ALL // (SEARCHES * max(len(groups), 1)))
    for k, (name, kinds) in enumerate(groups.items()):
        if progress is not None:
            progress(k, len(groups))
        with step(f"comparing {name}, {k + 1} of {len(groups)}"):
            parts.append(_part(name, kinds, limits, steps))
    checked = _with_no_pairs_needed(check(collision, settings, least=0))
    told = {(issue.code, issue.file, issue.message) for issue in checked.issues}
    issues = [
        issue
        for issue in issues_of_input(visual, settings.accept)
        if issue.severity != "note" and (issue.code, issue.file, issue.message) not in told
    ]
    if not any(map(_has_both, parts)):
        why = "no link has both visual and collision geometry: nothing was compared"
        issues.append(Issue("not-measured", "warning", None, None, why, state="blocking"))
    checked = replace(checked, issues=(*checked.issues, *issues))
    verdicts = [checked.summary.verdict, *(part.verdict for part in parts if part.verdict)]
    if any(issue.state == "blocking" for issue in issues):
        verdicts.append("incomplete")
    verdict = min(verdicts, key=VERDICTS.index)
    report = CollidersReport(
        tool=tool(),
        units=visual.units,
        settings=limits,
        verdict=verdict,
        message="",
        parts=tuple(sorted(parts, key=_rank)),
        pairs=checked.summary.pairs,
        overlaps=tuple(worst_first(filter(is_wrong, checked.findings))),
        issues=checked.issues,
    )
    message = _message(report)
    summary = replace(checked.summary, verdict=verdict)
    return replace(report, message=message), replace(checked, summary=summary, message=message)


def _with_no_pairs_needed(checked: Report) -> Report:
    """The check, which passes also if all colliders are in one link, or may touch."""
    issues = tuple(issue for issue in checked.issues if issue.code != NOTHING_TO_CHECK)
    checked = replace(checked, issues=issues)
    summary = summarise(checked)
    if not (summary.pairs.asked or any(issue.state == "blocking" for issue in issues)):
        summary = replace(summary, verdict="pass")
    return replace(checked, summary=summary)


def _has_both(part: ColliderPart) -> bool:
    return bool(part.visuals and part.colliders)


def _message(report: CollidersReport) -> str:
    wrong = sum(part.verdict in ("fail", "incomplete") for part in report.parts)
    links, pairs = counted(len(report.parts), "link"), counted(len(report.overlaps), "pair")
    said = f"{wrong} of {links} and {pairs} of colliders fail or are undecided"
    if not (wrong or report.overlaps):
        stated = {"--max-out": report.settings.max_out, "--max-short": report.settings.max_short}
        kept = [
            f"{name} {with_unit(number(most), unit_of(report.units))}"
            for name, most in stated.items()
            if most is not None
        ]
        limits = f"all links keep {' and '.join(kept)}, and " if kept else ""
        said = f"{limits}no colliders overlap"
    if bare := sum(not _has_both(part) for part in report.parts):
        said += f"; {counted(bare, 'link has', 'links have')} only one kind of geometry"
    return f"{report.verdict.upper()}: {said}."


def grouped(drawn: PlacedBodies, solid: PlacedBodies) -> dict[str, _Kinds]:
    """What moves together, by name: the bodies of a link. Others are put together by their paths,
    from the innermost node outward: what is left at and below a node that is a body, or has no such
    group below, if it has both kinds. What is left at the end stays alone."""
    groups: defaultdict[str, _Kinds] = defaultdict(lambda: _Kinds([], []))
    left: defaultdict[str, _Kinds] = defaultdict(lambda: _Kinds([], []))
    for kind, bodies in enumerate((drawn, solid)):
        for index in range(len(bodies.ids)):
            member = bodies.placed.get(index) or bodies.unusable[index]
            link = member.body.link
            (left[member.id] if link is None else groups[link])[kind].append(member)
    paths, around = set(left), set[str]()  # nodes that are bodies, and that a group lies below
    nodes = {node for path in paths for node in accumulate(path.split("/"), "{}/{}".format)}
    for node in sorted(nodes, key=lambda node: (-node.count("/"), node)):
        kinds, parent = left.pop(node, _Kinds([], [])), node.rpartition("/")[0]
        is_group = all(kinds) and (node in paths or node not in around)
        if is_group or node in around:
            around.add(parent)
        for kind, members in enumerate(kinds):
            (groups[node] if is_group else left[parent])[kind].extend(members)
    for kind, members in enumerate(left[""]):
        for member in members:
            groups[member.id][kind].append(member)
    return groups


def _rank(part: ColliderPart) -> tuple[float, ...]:
    reaches = [reach.bounds[1] for reach in (part.out, part.short) if reach is not None]
    return VERDICTS.index(part.verdict or "pass"), -max(reaches, default=0.0), not reaches


def _part(name: str, kinds: _Kinds, limits: ColliderLimits, steps: int) -> ColliderPart:
    drawn, solid = (tuple(member.id for member in own) for own in kinds)
    part = ColliderPart(name=name, visuals=drawn, colliders=solid)
    lost = [each for each in chain(*kinds) if isinstance(each, UnusableBody)]
    if lost:
        reason = f"{lost[0].id} cannot be used: {lost[0].reason}"
        return replace(part, verdict="incomplete", reason=reason)
    visuals, colliders = ([b for b in own if isinstance(b, PlacedBody)] for own in kinds)
    if not colliders:
        fails = limits.max_short is not None
        return replace(part, verdict="fail" if fails else None, reason="no collider")
    if not visuals:
        is_open = limits.max_out is not None
        return replace(part, verdict="incomplete" if is_open else None, reason="no visual geometry")
    if any(body.endless for body in chain(visuals, colliders)):
        return _judged(part, limits)
    notes = [f"visual {b.id} is open: only its surface is drawn" for b in visuals if not b.solid]
    same = set(map(_key, visuals))  # with the same fill
    fills = [body for body in colliders if not body.solid and _key(body) not in same]
    notes += [f"collider {body.id} is open: any fill of it counts" for body in fills]
    out = _reach(colliders, visuals, steps)
    if out.bounds[1] > 0.0 and all(body.solid for body in visuals):
        part = replace(part, opening=_opening(visuals, colliders, out, steps / STEPS))
    if fills:
        out = _with_any_fill(out, fills, visuals, steps)
    short = _reach(visuals, colliders, steps)
    return _judged(replace(part, out=out, short=short, notes=tuple(notes)), limits)


def _with_any_fill(
    out: Reach, fills: Sequence[PlacedBody], visuals: Sequence[PlacedBody], steps: int
) -> Reach:
    """The reach of open colliders, whatever fills them: within their hulls."""
    hulls = [body.mesh.convex_hull().to_mesh() for body in fills]
    most = max(_measured(hull, 0.0, visuals, SEGMENTS[0], steps).bounds[1] for hull in hulls)
    if most <= out.bounds[1]:
        return out
    return replace(out, bounds=(out.bounds[0], most), reason=_HOLES)


def _judged(part: ColliderPart, limits: ColliderLimits) -> ColliderPart:
    """Only a proven bound decides."""
    beyond, reason = [], None
    if part.out is None or part.short is None:
        reason = _NO_END
    verdict: Verdict = "pass"
    for rule, reach, limit in part.reaches(limits):
        if limit is None or (reach is not None and reach.bounds[1] <= limit):
            continue
        if reach is not None and reach.bounds[0] > limit:
            beyond.append(OF_COLLIDERS[rule])
            continue
        verdict = "incomplete"
        why = _NO_END if reach is None else reach.reason or "the limit is within the bounds"
        reason = f"it is open whether it {OF_COLLIDERS[rule]} by more than the limit: {why}"
    if beyond:
        verdict, reason = "fail", f"it {' and '.join(beyond)} by more than the limit"
    return replace(part, verdict=verdict, reason=reason)


def _opening(
    visuals: Sequence[PlacedBody], colliders: Sequence[PlacedBody], out: Reach, share: float
) -> Opening | None:
    """A ball that passes is no wider than the colliders stick out, on both sides of its line."""
    mesh, sag = _joined(visuals, SEGMENTS[0])
    low, high = map(np.array, mesh.bounds)
    if out.bounds[1] < SMALLEST * float(np.linalg.norm(high - low)):
        return None
    within = [b for b in colliders if b.solid and not b.surface_tolerance]
    return largest_opening(mesh, sag, [_surface(body, SEGMENTS[0]) for body in within], share)


def _reach(sources: Sequence[PlacedBody], targets: Sequence[PlacedBody], steps: int) -> Reach:
    """How far the surfaces of the sources reach out of the union of the targets."""
    same = {_key(body) for body in targets}
    others = [body for body in sources if _key(body) not in same]
    if not others:
        return Reach(bounds=(0.0, 0.0))
    for segments in SEGMENTS:
        reach = _measured(*_joined(others, segments), targets, segments, steps)
        if reach.reason != _FACETS:
            break
    if (at := reach.farthest) is None:
        return reach
    own = min(others, key=lambda body: body.surface().nearest(at.point)[0])
    return replace(reach, farthest=replace(at, body=own.id))


def _measured(
    mesh: Mesh, sag: float, targets: Sequence[PlacedBody], segments: int, steps: int
) -> Reach:
    """The reach of a mesh, whose true surface may be off by `sag`; the body of `farthest` is not
    known here."""
    surfaces = [_surface(body, segments) for body in targets]
    low, high = map(np.array, mesh.bounds)
    finest = FINEST * float(np.linalg.norm(high - low))
    lower, upper, point, narrow = core.deviation(mesh, surfaces, finest, RATIO, steps)
    reason = None if narrow else _SPENT
    if not all(surface.solid for surface in surfaces):
        closed = (s.closed() if not s.solid else (s, []) for s in surfaces)
        filled = [each for surface, hulls in closed for each in (surface, *hulls)]
        lower, _, point, narrow = core.deviation(mesh, filled, finest, RATIO, steps)
        reason = reason if lower >= (1 - 2 * RATIO) * upper - finest else _HOLES
    widening = sag + max(_sag(body, segments) for body in targets)
    if widening > RATIO / 2 * lower:
        reason = reason or _FACETS
    # Facets lie within a curved shape, and a surface tolerance goes both ways.
    off = max(body.surface_tolerance for body in targets)
    bounds = max(lower - widening, 0.0), upper + sag + off
    if bounds[0] == 0.0:
        return Reach(bounds=bounds, reason=reason)
    other = min(targets, key=lambda body: body.surface().nearest(point)[0])
    farthest = Farthest("", point, other.id, other.surface().nearest(point)[1])
    return Reach(bounds=bounds, farthest=farthest, reason=reason)


def _key(body: PlacedBody) -> tuple[object, ...]:
    """The same for the same geometry in the same place."""
    own = body.body
    return own.transform, own.shape or (own.file.mesh.to_bytes(), own.open)


def _sag(body: PlacedBody, segments: int) -> float:
    """How far the true surface may be off the mesh."""
    shape = body.body.shape
    sag = sag_of(shape, segments) * body.largest_stretch if is_curved(shape) else 0.0
    return sag + body.surface_tolerance


def _surface(body: PlacedBody, segments: int) -> Surface:
    """In the world."""
    if not is_curved(body.body.shape):
        return body.surface()
    return Surface(_mesh(body, segments), True)


def _mesh(body: PlacedBody, segments: int) -> Mesh:
    shape, transform = body.body.shape, body.body.transform
    if not is_curved(shape):
        return body.mesh
    mesh = mesh_of(shape, segments)
    return mesh if transform is None else mesh.transformed(transform)


def _joined(bodies: Sequence[PlacedBody], segments: int) -> tuple[Mesh, float]:
    """One mesh of all, and how far the true surface may be off it."""
    return joined(_mesh(b, segments) for b in bodies), max(_sag(b, segments) for b in bodies)
