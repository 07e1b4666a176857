"""The pairs that SDFormat does not check: static models, links of one model, links that a joint
connects, and collisions whose bit masks share no bit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations_with_replacement
from typing import NamedTuple

from msgspec.structs import replace

from satcheck.plugins.sdf.parts import ANY, Mask, Part
from satcheck.scene.robot.model import Collision, Exempt, Exemption

_STATIC = "static"


class Contacts(NamedTuple):
    """model: the outermost model of a link. self_collide: the link is checked against other links
    of this model."""

    model: str
    static: bool
    self_collide: bool


def exempt(
    contacts: Mapping[str, Contacts],
    parts: Mapping[str, Sequence[Part]],
    joined: Iterable[Exemption],
) -> tuple[dict[str, tuple[Collision, ...]], Exempt]:
    """(the collisions of each link, with their groups, the exemptions). contacts, parts: of each
    link. joined: the links that a joint connects."""
    masks = {part.mask for link in parts.values() for part in link}
    apart = [(a, b) for a, b in combinations_with_replacement(sorted(masks), 2) if not a.meets(b)]
    told_apart = {mask for pair in apart for mask in pair}
    collisions = {
        link: tuple(
            replace(part.collision, groups=_groups(contacts[link], part.mask, told_apart))
            for part in of_link
        )
        for link, of_link in parts.items()
    }
    groups = [*_by_masks(apart), *_by_model(contacts.values())]
    return collisions, Exempt(tuple(joined), tuple(groups))


def _groups(link: Contacts, mask: Mask, told_apart: set[Mask]) -> tuple[str, ...]:
    groups = [_STATIC] if link.static else []
    if not link.self_collide:
        groups.append(_model_group(link.model))
    if mask in told_apart:
        groups.append(_mask_name(mask))
    return tuple(groups)


def _by_model(contacts: Iterable[Contacts]) -> list[Exemption]:
    links = list(contacts)
    exemptions = (
        [Exemption(_STATIC, _STATIC, "SDF: both static")] if any(c.static for c in links) else []
    )
    for model in dict.fromkeys(link.model for link in links if not link.self_collide):
        group = _model_group(model)
        reason = f"SDF: links of model {model} without self_collide"
        exemptions.append(Exemption(group, group, reason))
    return exemptions


def _by_masks(apart: Iterable[tuple[Mask, Mask]]) -> list[Exemption]:
    names = ((_mask_name(a), _mask_name(b)) for a, b in apart)
    return [Exemption(a, b, f"SDF: {a} and {b} share no bit") for a, b in names]


def _model_group(model: str) -> str:
    return f"model {model}"


def _mask_name(mask: Mask) -> str:
    if mask == ANY:
        return "any collide_bitmask"
    name = f"collide_bitmask {mask.collide:#06x}"
    if mask.category == mask.collide:
        return name
    return f"{name}, category_bitmask {mask.category:#06x}"
