"""The stage `volume`: the common volume of two solids. It runs only on request."""

from __future__ import annotations

import math

from satcheck.audit.body import PlacedBody
from satcheck.audit.draft import Draft
from satcheck.core.errors import SatcheckError
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.report.judge import is_within

# The signed volume of a mesh is a sum of determinants from one of its corners: six products of box
# edges with 9 roundings each, as much again for the sum, divided by six. So the error for each
# triangle is this number of roundoffs of the volume of the box.
VOLUME_ROUNDOFFS = 18
# The code of a mesh that manifold3d cannot use.
REFUSED = "volume-refused"


def measure_volume(draft: Draft) -> None:
    """Measure the volume of the exact relation, whatever the touch band: a relation that says it
    all costs nothing."""
    pair = draft.pair
    nothing = draft.exact_proven and draft.exact in ("separated", "touching")
    if nothing and (pair.both_solid or draft.gap_lower > 0):
        draft.volume = draft.volume_error = 0.0
        return
    if not pair.may("exact"):
        refusal = f"found on triangles: not at --accuracy {pair.settings.accuracy}"
        draft.record("volume", "not measured", refusal)
        draft.reason = draft.reason or f"no volume: {refusal}"
        return
    try:
        for body in (pair.a, pair.b):
            _require_measurable(body)
        draft.volume, draft.volume_error = _measured(draft)
    except SatcheckError as refused:
        draft.record("volume", "refused", refused.message)
        where = "" if refused.body else f"{pair.a.id} and {pair.b.id}: "
        draft.complain(refused.code, refused.body, where + refused.message)
        draft.reason = draft.reason or f"no volume: {refused}"


def _require_measurable(body: PlacedBody) -> None:
    if not body.solid:
        raise SatcheckError("volume-of-no-solid", "is no solid and has no volume", body=body.id)
    if not body.shared.covers_once():
        raise SatcheckError(
            "volume-of-self-overlap",
            "may overlap itself, so that its volume is not that of its mesh",
            body=body.id,
        )


def _measured(draft: Draft) -> tuple[float, float]:
    """Return the volume and its error, in rational numbers if an estimate leaves a limit open, or
    if there is none."""
    try:
        volume, error = _estimated(draft)
    except SatcheckError as refused:
        exact = _exact(draft, "as there is no estimate") if refused.code == REFUSED else None
        if exact is None:
            raise
        return exact
    limit = draft.pair.request.max_volume
    if limit is None or is_within(limit, volume - error, volume + error) is not None:
        return volume, error
    return _exact(draft, "as the estimate leaves the limit open") or (volume, error)


def _estimated(draft: Draft) -> tuple[float, float]:
    pair = draft.pair
    inner = {"contains": pair.b, "inside": pair.a, "coincident": pair.a}.get(draft.exact)
    if inner is not None:
        own = _own_volume(inner)
        draft.record("volume", "of the mesh", f"{inner.id} lies within the other")
        return own
    assert pair.meter is not None
    common = pair.meter.measure(pair.a.mesh, pair.b.mesh)
    detail = f"by manifold3d in a child process, off by about {common.error:.1g} at most"
    draft.record("volume", "measured", detail)
    return max(common.volume, 0.0), common.error


def _exact(draft: Draft, why: str) -> tuple[float, float] | None:
    """Return None where that is too much work."""
    from satcheck.core.exact_volume import exact_common_volume

    exact = exact_common_volume(draft.pair.a.mesh, draft.pair.b.mesh)
    if exact is None:
        draft.record("volume", "no answer", "too many triangles for rational numbers")
        return None
    draft.record("volume", "exact", f"in rational numbers, {why}")
    volume = float(exact)
    return volume, 0.0 if exact == volume else math.ulp(volume)


def _own_volume(body: PlacedBody) -> tuple[float, float]:
    box = math.prod(high - low for low, high in zip(*body.bounds, strict=True))
    error = VOLUME_ROUNDOFFS * UNIT_ROUNDOFF * body.mesh.triangle_count * box
    return body.mesh.topology().volume, error
