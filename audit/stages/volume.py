"""The stage `volume`: the common volume of two solids. It runs only on request."""

from __future__ import annotations

import math

from satcheck.audit.body import PlacedBody
from satcheck.audit.draft import CommonVolume, Trace, Verdict
from satcheck.audit.pair import Pair
from satcheck.core.errors import SatcheckError
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.report.judge import is_within

# The signed volume of a mesh is a sum of determinants from one of its corners: six products of box
# edges with 9 roundings each, as much again for the sum, divided by six. So the error for each
# triangle is this number of roundoffs of the volume of the box.
VOLUME_ROUNDOFFS = 18


NOTHING = CommonVolume(0.0, 0.0)


def common_volume(pair: Pair, verdict: Verdict, trace: Trace) -> CommonVolume:
    """Of the exact relation, whatever the touch band: a relation that says it all costs nothing."""
    nothing = verdict.proven and verdict.relation in ("separated", "touching")
    if nothing and (pair.both_solid or verdict.gap_lower > 0):
        return NOTHING
    if not pair.may("exact"):
        refusal = f"found on triangles: not at --accuracy {pair.settings.accuracy}"
        trace.record("volume", "not measured", refusal)
        return CommonVolume(refusal=f"no volume: {refusal}")
    try:
        for body in (pair.a, pair.b):
            _require_measurable(body)
        return _measured(pair, verdict, trace)
    except SatcheckError as refused:
        trace.record("volume", "refused", refused.message)
        where = "" if refused.body else f"{pair.a.id} and {pair.b.id}: "
        trace.complain(refused.code, refused.body, where + refused.message)
        return CommonVolume(refusal=f"no volume: {refused}")


def _require_measurable(body: PlacedBody) -> None:
    if not body.solid:
        raise SatcheckError("volume-of-no-solid", "is no solid and has no volume", body=body.id)
    if not body.shared.covers_once():
        raise SatcheckError(
            "volume-of-self-overlap",
            "may overlap itself, so that its volume is not that of its mesh",
            body=body.id,
        )


def _measured(pair: Pair, verdict: Verdict, trace: Trace) -> CommonVolume:
    estimate = _estimated(pair, verdict, trace)
    limit, (least, greatest) = pair.request.max_volume, estimate.bounds
    if limit is None or least is None or greatest is None:
        return estimate
    if is_within(limit, least, greatest) is not None:
        return estimate
    return _exact(pair, trace) or estimate


def _estimated(pair: Pair, verdict: Verdict, trace: Trace) -> CommonVolume:
    inner = {"contains": pair.b, "inside": pair.a, "coincident": pair.a}.get(verdict.relation)
    if inner is not None:
        volume = _own_volume(inner)
        trace.record("volume", "of the mesh", f"{inner.id} lies within the other")
        return volume
    assert pair.meter is not None
    common = pair.meter.measure(pair.a.mesh, pair.b.mesh)
    detail = f"by manifold3d in a child process, off by about {common.error:.1g} at most"
    trace.record("volume", "measured", detail)
    return CommonVolume(max(common.volume, 0.0), common.error)


def _exact(pair: Pair, trace: Trace) -> CommonVolume | None:
    """Where an estimate leaves a limit open. None where that is too much work."""
    from satcheck.core.exact_volume import exact_common_volume

    exact = exact_common_volume(pair.a.mesh, pair.b.mesh)
    if exact is None:
        trace.record("volume", "no answer", "too many triangles for rational numbers")
        return None
    trace.record("volume", "exact", "in rational numbers, as the estimate leaves the limit open")
    volume = float(exact)
    return CommonVolume(volume, 0.0 if exact == volume else math.ulp(volume))


def _own_volume(body: PlacedBody) -> CommonVolume:
    volume = body.mesh.topology().volume
    box = math.prod(high - low for low, high in zip(*body.bounds, strict=True))
    return CommonVolume(volume, VOLUME_ROUNDOFFS * UNIT_ROUNDOFF * body.mesh.triangle_count * box)
