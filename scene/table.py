"""Tables of a scene file as typed structs, and what is wrong in one."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta, Struct

Key = str | int
Keys = tuple[Key, ...]

LARGEST = sys.float_info.max  # as a limit of a number, it refuses infinity and NaN
Text = Annotated[str, Meta(min_length=1)]
Texts = tuple[Text, ...]
Number = Annotated[float, Meta(ge=-LARGEST, le=LARGEST)]
NotNegative = Annotated[float, Meta(ge=0, le=LARGEST)]
Positive = Annotated[float, Meta(gt=0, le=LARGEST)]
Direction = Annotated[
    tuple[Number, Number, Number], Meta(extra_json_schema={"not": {"items": {"const": 0}}})
]


class Wrong(ValueError):
    """A value is not what its key requires. keys: the path to it."""

    def __init__(self, message: str, *keys: Key, code: str = "bad-scene") -> None:
        super().__init__(message)
        self.message = message
        self.keys: Keys = keys
        self.code = code


class Table(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """A table of a scene file. A key that is left out is None; null is no value in a file.

    one_of: exactly one of these keys is required. excludes: keys that may not stand beside a key.
    lengths: keys whose value may be a text with a unit.
    """

    one_of: ClassVar[tuple[str, ...]] = ()
    excludes: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    lengths: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        for key, others in self.excludes.items():
            if getattr(self, key) is not None:
                for other in others:
                    if getattr(self, other) is not None:
                        raise Wrong(f'remove this key, or "{key}": they exclude each other', other)
        if self.one_of and sum(getattr(self, key) is not None for key in self.one_of) != 1:
            raise Wrong(f"exactly one of {', '.join(self.one_of)} is required")

    def stated(self) -> dict[str, Any]:
        """The keys that it states, with their values."""
        values = ((name, getattr(self, name)) for name in self.__struct_fields__)
        return {name: value for name, value in values if value is not None}
