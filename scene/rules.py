"""Rules of a scene: which pairs of bodies they are about, and what they ask of them.

A rule is about every pair with one body in `a` and the other in `b`, whichever comes first. It sets
some keys and leaves the others alone: of several rules about a pair, the last one that sets a key
decides that key.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Sequence
from typing import Literal, Protocol, TypeVar, get_args

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError

Severity = Literal["error", "warning", "note", "none"]
SEVERITIES: tuple[Severity, ...] = get_args(Severity)
LENGTHS = ("max_depth", "max_thickness", "clearance", "tolerance")
# The keys by which a rule asks something; `reason` explains and `where` finds them.
KEYS = ("allowed", "max_volume", "severity", *LENGTHS)

GROUP = "group:"
# What `Selector.exactly` writes: each special character in brackets of its own.
# Compiled at their first use: most scenes have no rules.
_SPECIAL = r"[*?\[]"
_ESCAPED = r"(?:\[g\](?=roup:))?(?:[^*?\[]|\[[*?\[]\])*"
_IN_BRACKETS = r"\[([*?\[g])\]"
# A byte of a file name that is not text is a surrogate in Python, which is not a character.
_NO_CHARACTER = "[!\1-\ud7ff\ue000-\U0010ffff]"


class Selectable(Protocol):
    """A body, as a selector sees it."""

    @property
    def id(self) -> str: ...

    @property
    def groups(self) -> tuple[str, ...]: ...


B = TypeVar("B", bound=Selectable)


class Selector(Struct, frozen=True):
    """Bodies by the glob of their ids, "arm/*", or of their groups, "group:links*".

    `*` any text, `?` one character, `[abc]` one of these, `[!abc]` one other; case counts. "[*]" is
    a star. Where an id (or a group) is exactly this text, it alone is selected: "bricks[0]" is the
    body of that name if there is one. Raises SatcheckError `bad-rule` for an empty glob.
    """

    text: str

    def __post_init__(self) -> None:
        if not self.glob:
            raise _refused(f"the selector {self.text!r} is empty: give a glob of ids or groups")

    @classmethod
    def exactly(cls, body: str) -> Selector:
        """The selector of this one id, whatever characters it is made of."""
        text = re.sub(_SPECIAL, r"[\g<0>]", body)
        return cls(f"[g]{text[1:]}" if text.startswith(GROUP) else text)

    @classmethod
    def writable(cls, body: str) -> Selector:
        """The selector of this id, in characters that a text file can hold. A byte of the id that
        is not text is replaced by a pattern that matches any such byte and no character."""
        text = cls.exactly(body).text
        return cls("".join(_NO_CHARACTER if "\ud800" <= c <= "\udfff" else c for c in text))

    @classmethod
    def nobody(cls) -> Selector:
        return cls("[!\0-\U0010ffff]")  # no character is outside of this range

    @property
    def of_groups(self) -> bool:
        return self.text.startswith(GROUP)

    @property
    def glob(self) -> str:
        return self.text.removeprefix(GROUP)

    def choose(self, names: Collection[str]) -> Collection[str]:
        """Those that are selected of all these ids, or of all these groups."""
        for text in self._spelt():
            if text in names:
                return (text,)
        if not re.search(_SPECIAL, self.glob):
            return ()
        from fnmatch import translate

        matches = re.compile(translate(self.glob)).match
        return [name for name in names if matches(name)]

    def _spelt(self) -> Iterator[str]:
        """The names that come before the glob: the one that `exactly` writes so, then the text."""
        if "[" in self.glob and re.fullmatch(_ESCAPED, self.glob):
            yield re.sub(_IN_BRACKETS, r"\1", self.glob)
        yield self.glob

    def select(self, bodies: Sequence[B]) -> list[B]:
        """bodies: all from which to select; whether an id is exactly the text depends on them."""
        if self.of_groups:
            groups = frozenset(self.choose({group for body in bodies for group in body.groups}))
            return [body for body in bodies if not groups.isdisjoint(body.groups)]
        ids = frozenset(self.choose({body.id for body in bodies}))
        return [body for body in bodies if body.id in ids]


class Rule(Struct, frozen=True, kw_only=True):
    """What is asked of the pairs with one body in each selector. None: the rule does not say.

    Lengths and volumes are in the units of the scene, absolute.

    allowed: they may overlap, nothing is computed; False takes an earlier permission back.
    max_depth: an overlap no deeper than this is within budget; the depth is computed.
    max_thickness: so is one without a ball in both bodies thicker than this; the thickness is
    computed.
    max_volume: so is one that shares no more than this; the volume is computed.
    clearance: the gap they must keep, in the place of the global one; 0.0: none.
    tolerance: half width of the touch band, in the place of the global one.
    severity: of what is found about them; what cannot be decided stays a warning at least.
    reason: why, in words. where: "file:line" or the like, to name the rule in a report. file, line:
    where it is written, as far as that is known.

    Raises SatcheckError `bad-rule`: a key out of range, or none that asks anything.
    """

    a: Selector
    b: Selector
    allowed: bool | None = None
    max_depth: float | None = None
    max_thickness: float | None = None
    max_volume: float | None = None
    clearance: float | None = None
    tolerance: float | None = None
    severity: Severity | None = None
    reason: str = ""
    where: str = ""
    file: str | None = None
    line: int | None = None

    def __post_init__(self) -> None:
        for key in (*LENGTHS, "max_volume"):
            value = getattr(self, key)
            if value is not None and not (math.isfinite(value) and value >= 0):
                raise _refused(f"{key} must be a finite number >= 0, not {value!r}")
        if self.severity not in (None, *SEVERITIES):
            names = ", ".join(SEVERITIES)
            raise _refused(f"severity must be one of {names}, not {self.severity!r}")
        if all(getattr(self, key) is None for key in KEYS):
            raise _refused(f"a rule asks something: give it one of {', '.join(KEYS)}")
        if self.allowed and any(getattr(self, key) is not None for key in KEYS if key != "allowed"):
            raise _refused("an allowed pair is not looked at: leave the other keys out")

    def scaled(self, scale: float) -> Rule:
        """The same rule in another unit: lengths times `scale`, the volume times its cube."""
        if scale == 1.0:
            return self
        values = {key: getattr(self, key) for key in (*LENGTHS, "max_volume")}
        factors = {"max_volume": scale**3}
        known = {key: value for key, value in values.items() if value is not None}
        return replace(
            self, **{key: value * factors.get(key, scale) for key, value in known.items()}
        )

    @property
    def name(self) -> str:
        """Where it is written, or failing that, which pairs it is about."""
        return self.where or f"{self.a.text} and {self.b.text}"


def _refused(message: str) -> SatcheckError:
    return SatcheckError("bad-rule", message)
