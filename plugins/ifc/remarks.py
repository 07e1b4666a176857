"""What a user should know about an IFC file: what is no body, and what is not applied."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from satcheck.plugins.ifc.elements import Elements, instances_of
from satcheck.plugins.ifc.kernel import Shape
from satcheck.plugins.ifc.readers import CHORD
from satcheck.scene.loading.raw_mesh import Refusal
from satcheck.scene.read_options import ReadOptions
from satcheck.scene.words import listed


def remarks_on(
    model: Any,
    elements: Elements,
    shapes: Mapping[int, Shape | Refusal],
    options: ReadOptions,
) -> tuple[tuple[str, str], ...]:
    """(code, message) of each. shapes: of the bodies."""
    return (*_remarks(model, elements), *_facets(shapes, options))


def _remarks(model: Any, elements: Elements) -> Iterator[tuple[str, str]]:
    left_out = [*_counts(elements.left_out), *_wholes(elements)]
    if left_out:
        yield "left-out", f"no bodies: {', '.join(left_out)}"
    if elements.without:
        names = [f"{each.is_a()} {each.GlobalId}" for each in elements.without]
        yield "no-shape", f"{len(names)} elements without a shape are not checked: {listed(names)}"
    if instances_of(model, "IfcMapConversion"):
        yield "left-out", "IfcMapConversion is not applied: coordinates are those of the project"


def _facets(
    shapes: Mapping[int, Shape | Refusal], options: ReadOptions
) -> Iterator[tuple[str, str]]:
    count = sum(isinstance(shape, Shape) and shape.tolerance > 0 for shape in shapes.values())
    if count:
        yield (
            "faceted",
            f"curved surfaces of {count} bodies are checked as facets, up to about "
            f"{options.chord(CHORD):g} mm off (--chord-tolerance)",
        )


def _counts(classes: Counter[str]) -> list[str]:
    return [f"{count} {name}" for name, count in sorted(classes.items())]


def _wholes(elements: Elements) -> list[str]:
    counts = Counter(whole.is_a() for whole in elements.wholes)
    return [f"{each} (its parts are)" for each in _counts(counts)]
