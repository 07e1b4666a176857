"""What a scene asks about support: rules of bodies, and what gravity and friction are.

A body rule applies to every body that its selector selects. If several rules for a body set the
same key, the last one counts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.conventions import Vector
from satcheck.scene.files.readers import reader_named
from satcheck.scene.rules import (
    Length,
    Rule,
    Selectable,
    Selected,
    Selector,
    Severity,
    bad_rule,
    require_effect,
    stated_keys,
)
from satcheck.scene.table import Direction, NotNegative, Positive, Table, Text, Wrong

if TYPE_CHECKING:
    from satcheck.scene.bodies import Scene

# What a body rule asks of a body, and what it states about a body.
QUESTIONS: tuple[Literal["supported", "stable"], ...] = ("supported", "stable")
FACTS = ("mounted", "region", "density", "mass", "friction")
KEYS = (*QUESTIONS, "inside", *FACTS, "severity")
EFFECTIVE_KEYS = (*KEYS, "open")  # `open` is a fact of the body itself in a scene

_DOWN_Z: Vector = (0.0, 0.0, -1.0)
_DOWN_Y: Vector = (0.0, -1.0, 0.0)

FRICTION = 0.5  # an assumption, for scenes that state none; reports show it


class BodyRuleKeys(Table, frozen=True, kw_only=True):
    """What is asked of single bodies, and stated about them.

    supported: Contacts within the tolerance must be able to carry them.
    stable: So must their nearest contacts alone.
    mounted: They hold like static bodies and need not stand.
    inside: The id of the body in which they must lie.
    region: They bound space and have no material: they collide with nothing and hold nothing.
    mass: Of each of them; overrides the density.
    friction: Of two bodies the smaller one counts.
    open: Their meshes are meant to be open: sheets, not solids with holes.
    asset: Only the bodies of such files, by a glob of the name or the path.
    reason: Why, in words.
    """

    bodies: Selected
    supported: bool | None = None
    stable: bool | None = None
    mounted: bool | None = None
    inside: Text | None = None
    region: bool | None = None
    density: Positive | None = None
    mass: Positive | None = None
    friction: NotNegative | None = None
    open: bool | None = None
    asset: Text | None = None
    severity: Severity | None = None
    reason: Text = ""


class BodyRule(BodyRuleKeys, frozen=True, kw_only=True):
    """Questions about single bodies, and facts for their answers. None: the rule does not set the
    key.

    `supported` and `stable` False revoke an earlier question. A mounted body is fixed to something,
    as a lamp to its ceiling. A region is a room or a drawer. `density` is mass by cubed unit of the
    scene. `severity` is that of a failed question. where, file, line: as for a `Rule`.

    Raises SatcheckError `bad-rule`: a key is out of range, or no key has an effect.
    """

    where: str = ""
    file: str | None = None
    line: int | None = None

    def __post_init__(self) -> None:
        for key in ("density", "mass"):
            value = getattr(self, key)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise bad_rule(f"{key} must be a finite number > 0, not {value!r}")
        if self.friction is not None and not (math.isfinite(self.friction) and self.friction >= 0):
            raise bad_rule(f"friction must be a finite number >= 0, not {self.friction!r}")
        require_effect(self, EFFECTIVE_KEYS)

    def scaled(self, scale: float) -> BodyRule:
        """The same rule in another unit of length, which is `scale` times smaller."""
        if scale == 1.0 or self.density is None:
            return self
        return replace(self, density=self.density / scale**3)

    @property
    def permission(self) -> Rule:
        """That other bodies may overlap with a region."""
        return Rule(
            a=self.bodies,
            b=Selector("*"),
            allowed=True,
            reason=self.reason or "a region has no material",
            where=self.where,
            file=self.file,
            line=self.line,
        )

    @property
    def name(self) -> str:
        """Its place in a file, else its selector."""
        return self.where or self.bodies.text


class StaticsTerms(Table, frozen=True, kw_only=True):
    """What rules about the support of bodies assume.

    gravity: The direction in which things fall; its length does not count.
    friction: The Coulomb coefficient of all contacts.
    tolerance: A gap, or an overlap, up to this is a contact.
    """

    lengths: ClassVar = ("tolerance",)

    gravity: Direction | None = None
    friction: NotNegative | None = None
    tolerance: Length | None = None

    def __post_init__(self) -> None:
        if self.gravity is not None and not any(self.gravity):
            raise Wrong("a direction other than 0 expected", "gravity")

    def scaled(self, scale: float) -> StaticsTerms:
        """The same in another unit of length."""
        if self.tolerance is None:
            return self
        return replace(self, tolerance=self.tolerance * scale)


class BodyTerms(Struct, frozen=True):
    """What all rules together say about one body, with the rule that asks each question."""

    rules: dict[str, BodyRule]

    def value(self, key: str) -> Any:
        rule = self.rules.get(key)
        return None if rule is None else getattr(rule, key)

    def asks(self, question: str) -> BodyRule | None:
        """The rule that asks this question; None: none does."""
        return self.rules.get(question) if self.value(question) else None

    def region_for(self, body: str) -> str | None:
        """Return the region in which this body has to lie; None: in none. A region lies in no other
        one, and no body in itself."""
        region = self.value("inside")
        return None if region == body or self.value("region") else region


def terms_of(bodies: Sequence[Selectable], rules: Sequence[BodyRule]) -> list[BodyTerms]:
    """What the rules say about each body."""
    rules_of: dict[str, dict[str, BodyRule]] = {body.id: {} for body in bodies}
    for rule in rules:
        own = dict.fromkeys(stated_keys(rule, KEYS), rule)
        for body in rule.bodies.select(bodies):
            rules_of[body.id] |= own
    return [BodyTerms(rules_of[body.id]) for body in bodies]


def joined_terms(stated: Sequence[StaticsTerms]) -> StaticsTerms:
    """The terms of several files together. Raises SatcheckError `bad-rule` where they differ."""
    values: dict[str, Any] = {}
    for terms in stated:
        for key, value in stated_keys(terms, StaticsTerms.__struct_fields__).items():
            if values.setdefault(key, value) != value:
                raise bad_rule(f"two inputs state another {key} in [statics]: state it once")
    return StaticsTerms(**values)


def down_of(scene: Scene) -> Vector:
    """The direction of gravity of a scene that states none: along the up axis of the format if all
    bodies are nodes of files that have one, else -z."""
    axes = up_axes(scene)
    return _DOWN_Y if axes == {"y"} and not scene.entries else _DOWN_Z


def disagreeing_axes(scene: Scene) -> bool:
    """Whether gravity is assumed although the scene has glTF files, which are y-up, beside others:
    then the assumption is wrong for some of them, unless their placement turns them."""
    if scene.statics is not None and scene.statics.gravity is not None:
        return False
    return "y" in up_axes(scene) and down_of(scene) == _DOWN_Z


def up_axes(scene: Scene) -> set[str | None]:
    """Return the axes that point up in the formats of the bodies; None: a format has none."""
    readers = map(reader_named, {body.file.format for body in scene.bodies})
    return {None if reader is None else reader.up for reader in readers}


def stated_terms(scene: Scene) -> StaticsTerms:
    """The terms as a scene file states them, with gravity in any case: in a scene file, the format
    of a mesh does not say where down is."""
    stated = scene.statics or StaticsTerms()
    return replace(stated, gravity=stated.gravity or down_of(scene))
