"""The pairs that MuJoCo does not check: static bodies, bodies that are welded together, a body and
its parent, excluded bodies, and geoms whose bits do not match; and the pairs of geoms that it
always checks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations_with_replacement, product
from typing import NamedTuple

from satcheck.plugins.mjcf.messages import Body, Model
from satcheck.scene.robot.model import Exempt, Exemption

_WORLD = 0
_STATIC = "static"


class Mask(NamedTuple):
    """Two geoms are checked if the type of one and the affinity of the other share a bit."""

    contype: int
    conaffinity: int

    @property
    def collides(self) -> bool:
        return bool(self.contype or self.conaffinity)

    def meets(self, other: Mask) -> bool:
        return bool(self.contype & other.conaffinity or other.contype & self.conaffinity)

    def __str__(self) -> str:
        return f"contype {self.contype}, conaffinity {self.conaffinity}"


class Exemptions:
    """masks: of all geoms that become bodies; empty: they do not count."""

    def __init__(self, model: Model, masks: Sequence[Mask]) -> None:
        self._model = model
        bodies = model.bodies
        self._welded: dict[int, list[str]] = {}
        for body in bodies:
            self._welded.setdefault(body.weld, []).append(body.name)
        pairs = combinations_with_replacement(sorted({*masks}), 2)
        self._apart = [(a, b) for a, b in pairs if not a.meets(b)]
        self._told_apart = {str(mask) for pair in self._apart for mask in pair}
        self._paired = {geom for pair in model.pairs for geom in pair}

    def groups(self, body: Body | None, mask: Mask, geom: int | None = None) -> tuple[str, ...]:
        """Of a geom. body: None for a flex, which moves on its own. geom: its number."""
        groups = []
        if body is not None and body.static:
            groups.append(_STATIC)
        elif body is not None and len(self._welded[body.weld]) > 1:
            groups.append(self._weld(body.weld))
        if str(mask) in self._told_apart:
            groups.append(str(mask))
        if geom in self._paired:
            groups.append(self._geom(geom))
        return tuple(groups)

    def exempt(self) -> Exempt:
        groups = [*self._by_weld(), *self._by_masks()]
        return Exempt((*self._by_parent(), *self._excluded()), tuple(groups), tuple(self._pairs()))

    def _by_weld(self) -> Iterator[Exemption]:
        yield Exemption(_STATIC, _STATIC, "MJCF: both static")
        for weld, names in self._welded.items():
            if len(names) > 1 and not self._model.bodies[weld].static:
                group = self._weld(weld)
                yield Exemption(group, group, "MJCF: welded together, no joint between")

    def _by_masks(self) -> Iterator[Exemption]:
        for a, b in self._apart:
            yield Exemption(str(a), str(b), f"MJCF: {a} and {b} share no bit")

    def _by_parent(self) -> Iterator[Exemption]:
        """Welded bodies count as one; no body is exempt from those that are welded to the world."""
        if not self._model.parents_pass:
            return
        bodies = self._model.bodies
        for weld, names in self._welded.items():
            above = bodies[bodies[weld].parent].weld
            if weld != _WORLD and above != _WORLD:
                for a, b in product(self._welded[above], names):
                    yield Exemption(a, b, "MJCF: parent and child")

    def _excluded(self) -> Iterator[Exemption]:
        for a, b in self._model.excludes:
            yield Exemption(self._model.bodies[a].name, self._model.bodies[b].name, "MJCF: exclude")

    def _pairs(self) -> Iterator[Exemption]:
        for a, b in self._model.pairs:
            yield Exemption(self._geom(a), self._geom(b), "MJCF: pair")

    def _weld(self, weld: int) -> str:
        return f"welded to {self._model.bodies[weld].name}"

    def _geom(self, number: int | None) -> str:
        return f"geom {self._model.geoms[number or 0].name}"
