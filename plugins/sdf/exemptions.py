"""The pairs that SDFormat does not check: static models, links of one model, links that a joint
connects, and collisions whose bit masks share no bit."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import combinations_with_replacement

from msgspec.structs import replace

from satcheck.plugins.sdf.contents import LinkEntry
from satcheck.plugins.sdf.parts import Mask, Part
from satcheck.scene.robot.model import Collision, Exemption

_STATIC = "static"


def exempt(
    links: Mapping[str, LinkEntry], parts: Mapping[str, Sequence[Part]]
) -> tuple[dict[str, tuple[Collision, ...]], list[Exemption]]:
    """(the collisions of each link, with their groups, the exemptions). parts: of each link."""
    masks = sorted({part.mask for link in parts.values() for part in link})
    apart = [(a, b) for a, b in combinations_with_replacement(masks, 2) if not a.meets(b)]
    told_apart = {mask for pair in apart for mask in pair}
    collisions = {
        path: tuple(
            replace(part.collision, groups=tuple(_groups(links[path], part.mask, told_apart)))
            for part in of_link
        )
        for path, of_link in parts.items()
    }
    return collisions, list(_exemptions(links.values(), apart))


def _groups(link: LinkEntry, mask: Mask, told_apart: set[Mask]) -> Iterator[str]:
    if link.static:
        yield _STATIC
    if not link.self_collide:
        yield _of_model(link.model)
    if mask in told_apart:
        yield str(mask)


def _exemptions(
    links: Collection[LinkEntry], apart: Iterable[tuple[Mask, Mask]]
) -> Iterator[Exemption]:
    for a, b in apart:
        yield Exemption(str(a), str(b), f"SDF: {a} and {b} share no bit", of_groups=True)
    if any(link.static for link in links):
        yield Exemption(_STATIC, _STATIC, "SDF: both static", of_groups=True)
    for model in dict.fromkeys(link.model for link in links if not link.self_collide):
        group, reason = _of_model(model), f"SDF: links of model {model} without self_collide"
        yield Exemption(group, group, reason, of_groups=True)


def _of_model(model: str) -> str:
    return f"model {model}"
