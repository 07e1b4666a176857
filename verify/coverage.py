"""Whether each field of a report is proven, follows from what is proven, or is not covered.

The checker, its output and the docs share this table. A path names a field of the published schema
(`[]`: each member of a list) and includes all fields below it. `satcheck verify` lists fields that
are not covered if the report has values for them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from satcheck.report.verification import Kind, Uncovered


@dataclass(frozen=True, slots=True)
class Cover:
    """called: the name of the field in the output, where it is listed."""

    kind: Kind
    called: str = ""


PROVEN, FOLLOWS = Cover("proven"), Cover("follows")


def _stated(called: str) -> Cover:
    return Cover("stated", called)


def _certified(called: str) -> Cover:
    return Cover("certified", called)


def _not(called: str) -> Cover:
    return Cover("not covered", called)


COVERAGE: dict[str, Cover] = {
    "schema": FOLLOWS,  # a constant
    "tool.name": FOLLOWS,
    "tool.version": _not("the version of satcheck"),
    "units": _stated("units"),
    "settings": _stated("settings"),
    "summary": FOLLOWS,
    "reading": _stated("how files are read"),
    "pose": _stated("poses"),
    "motions": _not("motions"),
    # The body: its file is read again and placed again.
    "bodies[].id": _stated("the list of bodies"),
    "bodies[].name": _stated("the list of bodies"),
    "bodies[].file": PROVEN,
    "bodies[].sha256": PROVEN,
    "bodies[].path": PROVEN,
    "bodies[].shape": _stated("primitive shapes"),
    "bodies[].transform": _stated("poses"),
    "bodies[].units": _stated("units"),
    "bodies[].unit_scale": _stated("units"),
    "bodies[].groups": _stated("groups"),
    "bodies[].static": _stated("which bodies are static"),
    "bodies[].triangles": PROVEN,
    "bodies[].health": PROVEN,
    "bodies[].resolution": PROVEN,
    "bodies[].surface_tolerance": _stated("surface tolerances"),
    "bodies[].convex": PROVEN,
    "bodies[].parts": _not("convex parts"),
    "bodies[].part_error": _not("convex parts"),
    "bodies[].stated_at": _not("lines of files"),
    "exempt": _stated("exempt pairs"),
    "rules[]": _stated("rules"),
    "effects[].effect": FOLLOWS,
    "effects[].asked_by": _not("which flags and rules required an effect"),
    "effects[].pairs": _not("on how many pairs an effect ran"),
    "effects[].not_run": _not("on how many pairs an effect ran"),
    "effects[].microseconds": _not("times"),
    "findings[].id": FOLLOWS,
    "findings[].a": FOLLOWS,
    "findings[].b": FOLLOWS,
    "findings[].rule": FOLLOWS,
    "findings[].severity": FOLLOWS,
    "findings[].undecided": _certified("that something could not be decided"),
    "findings[].relation": PROVEN,
    "findings[].placed_relation": PROVEN,
    "findings[].exact_relation": PROVEN,
    "findings[].tolerance": FOLLOWS,
    "findings[].distance": _certified("distance"),
    "findings[].distance_bounds": _certified("distance"),
    "findings[].depth": _certified("depth"),
    "findings[].depth_bounds": _certified("lower end of the depth"),
    "findings[].quality": FOLLOWS,
    "findings[].normal": _certified("direction"),
    "findings[].mtv": _certified("way out"),
    "findings[].mtv_moves": FOLLOWS,
    "findings[].mtv_verified": FOLLOWS,
    "findings[].witness": FOLLOWS,
    "findings[].thickness": _certified("thickness"),
    "findings[].thickness_bounds": _certified("lower end of the thickness"),
    "findings[].ball": _certified("lower end of the thickness"),
    "findings[].volume": _certified("common volume"),
    "findings[].volume_error": _certified("common volume"),
    "findings[].contacts": _certified("contacts"),
    "findings[].components": _not("the components of overlaps"),
    "findings[].motion": _not("what happens while bodies move"),
    "findings[].certificate": PROVEN,
    "findings[].reason": _not("reasons"),
    "findings[].plan": _not("plans"),
    "findings[].baseline_state": _not("which findings a baseline accepts"),
    "issues[].code": _not("issues"),
    "issues[].severity": _not("issues"),
    "issues[].body": FOLLOWS,
    "issues[].file": _not("issues"),
    "issues[].line": _not("issues"),
    "issues[].message": _not("issues"),
    "issues[].state": _not("issues"),
    "truncated.pairs": FOLLOWS,
    "truncated.reason": _not("reasons"),
    "regions.tolerance": _stated("gravity, friction and tolerance of contacts"),
    "regions.rules[]": _stated("rules"),
    "regions.findings[].body": FOLLOWS,
    "regions.findings[].region": FOLLOWS,
    "regions.findings[].rule": FOLLOWS,
    "regions.findings[].severity": FOLLOWS,
    "regions.findings[].answer": PROVEN,
    "regions.findings[].reason": _not("reasons"),
    "regions.findings[].sticks_out": PROVEN,
    "regions.findings[].shift": PROVEN,
    "regions.findings[].point": PROVEN,
    "regions.microseconds": _not("times"),
    "statics.gravity": _stated("gravity, friction and tolerance of contacts"),
    "statics.friction": _stated("gravity, friction and tolerance of contacts"),
    "statics.tolerance": _stated("gravity, friction and tolerance of contacts"),
    "statics.stated": _not("what is assumed about gravity, friction and tolerance"),
    "statics.asked_by": _not("which flags and rules required an effect"),
    "statics.rules[]": _stated("rules"),
    "statics.bodies[].id": FOLLOWS,
    "statics.bodies[].fixed": FOLLOWS,
    "statics.bodies[].mass": PROVEN,
    "statics.bodies[].centre": PROVEN,
    "statics.bodies[].island": _not("how bodies are connected"),
    "statics.bodies[].floating": _not("how bodies are connected"),
    "statics.bodies[].held_by": _not("how bodies are connected"),
    "statics.bodies[].chain": _not("how bodies are connected"),
    "statics.bodies[].motion": _not("how fast falling bodies start"),
    "statics.contacts[]": _not("which contacts carry how much"),
    "statics.islands[]": _not("how bodies are connected"),
    "statics.findings[].body": FOLLOWS,
    "statics.findings[].question": FOLLOWS,
    "statics.findings[].rule": FOLLOWS,
    "statics.findings[].severity": FOLLOWS,
    "statics.findings[].answer": PROVEN,
    "statics.findings[].reason": _not("reasons"),
    "statics.pairs": _not("on how many pairs an effect ran"),
    "statics.microseconds": _not("times"),
    "baseline.file": _not("which findings a baseline accepts"),
    "baseline.absent": _not("which findings a baseline accepts"),
    "config.file": _not("where options come from"),
    "config.options": _not("where options come from"),
}


def uncovered(document: dict[str, Any], left: Iterable[str]) -> tuple[Uncovered, ...]:
    """The fields with a value that is not proven. left: of each finding the certified fields that
    have a value and are not proven."""
    counts: dict[str, int] = {}
    for field in left:
        counts[field] = counts.get(field, 0) + 1
    fields = []
    for field, cover in COVERAGE.items():
        if cover.kind == "certified" and field in counts:
            fields.append(Uncovered(field, cover.kind, cover.called, counts[field]))
        elif cover.kind in ("stated", "not covered") and any(_values(document, field)):
            fields.append(Uncovered(field, cover.kind, cover.called))
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
