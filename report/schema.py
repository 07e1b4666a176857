"""The JSON Schema (2020-12) of a document, printed from the struct that holds it."""

from __future__ import annotations

from inspect import cleandoc
from typing import Any

from msgspec import Struct
from msgspec.json import schema_components

DIALECT = "https://json-schema.org/draft/2020-12/schema"
# Absent from documents without timings.
TIMING = "microseconds"


def schema_of(name: str, document: type[Struct]) -> dict[str, Any]:
    """The schema of a document. All keys are required, except timings and those that a struct may
    leave unset."""
    _, parts = schema_components([document], ref_template="#/$defs/{name}")
    for part in parts.values():
        _complete(part)
    whole = parts.pop(document.__name__)
    head = {"$schema": DIALECT, "$id": f"urn:satcheck:{name}:1"}
    return {**head, **whole, "title": f"satcheck {name}", "$defs": parts}


def _complete(part: dict[str, Any]) -> None:
    """Makes fields with a default required, because they are always written. Fields that may be
    unset stay optional."""
    if "description" in part:
        words = cleandoc(part["description"])
        for python, json in (("None", "null"), ("True", "true"), ("False", "false")):
            words = words.replace(python, json)
        part["description"] = words
    members = part["properties"]
    unset = {key for key, m in members.items() if "default" not in m} - set(part["required"])
    part["required"] = [key for key in members if key not in unset and key != TIMING]
    for member in members.values():
        member.pop("default", None)
