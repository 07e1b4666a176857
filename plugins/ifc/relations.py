"""Rules from the relations of an IFC file: pairs that meet by design.

What fills an opening, covers an element or is part of one assembly touches its neighbours. An
overlap there is a note. Nothing is checked between a whole and its parts, which are the same
material. Walls that a path connects may overlap in their corner, as many programs export them, but
not by most of one of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.plugins.ifc.elements import instances_of, parts_of
from satcheck.plugins.ifc.kernel import Shape
from satcheck.scene.document import RawRule, Refusal, RuleSeverity

_NOTE: RuleSeverity = "note"
_BARS, _CONCRETE = "reinforcement", "reinforced"
_BAR = "IfcReinforcingElement"
# What reinforcement lies in. In IFC2X3 reinforcement is itself a building element.
_HOSTS = (
    *("IfcBeam", "IfcBuildingElementProxy", "IfcCivilElement", "IfcColumn", "IfcFooting"),
    *("IfcMember", "IfcPile", "IfcPlate", "IfcRamp", "IfcRampFlight", "IfcRoof", "IfcSlab"),
    *("IfcStair", "IfcStairFlight", "IfcWall", "IfcCourse", "IfcPavement", "IfcBearing"),
)  # what may be of reinforced concrete


# Of the smaller box: less than what a wall shares with its duplicate.
_MOST_SHARED = 0.5


class _Pair(Struct, frozen=True):
    a: Any
    b: Any
    reason: str
    severity: RuleSeverity | None = _NOTE
    is_corner: bool = False


def relations_of(
    model: Any,
    bodies: Sequence[Any],
    paths: Mapping[int, str],
    shapes: Mapping[int, Shape | Refusal],
) -> tuple[tuple[RawRule, ...], Mapping[int, list[str]]]:
    """(rules, the number of a body -> the groups that they name). paths, shapes: of each body, by
    its number."""
    groups: dict[int, list[str]] = {}
    rules = [*_reinforcement(bodies, groups), *_assemblies(model, paths, groups)]
    for whole in bodies:  # those that have a shape of their own, with their parts
        reason = f"part of {_called(whole)} (IfcRelAggregates)"
        parts = [part for part in _bodies_of(whole, paths) if part != whole.id()]
        rules += [RawRule(paths[whole.id()], paths[part], reason) for part in parts]
    for pair in _pairs(model):
        for a, b in product(_bodies_of(pair.a, paths), _bodies_of(pair.b, paths)):
            if a != b and not (pair.is_corner and not meet_in_a_corner(shapes[a], shapes[b])):
                rules.append(RawRule(paths[a], paths[b], pair.reason, severity=pair.severity))
    return tuple(dict.fromkeys(rules)), groups


def _reinforcement(bodies: Sequence[Any], groups: dict[int, list[str]]) -> Iterator[RawRule]:
    """Bars within the concrete, which few files relate to each other."""
    bars = [body.id() for body in bodies if body.is_a(_BAR)]
    hosts = [body.id() for body in bodies if not body.is_a(_BAR) and any(map(body.is_a, _HOSTS))]
    if bars and hosts:
        for name, members in ((_BARS, bars), (_CONCRETE, hosts)):
            for body in members:
                groups.setdefault(body, []).append(name)
        yield RawRule(_BARS, _CONCRETE, f"{_BAR} within concrete", of_groups=True, severity=_NOTE)


def _assemblies(
    model: Any, paths: Mapping[int, str], groups: dict[int, list[str]]
) -> Iterator[RawRule]:
    """Parts of one whole, each assembly a group. A part that is a whole belongs to the outermost
    one."""
    elements = instances_of(model, "IfcElement")
    wholes = [each for each in elements if any(True for _ in parts_of(each))]
    inner = {part.id() for whole in wholes for part in parts_of(whole)}
    for whole in (each for each in wholes if each.id() not in inner):
        members = [body for body in _bodies_of(whole, paths) if body != whole.id()]
        if len(members) > 1:
            name = f"assembly:{whole.GlobalId}"
            for body in members:
                groups.setdefault(body, []).append(name)
            reason = f"parts of {_called(whole)} (IfcRelAggregates)"
            yield RawRule(name, name, reason, of_groups=True, severity=_NOTE)


def _pairs(model: Any) -> Iterator[_Pair]:
    from ifcopenshell.util.system import get_port_element

    for relation in instances_of(model, "IfcRelFillsElement"):
        for voids in relation.RelatingOpeningElement.VoidsElements:
            host = voids.RelatingBuildingElement
            reason = f"it fills an opening of {_called(host)} (IfcRelFillsElement)"
            yield _Pair(host, relation.RelatedBuildingElement, reason)
    for relation in instances_of(model, "IfcRelProjectsElement"):
        host, addition = relation.RelatingElement, relation.RelatedFeatureElement
        yield _Pair(host, addition, "a projection of its host (IfcRelProjectsElement)", None)
    for relation in instances_of(model, "IfcRelConnectsElements"):
        is_path = relation.is_a("IfcRelConnectsPathElements")
        reason = f"connected ({relation.is_a()})"
        ends = relation.RelatingElement, relation.RelatedElement
        yield _Pair(*ends, reason, is_corner=is_path)
        for real in getattr(relation, "RealizingElements", ()):
            yield from (_Pair(real, end, reason) for end in ends)
    for relation in instances_of(model, "IfcRelCoversBldgElements"):
        host = relation.RelatingBuildingElement
        for covering in relation.RelatedCoverings:
            yield _Pair(host, covering, "its covering (IfcRelCoversBldgElements)")
    for relation in instances_of(model, "IfcRelConnectsPorts"):
        a, b = map(get_port_element, (relation.RelatingPort, relation.RelatedPort))
        if a is not None and b is not None:
            yield _Pair(a, b, "connected by ports (IfcRelConnectsPorts)")


def _bodies_of(element: Any, paths: Mapping[int, str]) -> list[int]:
    """The numbers of the element and its parts, of those that are bodies."""
    ids, seen, waiting = [], set(), [element]
    while waiting:
        each = waiting.pop()
        if each is not None and each.id() not in seen:
            seen.add(each.id())
            if each.id() in paths:
                ids.append(each.id())
            if each.is_a("IfcElement"):
                waiting += parts_of(each)
    return sorted(ids)


def _called(element: Any) -> str:
    return f"{element.is_a()} {element.GlobalId}"


def meet_in_a_corner(a: Shape | Refusal, b: Shape | Refusal) -> bool:
    """Whether the boxes of two bodies, each along the axes of its element, share at most half of
    the smaller box. The bodies lie in their boxes, so they share no more."""
    if isinstance(a, Refusal) or isinstance(b, Refusal):
        return True
    turn = np.linalg.inv(_matrix(a)) @ _matrix(b)
    one, other = _box(a), _box(b).transform(turn[:3])
    return bool((one ^ other).volume() <= _MOST_SHARED * min(one.volume(), other.volume()))


def _box(shape: Shape) -> Any:
    from manifold3d import Manifold

    points = np.frombuffer(shape.mesh.vertices, "<f8").reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    return Manifold.cube(high - low).translate(low)


def _matrix(shape: Shape) -> NDArray[np.float64]:
    return np.eye(4) if shape.matrix is None else np.array(shape.matrix).reshape(4, 4)
