"""`--cross-check`: the answers of other libraries about a pair, and whether they agree with the
proof.

Each library answers the question that it can decide. python-fcl: do the surfaces meet? It does not
detect a body inside another, and its answer about surfaces that only touch depends on rounding, so
it is not asked about these pairs. Surfaces cross exactly when their bodies penetrate each other.
manifold3d: is there a common volume? It needs two closed manifolds that cover no point twice. A
volume within its tolerance decides nothing.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from satcheck import core
from satcheck.audit.draft import Draft
from satcheck.core.errors import SatcheckError
from satcheck.core.peers import Peers
from satcheck.report.report import CROSS_CHECK, NO_ANSWER, OVERLAPS

DISAGREEMENT = "cross-check-disagreement"

Standing = Literal["agrees", "disagrees", "no answer"]


class Opinion(Struct, frozen=True):
    """theirs: the answer of the peer, or why it has none. ours: the proven answer to the same
    question; empty if there is nothing to compare."""

    peer: str
    standing: Standing
    theirs: str
    ours: str = ""


def ask_peers(draft: Draft) -> None:
    """Record one stage for each peer. A disagreement becomes a warning."""
    pair = draft.pair
    if pair.peers is None:
        return
    if not draft.exact_proven:
        draft.record(CROSS_CHECK, NO_ANSWER, "the relation is not proven: nothing to hold against")
        return
    against = []
    for opinion in (_by_fcl(draft, pair.peers), _by_manifold(draft, pair.peers)):
        draft.record(CROSS_CHECK, opinion.standing, f"{opinion.peer}: {opinion.theirs}")
        if opinion.standing == "disagrees":
            said = f"{opinion.peer} says {opinion.theirs}, satcheck {opinion.ours}"
            against.append(said)
            message = f"{pair.a.id} and {pair.b.id}: {said} ({draft.exact})"
            draft.complain(DISAGREEMENT, None, message)
    if against:
        draft.disputed = f"disputed: {', '.join(against)}"


def _by_fcl(draft: Draft, peers: Peers) -> Opinion:
    pair = draft.pair
    name = "python-fcl"
    if not _tells_whether_surfaces_meet(draft):
        return Opinion(name, "no answer", "not asked: the surfaces touch without crossing")
    try:
        theirs = peers.surfaces_meet(pair.a.mesh, pair.b.mesh)
    except SatcheckError as error:
        return Opinion(name, "no answer", error.message)
    ours = draft.exact == "penetrating"
    return _compared(name, theirs, ours, ("surfaces that meet", "surfaces that are apart"))


def _tells_whether_surfaces_meet(draft: Draft) -> bool:
    """Whether meeting surfaces follow from the relation. A body within another one may touch
    internal faces of its material."""
    pair = draft.pair
    if draft.exact in ("contains", "inside"):
        return core.mesh_distance(pair.a.surface(), pair.b.surface()).distance > 0
    return draft.exact in ("separated", "penetrating")


def _by_manifold(draft: Draft, peers: Peers) -> Opinion:
    pair = draft.pair
    name = "manifold3d"
    if not pair.both_solid:
        return Opinion(name, "no answer", "not asked: a mesh is no solid")
    if any(body.body.file.health.duplicate_triangles for body in (pair.a, pair.b)):
        return Opinion(name, "no answer", "not asked: a mesh may hold sheets, which have no volume")
    if not all(body.shared.covers_once() for body in (pair.a, pair.b)):
        return Opinion(name, "no answer", "not asked: a mesh may overlap itself")
    try:
        common = peers.common_volume(pair.a.mesh, pair.b.mesh)
    except SatcheckError as error:
        return Opinion(name, "no answer", error.message)
    if 0 < abs(common.volume) <= common.error:
        return Opinion(name, "no answer", "a common volume within its tolerance")
    overlap, ours = common.volume > 0, draft.exact in OVERLAPS
    return _compared(name, overlap, ours, ("a common volume", "no common volume"))


def _compared(peer: str, theirs: bool, ours: bool, words: tuple[str, str]) -> Opinion:
    standing: Standing = "agrees" if theirs == ours else "disagrees"
    return Opinion(peer, standing, words[0 if theirs else 1], words[0 if ours else 1])
