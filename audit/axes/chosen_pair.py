"""The pair of bodies whose axes are studied, as a check would place them."""

from __future__ import annotations

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.request.settings import Settings
from satcheck.audit.studied_pair import pair_of
from satcheck.core.conventions import Plane
from satcheck.core.errors import SatcheckError
from satcheck.scene import Body, Scene

MOST_NAMED = 12  # bodies in a message


def chosen_pair(
    scene: Scene, ids: tuple[str, str] | None, *, planar: Plane | None, allow_open: bool
) -> Pair:
    """ids: of A and B; None: the scene has only two. Raises SatcheckError."""
    scene.require_one_unit()
    if planar is None:
        scene.require_in_space("add --planar xy")
    else:
        from satcheck.scene.planar.flat_scene import flat_scene

        scene = flat_scene(scene, planar, allow_open=allow_open)
    a, b = (_usable(scene, id_) for id_ in ids or _only_two(scene))
    if a is b:
        raise SatcheckError("not-a-pair", f"{a.id} is one body: name two")
    return pair_of((a, b), Settings(planar=planar, allow_open=allow_open))


def _only_two(scene: Scene) -> tuple[str, str]:
    members = scene.in_order()
    if len(members) != 2:
        message = f"{_named(scene)}: name two of them with --pair A B"
        raise SatcheckError("not-a-pair", message)
    return members[0].id, members[1].id


def _usable(scene: Scene, id_: str) -> Body:
    member = next((body for body in scene.in_order() if body.id == id_), None)
    if member is None:
        message = f"there is no body {id_!r}: {_named(scene)}"
        raise SatcheckError("no-such-body", message)
    if not isinstance(member, Body):
        raise SatcheckError(member.issue.code, member.issue.message, body=id_)
    return member


def _named(scene: Scene) -> str:
    ids = [body.id for body in scene.in_order()]
    more = "" if len(ids) <= MOST_NAMED else ", ..."
    return f"{len(ids)} bodies ({', '.join(ids[:MOST_NAMED])}{more})"
