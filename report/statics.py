"""What a report says about support: contacts, islands of bodies, and the answers to body rules.

Forces are those on `a` of a contact, in units of mass times gravity: the weight of a body is its
mass. The words say that forces exist; whether friction finds them in time is not part of it.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.values import Count, Length, Size, Value, Vector

# yes, no, or not decided.
State = Literal["yes", "no", "open"]
Question = Literal["supported", "stable"]
# touching: their surfaces are within the tolerance. overlapping: they overlap by more than that.
# unknown: how they relate is not decided.
Touch = Literal["touching", "overlapping", "unknown"]


class BodyRuleReport(Value, frozen=True):
    """A rule about single bodies. None: the rule does not set the key."""

    bodies: str
    supported: bool | None
    stable: bool | None
    mounted: bool | None
    inside: str | None
    region: bool | None
    density: Size | None
    mass: Size | None
    friction: Length | None
    severity: Literal["error", "warning", "note", "none"] | None
    reason: str
    where: str


class ContactPoint(Value, frozen=True):
    """at: in the world. normal: unit, from B to A. strict: it is as near as the nearest contact of
    the pair. force: on A; None: none was looked for, or none exists."""

    at: Vector
    normal: Vector
    strict: bool
    force: Vector | None = None


class BodyContact(Value, frozen=True):
    """Two bodies of which at least one is free. complete: all contacts within the tolerance are
    listed; else nothing that falls is proven to fall."""

    a: str
    b: str
    touch: Touch
    friction: Length
    complete: bool
    points: tuple[ContactPoint, ...]


class FirstMotion(Value, frozen=True):
    """A virtual velocity: of the centre of mass, and angular, up to a common factor."""

    velocity: Vector
    angular: Vector


class SupportedBody(Value, frozen=True):
    """fixed: why it holds others and is not asked to stand; None: it is free. mass, centre: None:
    not known, or not needed. island: its number; None: it is fixed. floating: whether no chain of
    contacts leads to a fixed body. held_by: bodies that touch it. chain: from the body to a fixed
    one. motion: how it starts to move; None: it does not, or that is not known."""

    id: str
    fixed: Literal["static", "mounted"] | None
    mass: Size | None
    centre: Vector | None
    island: Count | None
    floating: State
    held_by: tuple[str, ...]
    chain: tuple[str, ...]
    motion: FirstMotion | None = None


Degrees = Annotated[float, Meta(ge=0, le=90)]
# Gravity may tilt by no more than this about a body that is only balanced.
BALANCED_DEGREES = 1e-4


class BodyIsland(Value, frozen=True):
    """Free bodies that touch each other. tolerant: whether forces at all contacts hold them.
    strict: whether forces at the strict contacts do. missing: of the forces that come closest, as a
    share of the weight; None: not computed. margin: the angle, in degrees, by which gravity may
    tilt in any direction, between two ends. least_friction: a friction that suffices, if all
    contacts have the same. squeezed: whether it falls unless something presses it. These three are
    figures without a proof; None: not computed. reason: why something is open."""

    bodies: tuple[str, ...]
    tolerant: State
    strict: State
    missing: Length | None = None
    margin: tuple[Degrees, Degrees] | None = None
    least_friction: Length | None = None
    squeezed: bool | None = None
    reason: str | None = None

    @property
    def balanced(self) -> bool:
        return self.margin is not None and self.margin[1] <= BALANCED_DEGREES

    @property
    def doubtful(self) -> bool:
        """Whether its bodies may fall although forces hold them."""
        return bool(self.squeezed) or self.balanced


class SupportFinding(Value, frozen=True):
    """The answer to one question about one body. rule: the name of the rule that asks."""

    body: str
    question: Question
    rule: str
    severity: Literal["error", "warning", "note", "silenced", "none"]
    answer: State
    reason: str | None = None


class Statics(Value, frozen=True, kw_only=True):
    """gravity: unit. stated: which of gravity, friction and tolerance the scene states; the others
    are assumptions. asked_by: the rules that ask something. contacts: of free bodies. pairs: the
    number of pairs whose distance was looked at. microseconds: of all of this."""

    gravity: Vector
    friction: Length
    tolerance: Length
    stated: tuple[Literal["gravity", "friction", "tolerance"], ...]
    asked_by: tuple[str, ...]
    rules: tuple[BodyRuleReport, ...]
    bodies: tuple[SupportedBody, ...]
    contacts: tuple[BodyContact, ...]
    islands: tuple[BodyIsland, ...]
    findings: tuple[SupportFinding, ...]
    pairs: Count
    microseconds: Length = 0.0

    @property
    def is_open(self) -> bool:
        """Whether a question is undecided."""
        return any(finding.answer == "open" for finding in self.findings)
