"""The JSON Schema (2020-12) of satcheck.scene/1, made from the structs that read it."""

from __future__ import annotations

import re
from inspect import cleandoc
from typing import Any

from msgspec.json import schema_components

from satcheck.scene.files.readers import add_others
from satcheck.scene.rules import KEYS, RuleKeys
from satcheck.scene.scene_file.document import RulesFile, Scene, reading_table
from satcheck.scene.statics import EFFECTIVE_KEYS as BODY_KEYS
from satcheck.scene.statics import BodyRuleKeys
from satcheck.scene.table import LARGEST, Table

_ABOUT_KEY = re.compile(r"^([$\w]+): (.*(?:\n    .*)*)$", re.MULTILINE)


def schema() -> dict[str, Any]:
    """Return the schema, with the options of all readers, those of other packages included."""
    add_others()
    kinds = (Scene, RuleKeys, BodyRuleKeys, reading_table())
    _, tables = schema_components(kinds, ref_template="#/$defs/{name}")
    for table in tables.values():
        _describe(table)
    for kind in Table.__subclasses__():
        if kind.__name__ in tables:
            tables[kind.__name__] |= _conditions(kind)
    _require_effect(tables["RuleKeys"], KEYS)
    _require_effect(tables["BodyRuleKeys"], BODY_KEYS)
    tables["RuleKeys"] |= {
        "if": {"properties": {"allowed": {"const": True}}, "required": ["allowed"]},
        "then": {
            "required": ["reason"],
            "properties": {key: False for key in KEYS if key != "allowed"},
        },
    }
    scene = _plain(tables.pop("Scene"))
    scene["properties"]["reading"] = {"$ref": "#/$defs/Reading"}
    del scene["required"]
    of_rules = RulesFile.__struct_encode_fields__
    rules_file = {"required": ["rules"], "propertyNames": {"enum": list(of_rules)}}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "urn:satcheck:scene:1",
        **scene,
        "title": "satcheck.scene/1",
        "anyOf": [
            {"required": ["schema", "bodies"]},
            {"description": "A file of rules.", **rules_file},
        ],
        "$defs": _plain(tables),
    }


def _describe(table: dict[str, Any]) -> None:
    """Moves what the docstring says about keys to these keys."""
    text = cleandoc(table.get("description", ""))
    for key, about in _ABOUT_KEY.findall(text):
        table["properties"][key]["description"] = " ".join(about.split())
    table["description"] = " ".join(_ABOUT_KEY.sub("", text).split())


def _conditions(kind: type[Table]) -> dict[str, Any]:
    """What keys say about other keys."""
    found: dict[str, Any] = {}
    if kind.one_of:
        found["oneOf"] = [{"required": [key]} for key in kind.one_of]
    if kind.excludes:
        found["dependentSchemas"] = {
            key: {"not": {"anyOf": [{"required": [other]} for other in others]}}
            for key, others in kind.excludes.items()
        }
    return found


def _require_effect(table: dict[str, Any], keys: tuple[str, ...]) -> None:
    table["anyOf"] = [{"required": [key]} for key in keys]


def _plain(part: Any) -> Any:
    """The same without limits that only keep infinity out and without null, with texts for lengths,
    and with lists of equal items in the short form that more editors know."""
    if isinstance(part, list):
        return [_plain(inner) for inner in part]
    if not isinstance(part, dict):
        return part
    part = {k: _plain(v) for k, v in part.items() if v not in (LARGEST, -LARGEST, None, "")}
    if {"type": "null"} in part.get("anyOf", ()):
        *kinds, _ = part.pop("anyOf")
        part |= kinds[0] if len(kinds) == 1 else {"anyOf": kinds}
    if part.get("type") == "number" and "pattern" in part:
        part["type"] = ["number", "string"]
    items = part.get("prefixItems", ())
    if part.get("items") is False and all(item == items[0] for item in items):
        del part["prefixItems"]
        part["items"] = items[0]
    return part
