"""The answers of a report to rules about single bodies, and whether bodies lie in their regions,
checked in exact arithmetic.

In a convex region a body lies if no point of it is farther beyond a face than the tolerance. In
another region it lies if a shift by at most the tolerance brings all of it into the region, and it
does not if one of its points is outside and farther than the tolerance from the surface.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache, partial
from typing import Any

from satcheck.report.regions import InsideFinding, Regions
from satcheck.report.report import BodyAnswer
from satcheck.report.statics import BodyRuleReport
from satcheck.report.verdict import severity_of_answer
from satcheck.report.verification import CheckedSupport, Outcome
from satcheck.scene.rules import Selector
from satcheck.scene.statics import KEYS, BodyRule, BodyTerms, terms_of
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import (
    NotCertified,
    Rejected,
    dot,
    point,
    sign_of,
)
from satcheck.verify.pairs import on_body, pair_of, vector
from satcheck.verify.relations import check_within
from satcheck.verify.surfaces import comes_within
from satcheck.verify.world import Exact, World


def body_terms(
    rules: Sequence[BodyRuleReport], bodies: Mapping[str, Placed]
) -> dict[str, BodyTerms]:
    """Return what the rules say about each body of the report, by id."""
    of_scene = [
        BodyRule(
            bodies=Selector(rule.bodies),
            **{key: getattr(rule, key) for key in (*KEYS, "reason", "where")},
        )
        for rule in rules
    ]
    return dict(zip(bodies, terms_of(list(bodies.values()), of_scene), strict=True))


def once(check: Callable[..., None]) -> Callable[..., None]:
    """A check that several answers share: for each of its arguments it is made once."""

    @cache
    def refusal(*of: Any) -> Rejected | NotCertified | None:
        try:
            check(*of)
        except (Rejected, NotCertified) as why:
            return why
        return None

    def again(*of: Any) -> None:
        why = refusal(*of)
        if why is not None:
            raise type(why)(str(why))

    return again


def checked(
    finding: BodyAnswer,
    key: str,
    own: BodyTerms,
    check: Callable[[], None],
    is_doubted: Callable[[], bool] = lambda: False,
) -> CheckedSupport:
    """Return what a check says of an answer. key: of the rules that ask. own: what the rules say
    about the body. is_doubted: whether the answer comes with a warning that does not follow from
    them."""
    outcome: Outcome = "open" if finding.answer == "open" else "accepted"
    reason = finding.reason if outcome == "open" else None
    try:
        if finding.rule != own.rules[key].name:
            raise Rejected("another rule asks this")
        follows = severity_of_answer(finding.answer, own.value("severity"))
        if not is_doubted() and finding.severity != follows:
            raise Rejected("the severity does not follow from the answer and the rules")
        check()
    except NotCertified as why:
        outcome, reason = "not certified", str(why)
    except Rejected as why:
        outcome, reason = "rejected", str(why)
    return CheckedSupport(finding.body, finding.question, finding.answer, outcome, reason)


def judged(regions: Regions, bodies: Mapping[str, Placed]) -> Iterator[CheckedSupport]:
    """Each answer, in the order of the report. Rejects a list of other questions than those that
    the rules ask."""
    terms = body_terms(regions.rules, bodies)
    asked = [(id_, own.region_for(id_)) for id_, own in terms.items()]
    stated = [(finding.body, finding.region) for finding in regions.findings]
    if stated != [(id_, region) for id_, region in asked if region is not None]:
        raise Rejected("the questions about regions are not those that rules ask")
    for finding in regions.findings:
        body, region = bodies[finding.body], bodies[finding.region]
        check = partial(check_answer, finding, body, region, regions.tolerance)
        yield checked(finding, "inside", terms[finding.body], check)


def check_answer(finding: InsideFinding, body: Placed, region: Placed, tolerance: float) -> None:
    """Rejects a yes or a no that is not proven by what the finding states."""
    if finding.answer == "open":
        _check_form(finding, convex=False)
        return
    if region.world is None or not region.world.solid or region.holed:
        raise Rejected("a region is a closed mesh")
    _check_form(finding, convex=region.convex)
    if region.convex:
        if (finding.answer == "yes") is _is_beyond(body, region.world, tolerance):
            raise Rejected("how far the body lies beyond the faces contradicts the answer")
        if finding.sticks_out and not _is_beyond(body, region.world, finding.sticks_out):
            raise Rejected("the body does not stick out as far as that")
        return
    if body.world is None:
        raise NotCertified("a curved shape in a region that is not convex")
    if finding.answer == "no":
        _check_point(finding, body.world, region.world, tolerance)
    elif body.holed:
        raise NotCertified("a mesh with holes in a region that is not convex")
    else:
        move = vector(finding.shift or ())
        if dot(move, move) > Fraction(tolerance) ** 2:
            raise Rejected("the shift is longer than the tolerance")
        moved = body.moved([float(c) for c in move])
        check_within(pair_of(moved, region, moved.mesh, region.mesh))


def _check_form(finding: InsideFinding, *, convex: bool) -> None:
    """Rejects figures and evidence that do not belong to the answer."""
    is_no, is_yes = finding.answer == "no", finding.answer == "yes"
    expected = {
        "sticks_out": is_no,
        "shift": is_yes and not convex,
        "point": is_no and not convex,
    }
    for name, wanted in expected.items():
        if (getattr(finding, name) is not None) != wanted:
            raise Rejected(f"{name} {'is missing' if wanted else 'does not belong to the answer'}")


def _is_beyond(body: Placed, region: World, limit: float) -> bool:
    """Return whether a point of the body lies farther beyond a face of the convex region than the
    limit, or as far and the limit is not 0."""
    faces, shape = Exact(region, region.lattice), body.exact
    for n, height in faces.planes():
        far, level = shape.reach(point(n)), Fraction(height, faces.scale)
        if sign_of(far.q - level, [Fraction(limit) ** 2 * dot(n, n)], [far.p]) > 0:
            return True
    return False


def _check_point(finding: InsideFinding, body: World, region: World, tolerance: float) -> None:
    assert finding.point is not None
    k = max(body.lattice, region.lattice)
    p, surface = on_body(finding.point, Exact(body, k), of_hull=False), Exact(region, k)
    if surface.winding(p) != 0:
        raise Rejected("the point is not outside of the region")
    furthest = max(tolerance, finding.sticks_out or 0.0)
    if comes_within(surface, p, Fraction(furthest), open_=True):
        raise Rejected("the point is closer to the region than claimed")
