"""Rules of a scene: the pairs of bodies that they apply to, and their limits.

A rule applies to every pair with one body in `a` and the other in `b`, in either order. A rule sets
some keys. If several rules for a pair set the same key, the last one counts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Sequence
from typing import Annotated, Any, ClassVar, Literal, Protocol, TypeVar, get_args

from msgspec import Meta
from msgspec.structs import replace

from satcheck.core.conventions import LARGEST_LENGTH
from satcheck.core.errors import SatcheckError
from satcheck.scene.table import NotNegative, Table, Text
from satcheck.scene.units import LENGTH_PATTERN
from satcheck.scene.words import listed, meant, with_closed_brackets

Severity = Literal["error", "warning", "note", "none"]
SEVERITIES: tuple[Severity, ...] = get_args(Severity)
LENGTHS = ("max_depth", "max_thickness", "clearance", "tolerance")
# The keys that have an effect. `reason` and `where` only explain a rule.
KEYS = ("allowed", "max_volume", "severity", *LENGTHS)

PLACE = ("where", "file", "line")  # of a rule: these are no keys of a file

GROUP = "group:"
# What `Selector.exactly` writes: each special character in brackets of its own.
# Compiled at their first use: most scenes have no rules.
_SPECIAL = r"[*?\[]"
_ESCAPED = r"(?:\[g\](?=roup:))?(?:[^*?\[]|\[[*?\[]\])*"
_IN_BRACKETS = r"\[([*?\[g])\]"
# Python represents a byte of a file name that is not text as a surrogate, which is not a character.
_NO_CHARACTER = "[!\1-\ud7ff\ue000-\U0010ffff]"


class Selectable(Protocol):
    """The properties of a body that a selector needs."""

    @property
    def id(self) -> str: ...

    @property
    def groups(self) -> Collection[str]: ...


B = TypeVar("B", bound=Selectable)


class Selector(str):
    """Selects bodies by a glob of their ids, "arm/*", or of their groups, "group:links*".

    `*` matches any text, `?` one character, `[abc]` one of these, `[!abc]` any other; case counts.
    "[*]" matches a star. If an id (or a group) is exactly the text of the selector, only this id is
    selected: "bricks[0]" selects the body of that name if there is one. Raises SatcheckError
    `bad-rule` for an empty glob.
    """

    __slots__ = ()

    def __init__(self, text: str) -> None:
        if not self.glob:
            raise bad_rule(f"the selector {text!r} is empty: give a glob of ids or groups")

    @property
    def text(self) -> str:
        return str(self)

    @classmethod
    def exactly(cls, body: str) -> Selector:
        """The selector of this one id, which may contain any characters."""
        text = re.sub(_SPECIAL, r"[\g<0>]", body)
        return cls(f"[g]{text[1:]}" if text.startswith(GROUP) else text)

    @classmethod
    def exactly_group(cls, group: str) -> Selector:
        """The selector of this one group."""
        return cls(GROUP + re.sub(_SPECIAL, r"[\g<0>]", group))

    @classmethod
    def writable(cls, body: str) -> Selector:
        """The selector of this id, in characters that a text file can hold. A byte of the id that
        is not text becomes a pattern that matches all such bytes and no character."""
        text = cls.exactly(body).text
        return cls("".join(_NO_CHARACTER if "\ud800" <= c <= "\udfff" else c for c in text))

    @classmethod
    def nobody(cls) -> Selector:
        return cls("[!\0-\U0010ffff]")  # matches no character

    @property
    def of_groups(self) -> bool:
        return self.startswith(GROUP)

    @property
    def glob(self) -> str:
        return self.removeprefix(GROUP)

    def choose(self, names: Collection[str]) -> Collection[str]:
        """The selected ones of these ids, or of these groups."""
        for text in self._spelt():
            if text in names:
                return (text,)
        if not re.search(_SPECIAL, self.glob):
            return ()
        from fnmatch import translate

        matches = re.compile(translate(with_closed_brackets(self.glob))).match
        return [name for name in names if matches(name)]

    def _spelt(self) -> Iterator[str]:
        """Names that are tried before the glob: the id for which `exactly` writes this text, then
        the text itself."""
        if "[" in self.glob and re.fullmatch(_ESCAPED, self.glob):
            yield re.sub(_IN_BRACKETS, r"\1", self.glob)
        yield self.glob

    def select(self, bodies: Sequence[B]) -> list[B]:
        """bodies: all bodies of the scene, because an id that is exactly the text overrides the
        glob."""
        if self.of_groups:
            groups = frozenset(self.choose({group for body in bodies for group in body.groups}))
            return [body for body in bodies if not groups.isdisjoint(body.groups)]
        ids = frozenset(self.choose({body.id for body in bodies}))
        return [body for body in bodies if body.id in ids]

    def unmatched(self, bodies: Sequence[B]) -> str:
        """Return `no body is palm: there are hand, arm`, where none of the bodies is selected."""
        names = [body.id for body in bodies]
        if self.of_groups:
            names = sorted({f"{GROUP}{group}" for body in bodies for group in body.groups})
        known = meant(self, names) or f": there are {listed(names) or 'none'}"
        return f"no {'group' if self.of_groups else 'body'} is {self}{known}"


# In a scene file: a glob, and a number in the units of the scene or a text with a unit, "2mm".
SELECTED = {"type": "string", "minLength": 1, "not": {"const": GROUP}}
Selected = Annotated[Selector, Meta(extra_json_schema=SELECTED)]
Length = Annotated[NotNegative, Meta(extra_json_schema={"pattern": LENGTH_PATTERN})]


class RuleKeys(Table, frozen=True, kw_only=True):
    """What is asked of the pairs with one body in a and the other in b. A selector is a glob of
    ids, or of groups after "group:"; an id or group that is exactly the text comes first.

    allowed: They may overlap; nothing is computed. Needs a reason, and no other key.
    max_depth: An overlap no deeper than this is within budget.
    max_thickness: So is one without a ball in both bodies thicker than this.
    max_volume: So is one that shares no more than this.
    clearance: The gap that they must keep.
    tolerance: Half the width of the touch band.
    reason: Why, in words.
    """

    lengths: ClassVar = LENGTHS

    a: Selected
    b: Selected
    allowed: bool | None = None
    max_depth: Length | None = None
    max_thickness: Length | None = None
    max_volume: NotNegative | None = None
    clearance: Length | None = None
    tolerance: Length | None = None
    severity: Severity | None = None
    reason: Text = ""


class Rule(RuleKeys, frozen=True, kw_only=True):
    """Limits for the pairs with one body in each selector, in units of the scene.

    None: the rule does not set the key. `allowed` False revokes an earlier permission. `clearance`
    and `tolerance` override the global ones; 0.0: none. An undecided pair is at least a warning.

    where: such as "file:line"; names the rule in a report. file, line: its place, if known.

    Raises SatcheckError `bad-rule`: a key is out of range, or no key has an effect.
    """

    where: str = ""
    file: str | None = None
    line: int | None = None

    def __post_init__(self) -> None:
        for key in (*LENGTHS, "max_volume"):
            value = getattr(self, key)
            if value is not None and not (math.isfinite(value) and value >= 0):
                raise bad_rule(f"{key} must be a finite number >= 0, not {value!r}")
            if value is not None and key in LENGTHS and value > LARGEST_LENGTH:
                message = f"{key} must be at most {LARGEST_LENGTH:g}, not {value!r}"
                raise SatcheckError("out-of-range", message)
        require_effect(self, KEYS)
        if self.allowed and any(getattr(self, key) is not None for key in KEYS if key != "allowed"):
            raise bad_rule("an allowed pair is not checked: remove the other keys")

    def scaled(self, scale: float) -> Rule:
        """The same rule in another unit: lengths times `scale`, the volume times its cube."""
        if scale == 1.0:
            return self
        known = stated_keys(self, (*LENGTHS, "max_volume"))
        factors = dict.fromkeys(LENGTHS, scale) | {"max_volume": scale**3}
        return replace(self, **{key: value * factors[key] for key, value in known.items()})

    @property
    def name(self) -> str:
        """Its place in a file, else its two selectors."""
        return self.where or f"{self.a.text} and {self.b.text}"


class Members:
    """Finds the bodies of a selector, by their numbers."""

    def __init__(self, bodies: Sequence[Selectable]) -> None:
        self._chosen: dict[str, frozenset[int]] = {}
        self._by_id: dict[str, list[int]] = {body.id: [k] for k, body in enumerate(bodies)}
        self._by_group: dict[str, list[int]] = {}
        for k, body in enumerate(bodies):
            for group in dict.fromkeys(body.groups):
                self._by_group.setdefault(group, []).append(k)

    def of(self, text: str) -> frozenset[int]:
        """Return the bodies of the selector of this text."""
        if text not in self._chosen:
            selector = Selector(text)
            names = self._by_group if selector.of_groups else self._by_id
            self._chosen[text] = frozenset(
                k for name in selector.choose(names) for k in names[name]
            )
        return self._chosen[text]


def require_effect(rule: Any, keys: Sequence[str]) -> None:
    """Raises SatcheckError `bad-rule` if the severity is unknown, or if none of the keys, which
    are those with an effect, is set."""
    if rule.severity not in (None, *SEVERITIES):
        names = ", ".join(SEVERITIES)
        raise bad_rule(f"severity must be one of {names}, not {rule.severity!r}")
    if all(getattr(rule, key) is None for key in keys):
        raise bad_rule(f"the rule has no effect: give it one of {', '.join(keys)}")


def stated_keys(rule: object, keys: Sequence[str]) -> dict[str, Any]:
    """The keys that are set, with their values."""
    values = {key: getattr(rule, key) for key in keys}
    return {key: value for key, value in values.items() if value is not None}


def bad_rule(message: str) -> SatcheckError:
    return SatcheckError("bad-rule", message)
