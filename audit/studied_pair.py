"""The two bodies that a study is about, and a new pair of them without cached data, as a check
makes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.bodies import BodyCache, code_of_placing
from satcheck.audit.pair import Pair
from satcheck.audit.planner import request_for
from satcheck.audit.settings import Settings
from satcheck.core.errors import SatcheckError
from satcheck.scene import Body, Scene

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.core.peers import VolumeMeter

Bodies = tuple[Body, Body]
MOST_NAMED = 12  # bodies in a message


def two_of(scene: Scene, ids: tuple[str, str] | None) -> Bodies:
    """The bodies with these ids; None: the scene has only two. Raises SatcheckError."""
    scene.require_one_unit()
    a, b = (_usable(scene, id_) for id_ in ids or _only_two(scene))
    if a is b:
        raise SatcheckError("not-a-pair", f"{a.id} is one body: name two")
    return a, b


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


def pair_of(bodies: Bodies, settings: Settings, meter: VolumeMeter | None = None) -> Pair:
    """Raises SatcheckError where a body cannot be placed."""
    cache = BodyCache()
    a, b = (_placed(cache, body, settings) for body in bodies)
    return Pair(a, b, settings, request_for(settings), meter)


def _placed(cache: BodyCache, body: Body, settings: Settings) -> PlacedBody:
    try:
        return cache.place(body, settings, None)
    except (OverflowError, ValueError) as error:
        raise SatcheckError(
            code_of_placing(error), f"cannot be placed: {error}", body=body.id
        ) from None
