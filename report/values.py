"""The base of all structs of documents, and the types of numbers and words in them."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct


class Value(Struct, frozen=True, forbid_unknown_fields=True):
    """A JSON object. Every key is always present; values that do not apply are None."""


Count = Annotated[int, Meta(ge=0)]
Length = Annotated[float, Meta(ge=0)]
Size = Annotated[float, Meta(gt=0)]
Share = Annotated[float, Meta(ge=0, le=1)]
Vector = tuple[float, float, float]
Sizes = tuple[Size, Size, Size]
# The lower and upper end of a proven interval.
Interval = tuple[Length, Length]
Sha256 = Annotated[str, Meta(pattern="^[0-9a-f]{64}$")]
# A stable code in kebab-case.
Code = Annotated[str, Meta(pattern="^[a-z0-9]+(-[a-z0-9]+)*$")]

Relation = Literal[
    "separated",
    "near",
    "touching",
    "penetrating",
    "contains",
    "inside",
    "coincident",
    "indeterminate",
]
Quality = Literal["exact", "bounded", "estimate"]
Verdict = Literal["pass", "fail", "incomplete"]


class Tool(Value, frozen=True):
    """The program that made the document."""

    name: Literal["satcheck"]
    version: str
