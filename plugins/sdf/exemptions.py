"""The pairs that SDFormat does not check: static models, links of one model, links that a joint
connects, and collisions whose bit masks share no bit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations_with_replacement
from typing import NamedTuple

from msgspec.structs import replace

from satcheck.plugins.sdf.parts import Mask, Part
from satcheck.scene.robot.model import Collision, Exemption

_STATIC = "static"


class Contacts(NamedTuple):
    """model: the outermost model of a link. self_collide: the link is checked against other links
    of this model."""

    model: str
    static: bool
    self_collide: bool

    def groups(self) -> Iterator[str]:
        if self.static:
            yield _STATIC
        if not self.self_collide:
            yield _of_model(self.model)


def exempt(
    contacts: Mapping[str, Contacts], parts: Mapping[str, Sequence[Part]]
) -> tuple[dict[str, tuple[Collision, ...]], list[Exemption]]:
    """(the collisions of each link, with their groups, the exemptions). contacts, parts: of each
    link."""
    masks = sorted({part.mask for link in parts.values() for part in link})
    apart = [(a, b) for a, b in combinations_with_replacement(masks, 2) if not a.meets(b)]
    told_apart = {mask for pair in apart for mask in pair}
    collisions = {
        link: tuple(
            replace(collision, groups=(*contacts[link].groups(), *_told(mask, told_apart)))
            for collision, mask in of_link
        )
        for link, of_link in parts.items()
    }
    return collisions, [*_by_masks(apart), *_by_model(contacts.values())]


def _told(mask: Mask, told_apart: set[Mask]) -> list[str]:
    return [str(mask)] if mask in told_apart else []


def _by_model(links: Iterable[Contacts]) -> Iterator[Exemption]:
    if any(link.static for link in links):
        yield Exemption(_STATIC, _STATIC, "SDF: both static", of_groups=True)
    for model in dict.fromkeys(link.model for link in links if not link.self_collide):
        group, reason = _of_model(model), f"SDF: links of model {model} without self_collide"
        yield Exemption(group, group, reason, of_groups=True)


def _by_masks(apart: Iterable[tuple[Mask, Mask]]) -> Iterator[Exemption]:
    for a, b in apart:
        yield Exemption(str(a), str(b), f"SDF: {a} and {b} share no bit", of_groups=True)


def _of_model(model: str) -> str:
    return f"model {model}"
