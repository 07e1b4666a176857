"""Whether each field of a report is proven, follows from what is proven, or is not covered.

The checker, its output and the docs share this table. A path names a field of the published schema
(`[]`: each member of a list) and includes all fields below it. `satcheck verify` lists fields that
are not covered if the report has values for them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from satcheck.report.verification import Kind, Uncovered


@dataclass(frozen=True, slots=True)
class Cover:
    """called: the name of the field in the output, where it is listed."""

    kind: Kind
    called: str = ""


# By kind, and by the name that the output has for them: the fields.
GROUPS: dict[Kind, dict[str, str]] = {
    "proven": {
        # Of a body: its file is read again and placed again.
        "": """
            bodies[].file bodies[].sha256 bodies[].path bodies[].triangles bodies[].health
            bodies[].resolution bodies[].convex
            findings[].relation findings[].placed_relation findings[].exact_relation
            findings[].certificate
            regions.findings[].answer regions.findings[].sticks_out regions.findings[].shift
            regions.findings[].point
            statics.bodies[].mass statics.bodies[].centre statics.findings[].answer
        """,
    },
    "follows": {
        "": """
            schema tool.name summary effects[].effect
            findings[].id findings[].a findings[].b findings[].rule findings[].severity
            findings[].tolerance findings[].quality findings[].mtv_moves findings[].mtv_verified
            findings[].witness
            issues[].body truncated.pairs
            regions.findings[].body regions.findings[].region regions.findings[].rule
            regions.findings[].severity
            statics.bodies[].id statics.bodies[].fixed statics.findings[].body
            statics.findings[].question statics.findings[].rule statics.findings[].severity
        """,
    },
    "stated": {
        "units": "units bodies[].units bodies[].unit_scale",
        "settings": "settings",
        "how files are read": "reading",
        "poses": "pose bodies[].transform",
        "the list of bodies": "bodies[].id bodies[].name",
        "primitive shapes": "bodies[].shape",
        "groups": "bodies[].groups",
        "which bodies are static": "bodies[].static",
        "which bodies are open on purpose": "bodies[].open",
        "surface tolerances": "bodies[].surface_tolerance",
        "exempt pairs": "exempt",
        "rules": "rules[] regions.rules[] statics.rules[]",
        "gravity, friction and tolerance of contacts": """
            regions.tolerance statics.gravity statics.friction statics.tolerance
        """,
    },
    "certified": {
        "that something could not be decided": "findings[].undecided",
        "distance": "findings[].distance findings[].distance_bounds",
        "depth": "findings[].depth",
        "lower end of the depth": "findings[].depth_bounds",
        "direction": "findings[].normal",
        "way out": "findings[].mtv",
        "thickness": "findings[].thickness",
        "lower end of the thickness": "findings[].thickness_bounds findings[].ball",
        "common volume": "findings[].volume findings[].volume_error",
        "contacts": "findings[].contacts",
    },
    "not covered": {
        "the version of satcheck": "tool.version",
        "motions": "motions",
        "convex parts": "bodies[].parts bodies[].part_error findings[].part_pairs",
        "lines of files": "bodies[].stated_at",
        "which flags and rules required an effect": "effects[].asked_by statics.asked_by",
        "on how many pairs an effect ran": "effects[].pairs effects[].not_run statics.pairs",
        "times": "effects[].microseconds regions.microseconds statics.microseconds",
        "the components of overlaps": "findings[].components",
        "what happens while bodies move": "findings[].motion",
        "messages": "message findings[].message",
        "reasons": """
            findings[].reason findings[].reason_code truncated.reason regions.findings[].reason
            statics.findings[].reason
        """,
        "plans": "findings[].plan",
        "which findings a baseline accepts": """
            findings[].baseline_state baseline.file baseline.absent
        """,
        "issues": """
            issues[].code issues[].severity issues[].file issues[].line issues[].message
            issues[].state
        """,
        "what is assumed about gravity, friction and tolerance": "statics.stated",
        "how bodies are connected": """
            statics.bodies[].island statics.bodies[].floating statics.bodies[].held_by
            statics.bodies[].chain statics.islands[]
        """,
        "how fast falling bodies start": "statics.bodies[].motion",
        "which contacts carry how much": "statics.contacts[]",
        "where options come from": "config.file config.options",
    },
}
COVERAGE: dict[str, Cover] = {
    field: Cover(kind, called)
    for kind, groups in GROUPS.items()
    for called, fields in groups.items()
    for field in fields.split()
}
# The name of the field in a finding.
CERTIFIED = {
    field: field.removeprefix("findings[].")
    for field, cover in COVERAGE.items()
    if cover.kind == "certified"
}


def uncovered(document: dict[str, Any], left: Iterable[str]) -> tuple[Uncovered, ...]:
    """The fields with a value that is not proven. left: of each finding the certified fields that
    have a value and are not proven."""
    counts, fields = Counter(left), []
    for field, cover in COVERAGE.items():
        if cover.kind == "certified" and field in counts:
            fields.append(Uncovered(field, cover.kind, cover.called, counts[field]))
        elif cover.kind in ("stated", "not covered") and any(_values(document, field)):
            fields.append(Uncovered(field, cover.kind, cover.called))
            if field == "bodies[].shape":  # the file that states a shape is not read again
                fields.append(Uncovered("bodies[].file", cover.kind, cover.called))
    return tuple(fields)


def _says_something(value: Any) -> bool:
    if isinstance(value, dict):
        return any(map(_says_something, value.values()))
    return value is not None and value is not False and value != []


def _values(value: Any, path: str) -> Iterator[bool]:
    """Whether the report has a value, for each place of the field."""
    if not path:
        yield _says_something(value)
        return
    step, _, rest = path.partition(".")
    key, listed = step.removesuffix("[]"), step.endswith("[]")
    if not isinstance(value, dict) or key not in value:
        return
    for member in value[key] if listed else (value[key],):
        yield from _values(member, rest)
