"""The scene form `satcheck.scene/1`, in TOML or JSON; docs/scenes.md describes its keys.

A scene with errors is refused as a whole, because a part of a scene has no meaning. An unknown key
is an error, because it may be important.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from satcheck.core.shapes import PRIMITIVES
from satcheck.scene.format.entries import (
    NO_MESH,
    BodyEntry,
    SceneFile,
    unknown_groups,
    unknown_units,
)
from satcheck.scene.format.mesh_places import MeshPlaces
from satcheck.scene.format.motion_keys import read_motion
from satcheck.scene.format.placement import KEYS as PLACEMENT_KEYS
from satcheck.scene.format.placement import placement
from satcheck.scene.format.problems import Problems, Wrong
from satcheck.scene.format.rule_keys import length_in, read_rule
from satcheck.scene.format.table import Table, read_bodies
from satcheck.scene.format.text import Parsed
from satcheck.scene.format.values import boolean, known_unit, list_of, shown, text
from satcheck.scene.motion import Motion
from satcheck.scene.planar.outline import OUTLINE, Shape, shape_from
from satcheck.scene.rules import Rule

if TYPE_CHECKING:
    from satcheck.scene.statics import BodyRule, StaticsTerms

_RULES_KEYS = frozenset(
    ("schema", "$schema", "name", "description", "units", "bodies", "rules", "statics")
)
_KEYS = _RULES_KEYS | {"check_static", "ignore_within_groups", "motion", "reading"}
_BODY_KEYS = PLACEMENT_KEYS | {
    *("id", "mesh", "part", "shape", "groups", "static", "pinned", "units", "surface_tolerance")
}

HALF_SPACE = "half-space"
_SHAPES = (*PRIMITIVES, OUTLINE)
_texts = list_of("texts", text)


def read_scene(parsed: Parsed, *, allow_outside: bool) -> SceneFile:
    """Raises SceneFileError with all errors of the file."""
    problems = parsed.problems()
    scene = _Reader(parsed, problems, allow_outside).read()
    problems.raise_any(parsed.path, parsed.lines)
    return scene


def has_only_rules(document: Any) -> bool:
    """Whether it has rules, and no key that only a scene with bodies has."""
    return (
        isinstance(document, dict)
        and "rules" in document
        and document.keys() <= _RULES_KEYS - {"bodies"}
    )


def read_rules(parsed: Parsed) -> SceneFile:
    """A file of rules: a scene without bodies, which may leave out `schema` and `bodies`. Raises
    SceneFileError with all that is wrong in the file."""
    problems = parsed.problems()
    top = Table(parsed.document, (), problems)
    top.only(_RULES_KEYS)
    if top.values.get("bodies"):
        top.wrong("a file of rules has no bodies", "bodies")
    if "rules" not in top:
        top.wrong('"rules" is missing')
    scene = _Reader(parsed, problems, allow_outside=False).read_rules(top)
    problems.raise_any(parsed.path, parsed.lines)
    return scene


class _Reader:
    def __init__(self, parsed: Parsed, problems: Problems, allow_outside: bool) -> None:
        self._parsed = parsed
        self._problems = problems
        self._places = MeshPlaces(parsed.path, parsed.location, anywhere=allow_outside)

    def read(self) -> SceneFile:
        top = Table(self._parsed.document, (), self._problems)
        top.only(_KEYS)
        if "bodies" not in top:
            top.wrong('"bodies" is missing')
        units = top.read("units", text, None)
        bodies = read_bodies(top, lambda table: self._body(table, units))
        are_sound = not self._problems
        ignored = frozenset(top.read("ignore_within_groups", _texts, []))
        for key in ("$schema", "description"):  # not used here, but they have to be texts
            top.read(key, text, None)
        rules, body_rules = self._rules(top, units)
        return SceneFile(
            path=self._parsed.path,
            name=top.read("name", text, self._parsed.location.stem),
            units=units,
            bodies=bodies,
            ignore_within_groups=ignored,
            check_static=top.read("check_static", boolean, False),
            rules=rules,
            body_rules=body_rules,
            statics=self._statics(top, units),
            motions=self._motions(top, bodies if are_sound else None),
            reading=self._reading(top),
            issues=(
                *unknown_units(units, self._parsed.path),
                *unknown_groups(ignored, bodies, self._parsed.path),
            ),
        )

    def read_rules(self, top: Table) -> SceneFile:
        units = top.read("units", text, None)
        rules, body_rules = self._rules(top, units)
        return SceneFile(
            path=self._parsed.path,
            name=self._parsed.location.stem,
            units=units,
            bodies=(),
            ignore_within_groups=frozenset(),
            check_static=False,
            rules=rules,
            body_rules=body_rules,
            statics=self._statics(top, units),
            motions=(),
            issues=tuple(unknown_units(units, self._parsed.path)),
        )

    def _body(self, table: Table, units: str | None) -> BodyEntry:
        table.only(_BODY_KEYS)
        if ("mesh" in table) == ("shape" in table):
            table.wrong('exactly one of "mesh" and "shape" is required')
        if "part" in table and "shape" in table:
            table.wrong("a shape has no parts: remove this key", "part")
        if "units" in table and "shape" in table:
            table.wrong("a shape is in the units of the scene: remove this key", "units")
        return BodyEntry(
            id=table.required("id", text, ""),
            mesh=table.read("mesh", self._places.find, NO_MESH),
            part=table.read("part", text, None),
            shape=table.read("shape", _shape, None),
            transform=placement(table),
            groups=tuple(table.read("groups", _texts, [])),
            static=table.read("static", boolean, False),
            pinned=table.read("pinned", boolean, False),
            units=table.read("units", known_unit, None),
            surface_tolerance=table.read("surface_tolerance", length_in(units), None),
        )

    def _rules(
        self, top: Table, units: str | None
    ) -> tuple[tuple[Rule, ...], tuple[BodyRule, ...]]:
        """Those of pairs, and those of bodies, which have the key `bodies`."""
        of_pairs: list[Rule | None] = []
        of_bodies: list[BodyRule | None] = []
        path = self._parsed.path
        tables = list(top.tables("rules"))
        lines = self._parsed.lines([table.keys for table in tables]) if tables else []
        for table, line in zip(tables, lines, strict=True):
            if "bodies" in table:
                from satcheck.scene.format.statics_keys import read_body_rule

                of_bodies.append(read_body_rule(table, path, line))
            else:
                of_pairs.append(read_rule(table, units, path, line))
        return tuple(filter(None, of_pairs)), tuple(filter(None, of_bodies))

    def _reading(self, top: Table) -> dict[str, Any]:
        table = top.table("reading")
        if table is None:
            return {}
        from satcheck.scene.format.reading_keys import read_reading

        return read_reading(table)

    def _statics(self, top: Table, units: str | None) -> StaticsTerms | None:
        table = top.table("statics")
        if table is None:
            return None
        from satcheck.scene.format.statics_keys import read_statics

        return read_statics(table, units)

    def _motions(self, top: Table, bodies: tuple[BodyEntry, ...] | None) -> tuple[Motion, ...]:
        moved: dict[str, str] = {}  # id of a body -> its motion
        candidates = (read_motion(table, bodies, moved) for table in top.tables("motion"))
        return tuple(motion for motion in candidates if motion is not None)


def _shape(value: Any) -> Shape:
    if not isinstance(value, dict):
        raise Wrong(f"a type and its sizes expected, not {shown(value)}")
    kind = value.get("type")
    if kind not in _SHAPES:
        raise Wrong(f"one of {', '.join(_SHAPES)} expected, not {shown(kind)}", "type")
    if kind == HALF_SPACE and len(value) > 1:
        raise Wrong("a half space has no sizes")
    try:
        return shape_from(value)
    except ValueError as error:
        raise Wrong(str(error)) from None
