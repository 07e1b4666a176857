"""The JSON Schema of a config file, made from the options of the commands."""

from __future__ import annotations

import json
from typing import Any

import click

from satcheck.cli.config.source import options_of_commands

_PATTERN_OF_LENGTH = r"^[0-9.]+([eE][+-]?[0-9]+)?\s*[a-zA-Z]*$"


def schema() -> str:
    properties = {key: _property(option) for key, option in options_of_commands().items()}
    document = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "satcheck.toml, and [tool.satcheck] of pyproject.toml",
        "type": "object",
        "additionalProperties": False,
        "properties": dict(sorted(properties.items())),
    }
    return json.dumps(document, indent=2) + "\n"


def _property(option: click.Option) -> dict[str, Any]:
    described = {"description": " ".join((option.help or "").split("[default")[0].split())}
    if option.is_flag:
        return {"type": "boolean", **described}
    if option.multiple:
        texts = {"type": "array", "items": {"type": "string"}}
        return {"anyOf": [texts, {"type": "string"}], **described}
    return {**_kind(option.type), **described}


def _kind(kind: click.ParamType[Any]) -> dict[str, Any]:
    if isinstance(kind, click.Choice):
        return {"enum": list(kind.choices)}
    if isinstance(kind, click.IntRange | click.FloatRange):
        return {"type": "integer" if isinstance(kind, click.IntRange) else "number"} | _range(kind)
    if isinstance(kind, click.types.FuncParamType):  # a length
        return {"type": ["number", "string"], "minimum": 0, "pattern": _PATTERN_OF_LENGTH}
    return {"type": "string"}


def _range(kind: click.IntRange | click.FloatRange) -> dict[str, Any]:
    ends = {
        "exclusiveMinimum" if kind.min_open else "minimum": kind.min,
        "exclusiveMaximum" if kind.max_open else "maximum": kind.max,
    }
    return {name: end for name, end in ends.items() if end is not None}
