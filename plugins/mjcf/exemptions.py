"""The pairs that MuJoCo does not check: static bodies, bodies that are welded together, a body and
its parent, excluded bodies, and geoms whose bits do not match; and the pairs of geoms that it
always checks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import mujoco

from satcheck.scene.document import RawRule
from satcheck.scene.robot.model import Mask, told_apart

_WORLD = 0
_STATIC = "static"


def mask_of(contype: int, conaffinity: int) -> Mask:
    return Mask(contype, conaffinity, f"contype {contype}, conaffinity {conaffinity}")


class Exemptions:
    """bodies, geoms: names. masks: of all geoms that become bodies; empty: they do not count."""

    def __init__(
        self, m: Any, bodies: Sequence[str], geoms: Sequence[str], masks: Sequence[Mask]
    ) -> None:
        self._model = m
        self._bodies = bodies
        self._geoms = geoms
        self._welded: dict[int, list[str]] = {}
        for weld, body in zip(m.body_weldid.tolist(), bodies, strict=True):
            self._welded.setdefault(weld, []).append(body)
        self._told_apart, self._of_masks = told_apart(masks, "MJCF")
        self._pairs = list(zip(m.pair_geom1.tolist(), m.pair_geom2.tolist(), strict=True))
        self._paired = {geom for pair in self._pairs for geom in pair}

    def groups(self, body: int | None, mask: Mask, geom: int | None = None) -> tuple[str, ...]:
        """Of a geom. body, geom: numbers. body: None for a flex, which moves on its own."""
        groups = []
        if body is not None:
            weld = int(self._model.body_weldid[body])
            if self._is_static(body):
                groups.append(_STATIC)
            elif len(self._welded[weld]) > 1:
                groups.append(self._weld(weld))
        if mask.name in self._told_apart:
            groups.append(mask.name)
        if geom is not None and geom in self._paired:
            groups.append(self._geom(geom))
        return tuple(groups)

    def exempt(self) -> Iterator[RawRule]:
        yield from self._by_weld()
        yield from self._of_masks
        yield from self._by_parent()
        for signature in self._model.exclude_signature.tolist():
            a, b = signature >> 16, signature & 0xFFFF
            yield RawRule(self._bodies[a], self._bodies[b], "MJCF: exclude")
        for a, b in self._pairs:
            yield RawRule(self._geom(a), self._geom(b), "MJCF: pair", of_groups=True, checked=True)

    def _is_static(self, body: int) -> bool:
        """Whether no joint moves it; a mocap body is static."""
        return bool(self._model.body_treeid[body] < 0)

    def _by_weld(self) -> Iterator[RawRule]:
        yield RawRule.within(_STATIC, "MJCF: both static")
        for weld, names in self._welded.items():
            if len(names) > 1 and not self._is_static(weld):
                reason = "MJCF: welded together, no joint between"
                yield RawRule.within(self._weld(weld), reason)

    def _by_parent(self) -> Iterator[RawRule]:
        """Welded bodies count as one; no body is exempt from those that are welded to the world."""
        m = self._model
        if m.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FILTERPARENT:
            return
        for weld, names in self._welded.items():
            above = int(m.body_weldid[m.body_parentid[weld]])
            if weld != _WORLD and above != _WORLD:
                for a, b in product(self._welded[above], names):
                    yield RawRule(a, b, "MJCF: parent and child")

    def _weld(self, weld: int) -> str:
        return f"welded to {self._bodies[weld]}"

    def _geom(self, number: int) -> str:
        return f"geom {self._geoms[number]}"
